"""How often a single look at a card is wrong, learnt from fused looks.

A look is wrong if the looks fused with it outvote it. The share of wrong looks determines how many
must agree before a contradiction of the expectation is believed.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, log

from tangy_profiles.game_records import GameBeginning, GameEnding
from tangy_profiles.game_world import GameWorld
from tangy_profiles.store import Store

PRIOR_WRONG, PRIOR_LOOKS = 2.0, 40.0
"""The prior: 1 look in 20 is wrong, with the weight of 40 looks."""
FALSELY = 1e-5
"""Accepted probability that all agreeing looks are wrong, if errors are independent."""
LEAST, MOST = 4, 8
"""The fewest and most looks that have to agree.

Wrong looks are correlated: with three agreeing looks there was one error in 500 games with 5% of
all looks late, with four none in 1,000.
"""


@dataclass
class ReaderErrorRate:
    """Counts looks, and those outvoted by others of the same moment."""

    looks: int = 0
    wrong: int = 0

    def add(self, agreeing: int, taken: int) -> None:
        """Count fused looks, and how many agree with the result."""
        self.looks += taken
        self.wrong += taken - agreeing

    @property
    def rate(self) -> float:
        """The share of wrong looks, from 0 to 1: the mean of the Beta posterior."""
        return (self.wrong + PRIOR_WRONG) / (self.looks + PRIOR_LOOKS)

    @property
    def needed(self) -> int:
        """How many looks have to agree before a contradiction is believed."""
        return max(LEAST, min(MOST, ceil(log(FALSELY) / log(self.rate))))


@dataclass(frozen=True, slots=True)
class FusedObservation:
    """The result of fused looks: agreeing looks, all looks, and the error rate of one."""

    agreeing: int
    taken: int
    rate: float


def learnt_error(store: Store, activity: str, world: GameWorld) -> ReaderErrorRate:
    """Read from the log how often looks were wrong in games of an activity.

    Args:
        store: the log.
        activity: its name.
        world: only games of this world count, as a simulated camera says nothing about a real one.
    """
    error, games = ReaderErrorRate(), set[str]()
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
