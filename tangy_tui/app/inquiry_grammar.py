"""The grammar of questions about the program or the game; they change nothing."""

from __future__ import annotations

import re
from typing import Literal

Inquiry = Literal["help", "where", "why", "shown", "what to do", "faults", "phrases", "patterns"]
"""Questions about the program or the game; they change nothing."""

INQUIRIES: dict[str, Inquiry] = {
    **dict.fromkeys(("help", "?"), "help"),
    "where": "where",
    "why": "why",
    **dict.fromkeys(("what", "what to do", "what should i do", "what should i do?"), "what to do"),
    "faults": "faults",
    "phrases": "phrases",
    **dict.fromkeys(("patterns", "pattern", "which patterns"), "patterns"),
}

WHOSE_CARDS = ("cards", "card", "whose card", "whose cards", "who has which card")
"""Questions in a game about whose card is whose."""

WHO_IS_HERE = ("people", "who", "who is here", "who is there", "who waits")
"""Questions in a game about who is here, and how long they have waited."""

_TANGY = r"(?:you|it|tangy|the robot|he|she)"
_WHY = re.compile(
    r"why(?: (?:that|this|now|not|so))?"
    rf"|(?:why|what) (?:is|are|does|do|did|will|would) {_TANGY}"
    r"(?: (?:doing|do|going to do|up to|waiting|waiting for|wait|wait for|stand|standing))"
    r"(?: (?:that|this|it|there|here|still))?(?: (?:now|next|then|right now|at the moment))?"
    r"|what(?: is|'s|s) (?:happening|going on|next|up)(?: here)?(?: now| next)?"
    r"|what (?:happens|comes) (?:now|next)|what next|what now"
)
"""Questions about what Tangy does now or next."""


def read_inquiry(text: str) -> Inquiry | None:
    """Parse words as a question to the program, None if they are none."""
    words = " ".join(text.split()).casefold()
    if words in INQUIRIES:
        return INQUIRIES[words]
    return "why" if _WHY.fullmatch(words.replace("\u2019", "'").rstrip(" ?.!")) else None
