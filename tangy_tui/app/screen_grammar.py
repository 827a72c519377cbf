"""The grammar of typed commands that screens carry out like keys.

The parsers return `None` for words that are no command, as those of `command_grammar` do.
"""

from __future__ import annotations

from dataclasses import dataclass

from tangy_tui.app.inquiry_grammar import WHO_IS_HERE, WHOSE_CARDS, Inquiry, read_inquiry
from tangy_tui.app.keymap import ACTIONS


@dataclass(frozen=True, slots=True)
class Perform:
    """Run an action of the keymap; `on` is the wanted state of a switch if the words name it."""

    action: str
    on: bool | None = None


PERFORMS: dict[str, Perform] = {
    **dict.fromkeys(("voice on", "speak"), Perform("voice", on=True)),
    **dict.fromkeys(("voice off", "be quiet"), Perform("voice", on=False)),
    **dict.fromkeys(("pause listening", "stop listening"), Perform("listen", on=False)),
    **dict.fromkeys(("listen", "listen again"), Perform("listen", on=True)),
    "guided game": Perform("guided"),
    **dict.fromkeys(("rule", "make it a rule", "make a rule"), Perform("rule")),
    **dict.fromkeys(("play", "play a game", "let tangy play"), Perform("begin")),
    **dict.fromkeys(("my name", "change my name", "who am i"), Perform("name")),
}
"""Commands that run an action, besides the word of every action of the keymap."""

NEXT_GAME = ("next game", "another game", "play again", "play another game", "new game")
"""Words for the next game while one is played; in teaching they begin another demonstration."""

PERFORMED = frozenset(
    {
        *("palette", "draw", "talk", "listen", "zoom", "picture", "mouse", "voice"),
        *("learn", "library", "guided", "filter", "quit", "name", "messages"),
    }
)
"""Actions of the keymap whose typed words work on the teaching screen as their keys do elsewhere.
"""


def read_program(text: str) -> Perform | Inquiry | None:
    """Parse words as a command or question to the program itself; None if they are neither."""
    words = " ".join(text.split()).casefold()
    if words in PERFORMS:
        return PERFORMS[words]
    action = next((a.id for a in ACTIONS if a.id in PERFORMED and a.word == words), None)
    return Perform(action) if action is not None else read_inquiry(text)


def read_screen(text: str) -> Perform | None:
    """Parse words as a command that a screen carries out like a key."""
    words = " ".join(text.split()).casefold().rstrip(" ?.!")
    if words in WHOSE_CARDS:
        return Perform("whose_card")
    if words in WHO_IS_HERE:
        return Perform("presence")
    if words in NEXT_GAME:
        return Perform("next")
    word = read_program(text)
    if isinstance(word, str):
        return Perform(word) if word in ("why", "help", "phrases") else None
    return word
