"""How often a single look at what people have before them is wrong, learnt from fused looks.

A look is wrong if the looks that were taken together with it overrule it. From the share of such
looks follows how many have to agree before what contradicts the expectation is believed.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, log

from tangy_profiles.game_records import GameBeginning, GameEnding
from tangy_profiles.game_world import GameWorld
from tangy_profiles.store import Store

PRIOR_WRONG, PRIOR_LOOKS = 2.0, 40.0
"""Before anything is learnt 1 look in 20 is taken to be wrong, as sure as after 40 looks."""
FALSELY = 1e-5
"""P(as many wrong looks in a row as have to agree) that is borne, if they are independent."""
LEAST, MOST = 4, 8
"""Looks that have to agree. Wrong ones come together more often than independent ones would, and of
three that agree one was wrong in 500 games with 5% of all looks late, of four none in 1,000."""


@dataclass
class ReadingError:
    """Counts looks, and those that were overruled by others of the same moment."""

    looks: int = 0
    wrong: int = 0

    def add(self, agreeing: int, taken: int) -> None:
        """Count looks that were taken together, and how many agree with the fused reading."""
        self.looks += taken
        self.wrong += taken - agreeing

    @property
    def rate(self) -> float:
        """The share of looks that are wrong, from 0 to 1: the mean of the Beta posterior."""
        return (self.wrong + PRIOR_WRONG) / (self.looks + PRIOR_LOOKS)

    @property
    def needed(self) -> int:
        """How many looks have to agree on what contradicts the expectation."""
        return max(LEAST, min(MOST, ceil(log(FALSELY) / log(self.rate))))


@dataclass(frozen=True, slots=True)
class FusedLook:
    """The result of several looks: agreeing looks, all looks, and the error rate of one."""

    agreeing: int
    taken: int
    rate: float


def learnt_error(store: Store, activity: str, world: GameWorld) -> ReadingError:
    """Read from the log how often looks were wrong in games of an activity.

    Args:
        store: the log.
        activity: its name.
        world: only games of this world count: a simulated eye says nothing of a real one.
    """
    error, games = ReadingError(), set[str]()
    for event in store.events(GameBeginning, GameEnding):
        match event.record:
            case GameBeginning(game=game, activity=name, world=where):
                if name == activity and where == world:
                    games.add(game)
            case GameEnding(game=game, looks=looks, looks_wrong=wrong):
                if game in games:
                    error.looks += looks
                    error.wrong += min(wrong, looks)
    return error
