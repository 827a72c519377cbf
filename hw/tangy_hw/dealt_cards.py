"""Which card belongs to each person, and whether a card before a person is theirs.

Staff, or a dealing program, may assign cards; others are learnt for a game from the first certain
sight of a single card at a person's place. A card is judged only if it is known to be the person's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

Doubt = Literal["several cards", "copies", "another's card", "other card"]
"""Reason not to judge a card: several cards are in sight, of one number or not; it belongs to
another person; or it is not the one that this person has."""


@dataclass(frozen=True, slots=True)
class CardDoubt:
    """A card that is not judged: the person, the cards in sight, and the reason.

    `own` is the person's known card; `owner` is the owner of the card in sight, if it belongs to
    another person.
    """

    person: str
    cards: tuple[int, ...]
    why: Doubt
    own: int | None = None
    owner: str = ""


@dataclass(frozen=True, slots=True)
class CardLearnt:
    """A card was seen before a person, and counts as theirs from now on."""

    person: str
    card: int


class DealtCards:
    """Owners of the cards in a game."""

    def __init__(self) -> None:
        self._given: dict[str, int] = {}
        self._learnt: dict[str, int] = {}

    @property
    def given(self) -> Mapping[str, int]:
        """Cards that were assigned, by person."""
        return self._given

    def begin(self) -> None:
        """Start a game, and forget the learnt cards of the last one."""
        self._learnt.clear()

    def deal(self, cards: Mapping[str, int]) -> None:
        """Assign cards; earlier assignments no longer hold."""
        self._given, self._learnt = dict(cards), {}

    def recall(self, given: Mapping[str, int], learnt: Mapping[str, int]) -> None:
        """Assign the cards of an interrupted game, where no newer assignment says otherwise."""
        for known, cards in ((self._given, given), (self._learnt, learnt)):
            for person, card in cards.items():
                if self.card_of(person) is None and not self.owner(card):
                    known[person] = card

    def give(self, person: str, card: int | None) -> None:
        """Assign a card to a person; None: it is learnt again.

        Nobody else owns it from then on.
        """
        for known in (self._given, self._learnt):
            known.pop(person, None)
            for other in [one for one, theirs in known.items() if theirs == card]:
                del known[other]
        if card is not None:
            self._given[person] = card

    def card_of(self, person: str) -> int | None:
        """Return a person's card, None if unknown."""
        return self._given.get(person, self._learnt.get(person))

    def owner(self, card: int) -> str:
        """Return the owner of a card, "" if unknown."""
        people = {**self._learnt, **self._given}
        return next((person for person in people if self.card_of(person) == card), "")

    def learn(self, person: str, card: int) -> bool:
        """Assign a clearly seen card to a person without one; return whether this was new."""
        if self.card_of(person) is not None or self.owner(card):
            return False
        self._learnt[person] = card
        return True

    def doubt(self, person: str, cards: Sequence[int]) -> CardDoubt | None:
        """Return why no card before a person can be judged; None if the only one is theirs.

        A card without an owner counts as that of a person without a card.
        """
        own, there = self.card_of(person), tuple(cards)
        if len(there) > 1:
            why: Doubt = "copies" if len(set(there)) == 1 else "several cards"
            return CardDoubt(person, there, why, own)
        if not there or there[0] == own:
            return None
        if owner := self.owner(there[0]):
            return CardDoubt(person, there, "another's card", own, owner)
        return None if own is None else CardDoubt(person, there, "other card", own)
