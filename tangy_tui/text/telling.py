"""Words of the line in which staff report people's answers and actions."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tangy_tui.text.control import going_words

TELL = "What did a person answer or do?"
TELL_HINT = "Press {tell} to tell it."
TELL_KEYS = "enter tells Tangy   esc goes back"
TELL_HELP = (
    "Type what a person says or does, as in: b, or with the name: rosa: b. Enter tells Tangy, "
    "esc goes back."
)


def card_question(name: str, object: str) -> str:
    """Ask for the state of the card of the person beside the robot."""
    return f"How is {name}'s {object} now? Give {name} time, look at it, and tell Tangy."


def waiting_words(
    going: str,
    lets: str,
    about: tuple[str, Sequence[str]],
    object: str,
    name: Callable[[str], str],
) -> str:
    """Tell in line mode what the robot does or waits for; "" for nothing.

    Args:
        going: its destination, "" if it is not driving.
        lets: the person it waits for on its way.
        about: the person whose card staff should report ("" for nobody), and the words for it.
        object: the activity's word for a card.
        name: returns a person's name.
    """
    person, sayable = about
    if not person:
        return going_words(going, name, lets)
    called = name(person)
    ways = "; ".join(f"{called}: {words}" for words in sayable)
    return f"{card_question(called, object)} Type one of these: {ways}"


def telling_words(waits_for: str, sayable: Sequence[str]) -> str:
    """Tell which words Tangy knows now, and whom they are about without a name."""
    known = f"One of: {', '.join(sayable)}." if sayable else "There is nothing to tell now."
    if waits_for:
        return f"{known} Without a name it is about {waits_for}."
    return f"{known} Begin with the person's name, as in Rosa: ..." if sayable else known
