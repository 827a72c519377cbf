"""Words for cards: who owns one, and which one Tangy reads."""

from __future__ import annotations


def card_title(name: str) -> str:
    """Return the title of a person's card."""
    return f"The card of {name}"


WHOSE = "Whose card is it?"
KEY_HINT = "Press {whose_card} to say whose it is."
LEARNT_NEXT = "Tangy takes the next card it sees there"


def which_words(name: str) -> str:
    """Ask which card a person has."""
    return f"Which card does {name} have?"
