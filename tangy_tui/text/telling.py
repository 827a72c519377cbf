"""What staff can tell Tangy of people in a live game, in words."""

from __future__ import annotations

from collections.abc import Sequence

TELL = "What does a person answer or do?"
TELL_KEYS = "enter tells Tangy   esc goes back"
TELL_HELP = (
    "Type what a person says or does, as in: b, or with the name: rosa: b. Enter tells Tangy, "
    "esc goes back."
)


def telling_words(waits_for: str, sayable: Sequence[str]) -> str:
    """Say which words Tangy knows now, and whom they are about where no name stands before them."""
    known = f"One of: {', '.join(sayable)}." if sayable else "Nothing can be told now."
    about = f" Without a name it is about {waits_for}." if waits_for else ""
    return f"{known}{about}"
