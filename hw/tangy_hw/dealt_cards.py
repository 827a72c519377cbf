"""Which card each person plays with, and whether a card that lies before somebody is theirs.

Staff, or whatever deals, say which cards were dealt; what they do not say is learnt from the first
sure sight of a single card at a person's place, for this game. A card is judged only where it is
known to be that person's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

Doubt = Literal["several cards", "copies", "another's card", "other card"]
"""Why a card is not judged: more than one is in sight, all of one number or not; it is another
person's; or it is not the one that this person has."""


@dataclass(frozen=True, slots=True)
class CardDoubt:
    """A card that is not judged: the person, the cards in sight, and the reason.

    `own` is the card that the person has, as far as is known; `owner` is whose the card in sight
    is, if it is another person's.
    """

    person: str
    cards: tuple[int, ...]
    why: Doubt
    own: int | None = None
    owner: str = ""


@dataclass(frozen=True, slots=True)
class CardLearnt:
    """A card was seen before somebody, and is taken for theirs from now on."""

    person: str
    card: int


class DealtCards:
    """The owners of the cards in a game."""

    def __init__(self) -> None:
        self._given: dict[str, int] = {}
        self._learnt: dict[str, int] = {}

    @property
    def given(self) -> Mapping[str, int]:
        """The cards that staff, or whatever deals, said were dealt, by person."""
        return self._given

    def begin(self) -> None:
        """Begin a game, and forget the assignments of the last one."""
        self._learnt.clear()

    def deal(self, cards: Mapping[str, int]) -> None:
        """Set the dealt cards; earlier assignments no longer hold."""
        self._given, self._learnt = dict(cards), {}

    def give(self, person: str, card: int | None) -> None:
        """Set a person's card; None: it is learnt again.

        Nobody else has it then, whatever was said or learnt before.
        """
        for known in (self._given, self._learnt):
            known.pop(person, None)
            for other in [one for one, theirs in known.items() if theirs == card]:
                del known[other]
        if card is not None:
            self._given[person] = card

    def card_of(self, person: str) -> int | None:
        """Return the number of a person's card, None where it is not known."""
        return self._given.get(person, self._learnt.get(person))

    def owner(self, card: int) -> str:
        """Return the owner of a card, "" if unknown."""
        people = {**self._learnt, **self._given}
        return next((person for person in people if self.card_of(person) == card), "")

    def learn(self, person: str, card: int) -> bool:
        """Take a card that was surely seen before a person for theirs; say whether that is new."""
        if self.card_of(person) is not None or self.owner(card):
            return False
        self._learnt[person] = card
        return True

    def doubt(self, person: str, cards: Sequence[int]) -> CardDoubt | None:
        """Say why of these cards before a person none can be judged; None: the one is theirs.

        A card that nobody is known to have is theirs as long as they are not known to have one.
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
