"""Words of the line in which staff type commands in a game."""

from __future__ import annotations

from collections.abc import Sequence

from tangy_profiles.reading import plain

TITLE = "What do you want to do?"
CLAIM = "Which card?"
KEYS = "enter does it   esc goes back"
WHO_IS_HERE = "Who has come, or has left?"
AWAY = "away"
"""Beside a person who is not here, where there is little room."""
IS_HERE, IS_AWAY = "here: Enter if they leave", "not here: Enter if they have come"
SOMEBODY_NEW = "somebody new", "Enter, and type the name"

NEXT = "You say what Tangy does next"
NEXT_WORDS = "Tangy finishes this first. Type what it does then, and press Enter."
NEXT_KEYS = "enter says it   esc lets Tangy go on by itself"
NEXT_EMPTY = "Type what Tangy does next, or press Esc."
NEXT_OVER = "The game is over, so Tangy does nothing more."


def next_dropped(said: str, *, over: bool) -> str:
    """Tell that Tangy does not do what staff typed ahead."""
    why = "The game is over" if over else "Tangy went on"
    return f"{why}, so it does not do this: {said}"


NOBODY_KNOWS = "nobody", "I do not know", "Tangy checks the card all the same"


def whose_words(card: int, *, all_known: bool) -> str:
    """Ask whose card is to be checked; `all_known`: everybody here has another card."""
    nobody = f"Nobody here has card {card}, as far as Tangy knows. "
    return f"{nobody if all_known else ''}Whose card is {card}?"


def has_card_words(card: int | None) -> str:
    """Tell which card a person has; "" if it is not known."""
    return "" if card is None else f"has card {card}"


def claim_words(word: str) -> str:
    """Tell what to type about a card to check; `word` begins the command."""
    return (
        f"Type the number on the card, as in: {word} 17. Or type the person's name, if Tangy knows "
        "their card."
    )


def not_known(words: str, near: Sequence[str] = ()) -> str:
    """Tell that words are not a command, and which similar ones there are."""
    meant = f" Did you mean: {', or '.join(near)}?" if near else ""
    tab = " Tab types it." if len(near) == 1 else " Tab types the first, then the next."
    return plain(f"Tangy does not know {words[:60]!r} here.{meant}{tab if near else ''}")
