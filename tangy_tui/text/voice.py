"""Words for speech: what Tangy says and hears, and how a name is pronounced."""

from __future__ import annotations

SOUNDS_HELP = (
    "Write it in sounds, with a comma between words: R OW Z AH is Rosa. An empty line drops the "
    "note."
)


def said_title(name: str) -> str:
    """Return the title of a name's pronunciation."""
    return f"How {name} is said"


ON = "Tangy speaks now. At x1 it finishes every line; {voice} switches the voice off."
OFF = "Tangy is quiet now: what it says is shown as text."
OR_SAY = "Or say"
OR_KEY_AND_SAY = "Or {^talk}, and say"
OR_SAY_YES = "  Or say yes or no."
OR_SAY_WHICH = "  Or say the number or the words of one, or no."
RECORDING = "A recording is listened to: no key is needed."
HANDS_FREE = "No key is needed: just speak."


def shown_words(why: str) -> str:
    """Tell why Tangy's speech is not audible."""
    return f"{why} What Tangy says is shown as text."


NO_MICROPHONE = "There is no microphone: start Tangy with --mic to talk to it."
LISTENS = "Tangy listens again."
LISTENS_NOT = "Tangy takes no commands by voice now. It still hears stop."
