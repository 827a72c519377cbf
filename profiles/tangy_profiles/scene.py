"""The scene of the room at one moment, provided by worlds and drawn by screens."""

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
class ArrangedCard:
    """The next situation of a guided game: a person, and the state of their card when they ask.

    `hidden`: the card is out of view when the robot arrives.
    """

    person: str
    user_state: str
    hidden: bool


@dataclass(frozen=True, slots=True)
class ArrangedSituation:
    """The situation that a guided game is about to bring about.

    `goes_back`: the game returns to an earlier moment for it.
    """

    situation: Situation
    goes_back: bool = False


@dataclass(frozen=True, slots=True)
class Scene:
    """Robot, people and game at one moment.

    `place` is the robot's place or destination, `requests` those who ask, first come first, `doing`
    each person's observed activity in a word or two, `called` the called numbers in order, `card`
    the readable card, if any, and `away` the absent people.
    """

    place: str
    requests: tuple[str, ...]
    doing: Mapping[str, str]
    called: tuple[int, ...]
    card: CardView | None
    away: frozenset[str] = frozenset()
