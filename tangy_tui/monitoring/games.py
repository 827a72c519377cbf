"""The games in the log: their times, policies and endings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date, datetime
from typing import Any, NamedTuple

from tangy_profiles.errors import TangyError
from tangy_profiles.events import EventRecord
from tangy_profiles.faults import CRITICAL
from tangy_profiles.game_records import (
    FaultDiagnosed,
    FaultMove,
    GameBeginning,
    GameChange,
    GameEnding,
    GameStep,
    RecoveryEvent,
)
from tangy_profiles.game_world import SIMULATED, GameWorld
from tangy_profiles.reading import did_you_mean, plain
from tangy_profiles.store import Event, Store
from tangy_profiles.teaching_records import PolicyLearnt
from tangy_tui.interaction.game_worlds import GameWorlds
from tangy_tui.monitoring.fault import OPEN, Fault, read_faults

SHORTEST = 4
"""Characters of an id that identify a game."""
LAST, ALL = "last", "all"
SESSION_GAP = 1800.0
"""The longest time (s) between two games of a session."""


@dataclass(frozen=True, slots=True)
class Game:
    """One game of the log.

    `number` counts all games of the log from 1. `seq` and `last_seq` are the events that began and
    ended it. `digest` is the policy's digest, and `policy` its name if the log has it. `critical`
    and `other` count its faults, without questions.
    """

    number: int
    id: str
    seq: int
    at: datetime
    activity: str
    policy: str
    digest: str
    people: tuple[str, ...]
    steps: int
    critical: int
    other: int
    ended: datetime | None
    last_seq: int | None
    stopped: str | None
    world: GameWorld = SIMULATED
    asks: tuple[int, int] = (0, 0)
    """How often a person may be asked without success, per visit and per game; 0: not logged."""
    pauses: tuple[int, float] = (0, 0.0)
    """How often the robot waited for late data, and for how many s."""
    away: frozenset[str] = frozenset()
    """Those whom staff marked as absent, and who did not come during the game."""
    due: str = ""
    """The behaviour expected instead of the one that ended it; "" if the end was due."""
    rounds_left: int = 0
    patterns: tuple[str, ...] = ()
    """The patterns that staff chose before it began."""
    absent: frozenset[str] = frozenset()
    """Those who had not come yet when it began."""
    joined: tuple[str, ...] = ()
    """Those of `people` who joined it while it went on."""
    file: str = ""
    """The path of the activity's file, if it comes neither with Tangy nor with a package."""

    @property
    def smooth(self) -> bool:
        """Whether it was played to its end."""
        return self.ended is not None and self.stopped is None and not self.due

    def seconds_before(self, at: datetime, world: GameWorld) -> float | None:
        """Return how long (s) it was over when the next game began in its session.

        None: a game that began at that time in that world is none of its session.
        """
        between = (at - (self.ended or self.at)).total_seconds()
        return None if world != self.world or between > SESSION_GAP else max(0.0, between)

    def to_json(self) -> dict[str, Any]:
        """Return the game as `--json` lists it, without its ending in words."""
        return {
            "number": self.number,
            "id": self.id,
            "at": self.at.isoformat(),
            "activity": self.activity,
            "policy": self.policy,
            "digest": self.digest,
            "people": list(self.people),
            "steps": self.steps,
            "faults": {"critical": self.critical, "other": self.other},
            "ended": self.ended and self.ended.isoformat(),
            "stopped": self.stopped,
            "due": self.due,
            "rounds_left": self.rounds_left,
            "world": self.world,
            "asks_in_visit": self.asks[0],
            "asks_in_game": self.asks[1],
            "pauses": {"count": self.pauses[0], "seconds": self.pauses[1]},
        }


class _Begun(NamedTuple):
    event: Event[EventRecord]
    record: GameBeginning
    policy: str


def read_games(store: Store) -> list[Game]:
    """Read all games of a log, newest last."""
    begun: dict[str, _Begun] = {}
    ended: dict[str, tuple[Event[EventRecord], GameEnding]] = {}
    faults: dict[str, list[bool]] = {}
    policies: dict[str, str] = {}
    away: dict[str, frozenset[str]] = {}
    joined: dict[str, list[str]] = {}
    for event in store.events(GameBeginning, GameEnding, FaultDiagnosed, PolicyLearnt, GameChange):
        match event.record:
            case PolicyLearnt(digest=digest, name=name):
                policies[digest] = name
            case GameBeginning(game=game, policy=policy) as record:
                begun[game] = _Begun(event, record, policies.get(policy, ""))
                away[game] = frozenset(record.absent)
            case GameChange(game=game, what="joined", person=person) if game in begun:
                joined.setdefault(game, []).append(person)
            case GameChange(game=game, what="came", person=person):
                away[game] = away.get(game, frozenset()) - {person}
            case GameEnding(game=game) as record:
                ended[game] = event, record
            case FaultDiagnosed(game=game, evidence=evidence, criticality=criticality):
                if "situation.shown" not in evidence:
                    faults.setdefault(game, []).append(criticality == CRITICAL)
    steps = _steps_of_unended(store, begun.keys() - ended.keys(), begun)
    worlds = GameWorlds(store).all
    return [
        _game(
            number,
            game,
            ended.get(id),
            faults.get(id, []),
            steps.get(id, 0),
            worlds.get(id, SIMULATED),
            away[id],
            joined.get(id, ()),
        )
        for number, (id, game) in enumerate(begun.items(), 1)
    ]


def _steps_of_unended(store: Store, games: set[str], begun: dict[str, _Begun]) -> dict[str, int]:
    """Count the steps of games without an ending in the log."""
    counts: dict[str, int] = dict.fromkeys(games, 0)
    if games:
        for event in store.events(GameStep, after=min(begun[id].event.seq for id in games)):
            game = event.record.game
            if game in counts:
                counts[game] += 1
    return counts


def _game(
    number: int,
    game: _Begun,
    ended: tuple[Event[EventRecord], GameEnding] | None,
    faults: Sequence[bool],
    steps: int,
    world: GameWorld,
    away: frozenset[str],
    joined: Sequence[str],
) -> Game:
    event, begun, policy = game
    end, ending = ended or (None, None)
    return Game(
        number=number,
        id=begun.game,
        seq=event.seq,
        at=datetime.fromisoformat(event.at),
        activity=begun.activity,
        policy=policy or begun.policy[:8],
        digest=begun.policy,
        people=(*begun.people, *joined),
        steps=steps if ending is None else ending.steps,
        critical=sum(faults),
        other=len(faults) - sum(faults),
        ended=None if end is None else datetime.fromisoformat(end.at),
        last_seq=None if end is None else end.seq,
        patterns=begun.patterns,
        absent=frozenset(begun.absent),
        joined=tuple(joined),
        file=begun.file,
        stopped=None if ending is None else ending.stopped,
        due="" if ending is None else ending.due,
        rounds_left=0 if ending is None else ending.rounds_left,
        world=world,
        asks=(begun.asks_in_visit, begun.asks_in_game),
        pauses=(0, 0.0) if ending is None else (ending.pauses, ending.paused_seconds),
        away=away,
    )


def find_games(games: Sequence[Game], wanted: str) -> list[Game]:
    """Return the games that a word selects: a number, an id or its prefix, a day, last or all.

    Raises:
        TangyError: no game matches, or an id prefix is ambiguous; the message lists the choices.
    """
    word = wanted.strip().casefold()
    if not games:
        raise TangyError("No game was played yet: begin with `tangy play`.")
    if word == ALL:
        return list(games)
    if word == LAST:
        return [games[-1]]
    if word.isascii() and word.isdecimal() and 1 <= int(word[:9]) <= len(games):
        return [games[int(word) - 1]]
    day = _day(word)
    if day is not None:
        return _of_day(games, day)
    found = [game for game in games if len(word) >= SHORTEST and game.id.startswith(word)]
    if len(found) > 1:
        numbers = " and ".join(str(game.number) for game in found)
        raise TangyError(plain(f"More than one game begins with {wanted!r}: {numbers}."))
    if not found:
        raise TangyError(plain(f"There is no game {wanted[:60]!r}: {_which(games, word)}"))
    return found


def find_game(games: Sequence[Game], wanted: str) -> Game:
    """Return the one game that a word selects.

    Raises:
        TangyError: no game matches, or more than one; the message lists the choices.
    """
    found = find_games(games, wanted)
    if len(found) > 1:
        raise TangyError(
            plain(
                f"{wanted!r} means {len(found)} games: choose one of them, "
                f"such as {found[-1].number} or {LAST}."
            )
        )
    return found[0]


def _which(games: Sequence[Game], word: str) -> str:
    if meant := did_you_mean(word, [LAST, ALL, *(game.id for game in games)]):
        return meant
    numbers = "there is only game 1" if len(games) == 1 else f"there are 1 to {len(games)}"
    day = games[-1].at.astimezone().date()
    return f"{numbers}; or say {LAST}, {ALL}, a day such as {day}, or the beginning of an id."


def _day(word: str) -> date | None:
    try:
        return date.fromisoformat(word) if "-" in word else None
    except ValueError:
        return None


def _of_day(games: Sequence[Game], day: date) -> list[Game]:
    found = [game for game in games if game.at.astimezone().date() == day]
    if not found:
        days = sorted({game.at.astimezone().date() for game in games})
        close = min(days, key=lambda other: abs(other - day))
        raise TangyError(f"No game was played on {day}; the nearest day with one is {close}.")
    return found


def uncleared(store: Store) -> Fault | None:
    """Return the fault that halted the robot at the end of the last game, if it is still open."""
    game, last = store.last(GameBeginning), store.last(FaultDiagnosed)
    if game is None or last is None or last.record.game != game.record.game:
        return None
    return next(
        (
            fault
            for fault in read_faults(store, game.record.game)
            if fault.status == OPEN
            and (fault.critical or any(move.kind == "halted" for move in fault.moves))
        ),
        None,
    )


def record_all_well(store: Store, fault: Fault, by: str) -> None:
    """Record that staff cleared the fault of the last game before the next, or before it goes on.

    The game's time stood still meanwhile.
    """
    seconds = max([fault.seconds, *(move.seconds for move in fault.moves)])
    store.append(
        FaultMove(game=fault.game, fault=fault.id, move=RecoveryEvent("cleared", seconds, by=by))
    )
