"""In which world each game of the log was played, and whose beliefs a response belongs to."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime, timedelta

from tangy_profiles.events import EventRecord
from tangy_profiles.game_records import GameBeginning, GameStep, GameWorldSet
from tangy_profiles.game_world import BENCH, LIVE, SIMULATED, GameWorld, game_world
from tangy_profiles.store import Event, Store


class GameWorlds:
    """The worlds of the games of one log. What was read once is not read again."""

    def __init__(self, store: Store) -> None:
        """Read from a log."""
        self._store = store
        self._worlds: dict[str, GameWorld] = {}
        self._read = 0

    @property
    def all(self) -> Mapping[str, GameWorld]:
        """The world of every game, by its id, in the order of the log."""
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
        return self._worlds

    def set(self, game: str, world: GameWorld, by: str = "") -> None:
        """Say in which world a game was played; beliefs are counted anew by that.

        Args:
            game: its id.
            world: the world.
            by: who says so.
        """
        if self.all.get(game) != world:
            self._store.append(GameWorldSet(game=game, world=world, by=by))

    @property
    def last(self) -> GameWorld:
        """The world of the last game; before any game: simulated."""
        return next(reversed(list(self.all.values())), SIMULATED)

    def of(self, game: object, said: object = None) -> GameWorld:
        """Return the world that something in the log belongs to.

        Args:
            game: the id of its game, or None.
            said: the world that it names itself, where it belongs to no game.
        """
        return self.all.get(str(game)) or game_world(said) or SIMULATED


def _told_by_time(store: Store, begun: Mapping[str, Event[EventRecord]]) -> dict[str, GameWorld]:
    """Tell the world of games of before worlds were logged, by how long their calls took.

    A simulated call always takes the same time, and a robot's is measured. A game that was
    over sooner than its own steps say was played on the bench.
    """
    calls: dict[str, set[float]] = {game: set() for game in begun}
    lasted = dict.fromkeys(begun, 0.0)
    until = {game: event.at for game, event in begun.items()}
    for done in store.events(GameStep, after=min(event.seq for event in begun.values())):
        step, game = done.record, done.record.game
        if game not in begun or step.seconds is None:
            continue
        lasted[game] += step.seconds
        until[game] = done.at
        if step.numbers and step.target is None:
            calls[game].add(round(step.seconds, 3))
    found: dict[str, GameWorld] = {}
    for game, event in begun.items():
        took = datetime.fromisoformat(until[game]) - datetime.fromisoformat(event.at)
        hurried = took < timedelta(seconds=lasted[game] / 2)
        found[game] = SIMULATED if len(calls[game]) < 2 else BENCH if hurried else LIVE
    return found
