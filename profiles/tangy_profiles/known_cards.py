"""Whose card was known in a game, as read from the log."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

from tangy_profiles.staff_records import StaffActionKind


class CardAction(Protocol):
    """What the log says of a card: a staff action, or its copy in a report."""

    @property
    def did(self) -> StaffActionKind | str:
        """The kind of the action."""
        ...

    @property
    def person(self) -> str:
        """The person it concerns."""
        ...

    @property
    def detail(self) -> str:
        """The card, or the cards of people."""
        ...


@dataclass(frozen=True, slots=True)
class KnownCards:
    """Whose card is known in a game, by person: as staff gave them, and as the robot saw them."""

    given: Mapping[str, int] = field(default_factory=dict[str, int])
    seen: Mapping[str, int] = field(default_factory=dict[str, int])

    @classmethod
    def of(cls, notes: Iterable[CardAction]) -> KnownCards:
        """Return what the log says of a game, oldest note first; a card has one owner."""
        given, seen = dict[str, int](), dict[str, int]()
        for note in notes:
            match note.did:
                case "cards dealt":
                    pairs = (pair.rpartition(" ") for pair in note.detail.split(", "))
                    given = {who: int(card) for who, _, card in pairs if _digits(card)}
                    taken = {*given.values()}  # a resumed game notes what was given once more
                    seen = {o: c for o, c in seen.items() if o not in given and c not in taken}
                case "card given" | "card learnt":
                    card = int(note.detail) if _digits(note.detail) else None
                    for known in (given, seen):
                        for one in [o for o, c in known.items() if o == note.person or c == card]:
                            del known[one]
                    if card is not None:
                        (given if note.did == "card given" else seen)[note.person] = card
                case _:
                    pass
        return cls(given, seen)


def _digits(text: str) -> bool:
    return text.isascii() and text.isdecimal()
