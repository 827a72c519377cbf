"""Limits on how often a person is asked without success."""

from __future__ import annotations

from dataclasses import dataclass

from tangy_profiles.reading import Table

VISIT, GAME = "asks_in_visit", "asks_in_game"
"""The keys of these limits in an activity's file."""


@dataclass(frozen=True)
class AskingLimits:
    """The number of refused requests after which a person is asked no more.

    `visit` counts those in a row, `game` all of a game. `named`: the activity's file has both.
    """

    visit: int = 3
    game: int = 6
    named: bool = False


def read_asking_limits(top: Table) -> AskingLimits:
    """Read the limits of an activity; missing ones get the defaults.

    Raises:
        ProfileError: a number is out of range, or the limit per visit exceeds that per game.
    """
    usual = AskingLimits()
    named = VISIT in top and GAME in top
    visit = top.whole(VISIT, 1, 10, usual.visit)
    game = top.whole(GAME, 1, 50, max(usual.game, visit))
    if game < visit:
        raise top.wrong(GAME, f"must not be below {VISIT}.")
    return AskingLimits(visit, game, named)
