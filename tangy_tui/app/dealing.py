"""Parsing of the cards that staff dealt: Rosa=17."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tangy_profiles.card_face import LAST_CARD
from tangy_profiles.errors import TangyError
from tangy_profiles.person import Person, folded
from tangy_profiles.reading import nearest, plain


def read_dealt(texts: Iterable[str], people: Sequence[Person]) -> dict[str, int]:
    """Parse who has which card; return the card numbers by person id.

    Raises:
        TangyError: a person or card does not exist, or a person or card comes up twice.
    """
    dealt: dict[str, int] = {}
    for text in texts:
        name, _, number = text.rpartition("=")
        whom = _person(name, people)
        if whom is None:
            near = nearest(name, [person.name for person in people])
            raise TangyError(plain(f"--card {text[:60]!r}: nobody who plays is called so; {near}"))
        digits = number.strip()
        card = int(digits) if digits.isascii() and digits.isdigit() and len(digits) < 6 else 0
        if not 1 <= card <= LAST_CARD:
            raise TangyError(
                plain(f"--card {text[:60]!r}: cards have the numbers 1 to {LAST_CARD}.")
            )
        if whom.id in dealt or card in dealt.values():
            raise TangyError(
                plain(f"--card {text[:60]!r}: nobody has two cards, and no card two people.")
            )
        dealt[whom.id] = card
    return dealt


def _person(name: str, people: Sequence[Person]) -> Person | None:
    wanted = folded(name)
    return next((p for p in people if wanted in (folded(p.name), folded(p.id))), None)
