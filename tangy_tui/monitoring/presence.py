"""When each person took part in the games of a session, from the log alone."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from tangy_profiles.game_records import GameChange
from tangy_tui.monitoring.replay import GameReplay


@dataclass(frozen=True, slots=True)
class Stay:
    """From when to when a person took part; None: from the beginning, or to the end."""

    since: datetime | None
    until: datetime | None

    @property
    def whole(self) -> bool:
        """Whether the person was there all the time."""
        return self.since is None and self.until is None

    def at(self, when: datetime) -> bool:
        """Return whether the person was there at a time within the games."""
        since = self.since is None or self.since <= when
        return since and (self.until is None or when <= self.until)

    def to_json(self) -> dict[str, Any]:
        """Return the times as `--json` prints them."""
        return {
            "since": self.since and self.since.isoformat(),
            "until": self.until and self.until.isoformat(),
        }


def stays(replays: Iterable[GameReplay]) -> dict[str, tuple[Stay, ...]]:
    """Return when each person took part, by id, in order; games in a row count as one stretch."""
    found = dict[str, list[Stay]]()
    here = dict[str, datetime | None]()  # since when; None: from the beginning
    last: datetime | None = None  # when the game before ended
    for number, replay in enumerate(replays):
        game = replay.game
        present = set(game.people) - set(game.joined) - game.absent
        for person in [one for one in here if one not in present]:
            found.setdefault(person, []).append(Stay(here.pop(person), last))
        for person in present - here.keys():
            here[person] = game.at if number else None
        for at, change in _moves(replay):
            if change.what != "left":
                here.setdefault(change.person, at)
            elif change.person in here:
                found.setdefault(change.person, []).append(Stay(here.pop(change.person), at))
        last = game.ended or _last(replay)
    for person, since in here.items():
        found.setdefault(person, []).append(Stay(since, None))
    return {person: tuple(each) for person, each in found.items()}


def _moves(replay: GameReplay) -> Iterator[tuple[datetime, GameChange]]:
    for moment in replay.staff_changes:
        change = moment.what
        if isinstance(change, GameChange) and change.what in ("came", "left", "joined"):
            yield datetime.fromisoformat(moment.at), change


def _last(replay: GameReplay) -> datetime:
    """Return the last moment of a game without an ending in the log."""
    return datetime.fromisoformat(replay.moments[-1].at) if replay.moments else replay.game.at
