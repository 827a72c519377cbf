"""Words for cards: who owns one, and which one Tangy reads."""

from __future__ import annotations


def card_title(name: str) -> str:
    """Return the title of a person's card."""
    return f"The card of {name}"


WHOSE = "Whose card is it?"
KEY_HINT = "Press {whose_card} to say whose it is."
KNOWN, UNKNOWN = "has card {}", "card not known yet"
ANOTHER = "another one"
BY_NUMBER, TYPE_NUMBER = "a number", "you type the number on the card"
NUMBER_DETAIL = "Type the number that is printed on the card."
NUMBER_KEYS = "enter takes it   esc goes back"
NUMBER_HELP = "Type the number on the person's card, and press Enter. Esc goes back."
NO_NUMBER = "That is no number of a card: type digits alone."
LEARNT_NEXT = "Tangy takes the next card it sees there"


def which_words(name: str) -> str:
    """Ask which card a person has."""
    return f"Which card does {name} have?"


def in_sight_words(owner: str) -> str:
    """Describe a card that Tangy saw last, with its owner; "" if unknown."""
    return f"{owner}'s card, was in sight last" if owner else "was in sight last"


def other_card_words(name: str) -> str:
    """Tell that Tangy learns a person's card again."""
    return f"{name} has another card."
