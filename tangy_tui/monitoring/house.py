"""The games of a facility over time, from the logs of one or more robots, by person."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from functools import cached_property
from typing import Any

from tangy_profiles.activity import Activity
from tangy_profiles.game_world import GameWorld
from tangy_profiles.person import folded
from tangy_profiles.store import Store
from tangy_tui.monitoring.attention import Attention, attention_by_game
from tangy_tui.monitoring.games import Game, read_games
from tangy_tui.monitoring.replay import AnsweredRequest, GameReplay, read_replays

SHORT_ROBOT = 6
"""Characters of a robot's id that identify it."""


@dataclass(frozen=True)
class RobotLog:
    """The log of one robot, read for reports: its games, and people's names.

    `robot` is its id, `label` its name in reports, and `named` are the ids of people with names.
    """

    robot: str
    label: str
    replays: tuple[GameReplay, ...]
    names: Mapping[str, str]
    named: frozenset[str]
    activities: Mapping[str, Activity]

    def name(self, person: str) -> str:
        """Return a person's name."""
        return self.names.get(person, person)

    def activity(self, game: Game) -> Activity | None:
        """Return the activity of a game, or None if it is unknown."""
        return self.activities.get(game.activity)

    @cached_property
    def attention(self) -> Mapping[str, Mapping[str, Attention]]:
        """The attention to each person, by the game's and the person's ids."""
        found = attention_by_game(self.replays)
        return {replay.game.id: one for replay, one in zip(self.replays, found, strict=True)}


@dataclass(frozen=True, slots=True)
class PersonInGame:
    """One person in one game of one robot."""

    log: RobotLog
    replay: GameReplay
    attention: Attention
    answers: tuple[AnsweredRequest, ...]

    @property
    def at(self) -> datetime:
        """When the game began."""
        return self.replay.game.at


@dataclass(slots=True)
class PersonOverTime:
    """One person in all games of a report, newest last."""

    name: str
    games: list[PersonInGame] = field(default_factory=list)

    @property
    def sum(self) -> Attention:
        """The person's attention, summed over the games."""
        added = Attention(self.name, could_visit=False)
        for one in self.games:
            added.add(one.attention)
        return added

    @property
    def answers(self) -> list[AnsweredRequest]:
        """The person's responses to requests."""
        return [answer for one in self.games for answer in one.answers]

    def to_json(self) -> dict[str, Any]:
        """Return the person's totals as JSON, with times in s."""
        added = self.sum
        return {
            "name": self.name,
            "games": len(self.games),
            "requests": added.requests,
            "waits": added.waits,
            "open_waits": added.open,
            "visits": added.visits,
            "seconds_with": added.seconds,
            "won": added.won,
            "asked": len(self.answers),
            "complied": sum(answer.complied is True for answer in self.answers),
        }


@dataclass(frozen=True, slots=True)
class Month:
    """The games of one calendar month in local time."""

    year: int
    month: int
    games: tuple[tuple[RobotLog, GameReplay], ...]

    @property
    def people(self) -> tuple[PersonOverTime, ...]:
        """The people who took part."""
        return people_over_time(self.games)

    def to_json(self) -> dict[str, Any]:
        """Return the month with the numbers of games and people as JSON."""
        month = f"{self.year}-{self.month:02}"
        return {"month": month, "games": len(self.games), "people": len(self.people)}


def read_log(
    store: Store,
    names: Mapping[str, str],
    activities: Mapping[str, Activity],
    games: Sequence[Game] | None = None,
) -> RobotLog:
    """Read a log for reports.

    Args:
        store: the log.
        names: people's names by id, in addition to those in the log.
        activities: the known activities, by name.
        games: the games to read; None for all.
    """
    given = store.names()
    chosen = read_games(store) if games is None else games
    first = next(iter(store.events()), None)
    robot = "" if first is None else first.robot
    called = {**given, **names}
    return RobotLog(
        robot,
        robot[:SHORT_ROBOT],
        tuple(read_replays(store, chosen, activities, called)),
        called,
        frozenset(given),
        activities,
    )


def of_world(logs: Iterable[RobotLog], world: GameWorld) -> list[tuple[RobotLog, GameReplay]]:
    """Return the games of one world from all logs, newest last."""
    found = [(log, r) for log in logs for r in log.replays if r.game.world == world]
    return sorted(found, key=lambda one: one[1].game.at)


def people_over_time(
    games: Iterable[tuple[RobotLog, GameReplay]],
) -> tuple[PersonOverTime, ...]:
    """Group games by person, in the order of their names.

    The same name in the logs of several robots is taken for the same person. People without a name
    are distinguished by robot.
    """
    found: dict[tuple[str, str], PersonOverTime] = {}
    for log, replay in games:
        answers = [answer for _, answer in replay.answers]
        for id, one in log.attention[replay.game.id].items():
            called = log.name(id)
            key = ("", folded(called)) if id in log.named else (log.robot, id)
            person = found.setdefault(key, PersonOverTime(called))
            own = tuple(answer for answer in answers if answer.person == id)
            person.games.append(PersonInGame(log, replay, one, own))
    return tuple(sorted(found.values(), key=lambda person: folded(person.name)))


def by_month(games: Iterable[tuple[RobotLog, GameReplay]]) -> list[Month]:
    """Group games by the month in which they began, newest last."""
    months: dict[tuple[int, int], list[tuple[RobotLog, GameReplay]]] = {}
    for log, replay in games:
        local = replay.game.at.astimezone()
        months.setdefault((local.year, local.month), []).append((log, replay))
    return [Month(year, month, tuple(found)) for (year, month), found in sorted(months.items())]


def last_session(games: Sequence[Game]) -> list[Game]:
    """Return the last game and the games before it that belong to the same session."""
    session = list(games[-1:])
    for game in reversed(games[:-1]):
        if game.seconds_before(session[0].at, session[0].world) is None:
            break
        session.insert(0, game)
    return session
