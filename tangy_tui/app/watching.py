"""Looking on at the games of another program: through its socket, and the log."""

from __future__ import annotations

import json
import os
import select
import socket
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tangy_profiles.activity import Activity, known_activities, load_activity
from tangy_profiles.codec import InvalidValue, decode
from tangy_profiles.errors import ProfileError, TangyError
from tangy_profiles.person import MOST_PEOPLE, load_people
from tangy_profiles.room import Room, room_for
from tangy_profiles.store import Store
from tangy_tui.app.game_view import GameView
from tangy_tui.app.rooms import find_room
from tangy_tui.app.session_door import FILE, LONGEST_NAME, reachable
from tangy_tui.monitoring.games import Game, read_games
from tangy_tui.monitoring.replay import GameReplay, Moment, read_replays

WATCH_SECONDS = 0.2
"""The interval of checks by an onlooker; snapshots come no more often."""
LARGEST_VIEW = 1_000_000  # bytes
CHUNK = 65_536
PATIENCE_SECONDS = 1.0  # for the socket to answer


def room_of(view: GameView, folder: Path) -> Room:
    """Return the room of a game in a data folder, or one that fits the number of people."""
    with suppress(ProfileError):
        if view.room:
            return find_room(folder, view.room)
    return room_for(len(view.scene.doing))


class NobodyThere(TangyError):
    """No program runs games in this folder."""


class Guest:
    """A connection to the socket of a data folder: receives snapshots, and may stop the robot."""

    def __init__(self, folder: Path) -> None:
        """Set the folder; `look` connects to its socket."""
        self._folder = folder
        self._socket: socket.socket | None = None
        self._heard = b""
        self.pid = 0
        """The process that runs the games; 0: none."""
        self.view: GameView | None = None
        """The latest snapshot of the game, None if there is no game."""
        self.stops = self.answers = 0
        """The number of stops of the robot from here, and of answers to stop requests."""

    def look(self) -> bool:
        """Read new snapshots, connecting first if needed; return whether it is connected."""
        if self._socket is None and not self._enter():
            return False
        assert self._socket is not None  # noqa: S101 - it is connected
        while True:
            try:
                said = self._socket.recv(CHUNK)
            except BlockingIOError:
                break
            except OSError:
                said = b""
            if not said or len(self._heard) > LARGEST_VIEW:
                self.close()
                return False
            self._heard += said
        *lines, self._heard = self._heard.split(b"\n")
        for line in lines:
            self._take(line)
        return True

    def look_first(self) -> bool:
        """Look, and wait a little until the program there has said how its game stands."""
        there, until = self.look(), time.monotonic() + PATIENCE_SECONDS
        while there and not self.pid and (left := until - time.monotonic()) > 0:
            assert self._socket is not None  # noqa: S101 - somebody is there
            select.select([self._socket], [], [], left)
            there = self.look()
        return there

    def stop(self, by: str) -> None:
        """Stop the robot.

        Args:
            by: who stops it, for the log.

        Raises:
            NobodyThere: no program runs games in this folder.
        """
        said = json.dumps({"stop": by[:LONGEST_NAME]}).encode() + b"\n"
        if not self._says(said):
            self.close()  # it was disconnected, or that program has ended: another may be there
            if not self._says(said):
                raise NobodyThere("")

    def _says(self, said: bytes) -> bool:
        """Send data to the socket; return whether that worked."""
        if self._socket is None and not self._enter():
            return False
        assert self._socket is not None  # noqa: S101 - it is connected
        try:
            self._socket.sendall(said)
        except OSError:
            return False
        return True

    def answered(self, seconds: float = 5.0) -> bool:
        """Wait for the answer to a stop, up to some s; return whether there was a robot to stop."""
        until, before = time.monotonic() + seconds, self.stops
        while self._socket is not None and time.monotonic() < until:
            select.select([self._socket], [], [], 0.1)
            answers = self.answers
            self.look()
            if self.answers > answers:
                return self.stops > before
        return False

    def close(self) -> None:
        """Disconnect; may be repeated."""
        entered, self._socket = self._socket, None
        self._heard, self.view, self.pid = b"", None, 0
        if entered is not None:
            entered.close()

    def _enter(self) -> bool:
        entered = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        entered.settimeout(PATIENCE_SECONDS)
        try:
            with reachable(self._folder) as place:
                entered.connect(os.path.join(place, FILE))  # noqa: PTH118 - `/proc` is no folder
        except OSError:
            entered.close()
            return False
        entered.setblocking(False)
        self._socket = entered
        return True

    def _take(self, line: bytes) -> None:
        try:
            said: Any = json.loads(line)
            if "stopped" in said:
                self.answers += 1
                self.stops += bool(said["stopped"])
                return
            self.pid = int(said["pid"])
            self.view = None if said["view"] is None else decode(GameView, said["view"])
        except (ValueError, TypeError, KeyError, RecursionError, InvalidValue):
            self.close()  # from another version


@dataclass(frozen=True, slots=True)
class News:
    """New entries of the log: the game, its new moments, and whether it has just begun.

    `replay` is all of the game so far.
    """

    replay: GameReplay
    moments: tuple[Moment, ...]
    begun: bool
    activity: Activity | None

    @property
    def game(self) -> Game:
        """The game as logged."""
        return self.replay.game


class WatchedLog:
    """Follows the newest game of a log. `news` returns what was added since the last call."""

    def __init__(self, store: Store) -> None:
        """Follow a log that is open for reading."""
        self._store = store
        self._read = 0
        self._game = ""
        self._told = 0
        self.over = False
        """Whether the newest game has an end in the log."""
        self._known: dict[str, Activity | None] = {}
        self._usual = {p.id: p.name for p in load_people(MOST_PEOPLE)}
        self.names: Mapping[str, str] = {}
        """The names of the people, by id."""

    @property
    def folder(self) -> Path:
        """The data folder of the log."""
        return self._store.folder

    def news(self) -> News | None:
        """Read new entries; None if there are none."""
        newest = max((event.seq for event in self._store.events(after=self._read)), default=0)
        if newest <= self._read:
            return None
        self._read = newest
        games = read_games(self._store)
        if not games:
            return None
        game = games[-1]
        begun = game.id != self._game
        if begun:
            self._game, self._told, self.over = game.id, 0, False
        self.names = self._usual | self._store.names()  # a new person may have joined
        activity = self.activity(game.activity)
        known = {} if activity is None else {game.activity: activity}
        (replay,) = read_replays(self._store, [game], known, self.names)
        moments = tuple(replay.moments[self._told :])
        ended = game.ended is not None and not self.over
        if not (begun or moments or ended):
            return None
        self._told, self.over = len(replay.moments), game.ended is not None
        return News(replay, moments, begun, activity)

    def name(self, person: str) -> str:
        """Return a person's name."""
        return self.names.get(person, person)

    def activity(self, name: str) -> Activity | None:
        """Return an activity by name, None if it is not installed."""
        if name not in self._known:
            there = name in known_activities()
            self._known[name] = load_activity(name) if there else None
        return self._known[name]
