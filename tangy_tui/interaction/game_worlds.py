"""The world of each logged game: it decides which posterior a response updates."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from datetime import datetime, timedelta

from tangy_profiles.events import EventRecord
from tangy_profiles.game_records import GameBeginning, GameStep, GameWorldSet
from tangy_profiles.game_world import BENCH, SIMULATED, UNKNOWN, GameWorld, game_world
from tangy_profiles.store import Event, Store

FEWEST_CALLS = 2
"""With fewer calls, equal durations prove nothing."""


class GameWorlds:
    """The worlds of the games in a log, cached."""

    def __init__(self, store: Store) -> None:
        """Read from a log."""
        self._store = store
        self._worlds: dict[str, GameWorld] = {}
        self._said: set[str] = set()
        self._read = 0

    @property
    def all(self) -> Mapping[str, GameWorld]:
        """The world of every game, by id, in the order of the log."""
        unmarked: dict[str, Event[EventRecord]] = {}
        said: dict[str, GameWorld] = {}
        for event in self._store.events(GameBeginning, GameWorldSet, after=self._read):
            self._read = event.seq
            match event.record:
                case GameWorldSet(game=game, world=named):
                    said[game] = named
                case GameBeginning(game=game, world=world):
                    self._worlds[game] = world or SIMULATED
                    if world is None:
                        unmarked[game] = event
        if unmarked:
            self._worlds.update(_told_by_time(self._store, unmarked))
        self._worlds.update(said)
        self._said.update(said)
        return self._worlds

    @property
    def unasked(self) -> list[str]:
        """The games whose world is unknown and was not asked for yet."""
        return [g for g, world in self.all.items() if world == UNKNOWN and g not in self._said]

    def settle(self, games: Collection[str], world: GameWorld, by: str = "") -> None:
        """Log the world of some games; `unknown` means that nobody knows."""
        with self._store.transaction():
            for game in games:
                self._store.append(GameWorldSet(game=game, world=world, by=by))

    def set(self, game: str, world: GameWorld, by: str = "") -> None:
        """Log the world of a game; beliefs are then counted accordingly.

        Args:
            game: its id.
            world: the world.
            by: who says so.
        """
        if self.all.get(game) != world:
            self._store.append(GameWorldSet(game=game, world=world, by=by))

    @property
    def last(self) -> GameWorld:
        """The world of the last game whose world is known; simulated if there is none."""
        known = [world for world in self.all.values() if world != UNKNOWN]
        return known[-1] if known else SIMULATED

    def of(self, game: object, said: object = None) -> GameWorld:
        """Return the world that an event belongs to.

        Args:
            game: the id of its game, or None.
            said: its own world, if it belongs to no game.
        """
        return self.all.get(str(game)) or game_world(said) or SIMULATED


def _told_by_time(store: Store, begun: Mapping[str, Event[EventRecord]]) -> dict[str, GameWorld]:
    """Infer the world of games logged without one from their times.

    Simulated calls always take the same time; calls by devices are measured. A game with devices
    that ended sooner than the sum of its steps was played on the bench. All others are unknown: a
    game on the bench may take as long as one with a robot and people.
    """
    calls: dict[str, list[float]] = {game: [] for game in begun}
    lasted = dict.fromkeys(begun, 0.0)
    until = {game: event.at for game, event in begun.items()}
    for done in store.events(GameStep, after=min(event.seq for event in begun.values())):
        step, game = done.record, done.record.game
        if game not in begun or step.seconds is None:
            continue
        lasted[game] += step.seconds
        until[game] = done.at
        if step.numbers and step.target is None:
            calls[game].append(round(step.seconds, 3))
    found: dict[str, GameWorld] = {}
    for game, event in begun.items():
        took = datetime.fromisoformat(until[game]) - datetime.fromisoformat(event.at)
        hurried = took < timedelta(seconds=lasted[game] / 2)
        if len(calls[game]) < FEWEST_CALLS:
            found[game] = UNKNOWN
        elif len(set(calls[game])) == 1:
            found[game] = SIMULATED
        else:
            found[game] = BENCH if hurried else UNKNOWN
    return found
