"""The scene of the room at one moment: worlds provide it, and screens draw it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tangy_profiles.state import Situation


@dataclass(frozen=True, slots=True)
class CardView:
    """The card beside the robot as it was read: its numbers row by row, and two cell masks."""

    person: str
    numbers: tuple[int, ...]
    marked: int
    called: int


@dataclass(frozen=True, slots=True)
class Arranged:
    """The coming situation of a guided game: a person, and the state of their card when they ask.

    `hidden`: the card is out of view when the robot arrives.
    """

    person: str
    user_state: str
    hidden: bool


@dataclass(frozen=True, slots=True)
class ArrangedSituation:
    """The situation that a guided game is about to bring about.

    `goes_back`: the game goes on from an earlier moment for it.
    """

    situation: Situation
    goes_back: bool = False


@dataclass(frozen=True, slots=True)
class Scene:
    """Robot, people and game at one moment.

    `place` is where the robot is (or is driving to), `requests` who asks for help, first come
    first, `doing` what each person is seen to do in a word or two, `called` the numbers so far
    in order, `card` the card that the robot can read, if any, `away` who has not come, or has left.
    """

    place: str
    requests: tuple[str, ...]
    doing: Mapping[str, str]
    called: tuple[int, ...]
    card: CardView | None
    away: frozenset[str] = frozenset()
