"""How often a person is asked in vain before they are left in peace."""

from __future__ import annotations

from dataclasses import dataclass

from tangy_profiles.reading import Table

VISIT, GAME = "asks_in_visit", "asks_in_game"
"""The keys of an activity's file that say how often."""


@dataclass(frozen=True)
class AskingLimits:
    """After so many requests that a person did not follow they are asked no more.

    `visit` counts those in a row, `game` all of a game. `named`: the activity's file says both.
    """

    visit: int = 3
    game: int = 6
    named: bool = False


def read_asking_limits(top: Table) -> AskingLimits:
    """Read how often people are asked; what a file leaves out is as usual.

    Raises:
        ProfileError: a number that is out of range, or more in a visit than in a game.
    """
    usual = AskingLimits()
    named = VISIT in top and GAME in top
    visit = top.whole(VISIT, 1, 10, usual.visit)
    game = top.whole(GAME, 1, 50, max(usual.game, visit))
    if game < visit:
        raise top.wrong(GAME, f"must not be below {VISIT}.")
    return AskingLimits(visit, game, named)
