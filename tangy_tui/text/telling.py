"""Words of the line in which staff tell Tangy what people answer or do."""

from __future__ import annotations

from collections.abc import Sequence

TELL = "What did a person answer or do?"
TELL_KEYS = "enter tells Tangy   esc goes back"
TELL_HELP = (
    "Type what a person says or does, as in: b, or with the name: rosa: b. Enter tells Tangy, "
    "esc goes back."
)


def telling_words(waits_for: str, sayable: Sequence[str]) -> str:
    """Say which words Tangy knows now, and whom they are about without a name."""
    known = f"One of: {', '.join(sayable)}." if sayable else "There is nothing to tell now."
    about = f" Without a name it is about {waits_for}." if waits_for else ""
    return f"{known}{about}"
