"""The world of a game: simulation, the bench of simulated devices, or a robot.

Beliefs about people are separate for each world, so that simulated people teach Tangy nothing about
real ones.
"""

from __future__ import annotations

from typing import Any, Literal, get_args

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import nearest, plain

GameWorld = Literal["unknown", "simulated", "bench", "live"]
"""`unknown`: an old log does not say; such games count for no other world."""
UNKNOWN: GameWorld = "unknown"
SIMULATED: GameWorld = "simulated"
BENCH: GameWorld = "bench"
LIVE: GameWorld = "live"
GAME_WORLDS: tuple[GameWorld, ...] = get_args(GameWorld)
PLAYED_WORLDS: tuple[GameWorld, ...] = tuple(w for w in GAME_WORLDS if w != UNKNOWN)
"""The worlds in which games are played."""


def game_world(value: Any) -> GameWorld | None:
    """Return the world named in a log or file; None if it is not valid."""
    return next((world for world in GAME_WORLDS if world == value), None)


def read_game_world(word: str) -> GameWorld:
    """Return the world that a person named.

    Raises:
        TangyError: there is no such world; the message suggests the nearest one.
    """
    world = game_world(word.strip().casefold())
    if world is None:
        raise TangyError(plain(f"There are no {word!r} games: {nearest(word, GAME_WORLDS)}"))
    return world
