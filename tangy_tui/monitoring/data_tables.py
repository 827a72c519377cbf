"""The log as tables for researchers: games, people, steps, responses, calls, faults, staff.

Every row has the robot, the game and the world. People are identified by id.
`docs/data-dictionary.md` describes each column.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from tangy_tui.monitoring.attention import calls_in
from tangy_tui.monitoring.fault import Diagnosed, Moved
from tangy_tui.monitoring.house import RobotLog
from tangy_tui.monitoring.played_for import wins_of
from tangy_tui.monitoring.replay import AnsweredRequest, Done, GameReplay, Noted, Unclear

Cell = str | int | float | bool | None
Row = Mapping[str, Cell]


@dataclass(frozen=True, slots=True)
class DataTable:
    """A table: its name, its columns, and the function that makes its rows from a game."""

    name: str
    columns: tuple[str, ...]
    rows: Callable[[RobotLog, GameReplay], Iterator[dict[str, Any]]]

    def of(self, logs: Iterable[RobotLog]) -> Iterator[Row]:
        """Yield the rows of all games of some logs."""
        for log in logs:
            for replay in log.replays:
                head = {"robot": log.robot, "game": replay.game.id, "world": replay.game.world}
                for row in self.rows(log, replay):
                    yield {column: _cell((head | row)[column]) for column in self.columns}


HEAD = ("robot", "game", "world")


def _cell(value: Any) -> Cell:
    """Format a cell: join lists, and round numbers to three decimals."""
    if isinstance(value, float):
        return round(value, 3)
    if isinstance(value, list | tuple):
        return " ".join(str(round(one, 3) if isinstance(one, float) else one) for one in value)
    return value  # type: ignore[no-any-return]


def _games(log: RobotLog, replay: GameReplay) -> Iterator[dict[str, Any]]:
    game = replay.game
    planned = None if replay.session is None else replay.session.ends
    yield {
        "number": game.number,
        "begun": game.at.isoformat(),
        "ended": game.ended and game.ended.isoformat(),
        "activity": game.activity,
        "policy": game.policy,
        "digest": game.digest,
        "people": len(game.people),
        "steps": game.steps,
        "seconds": replay.seconds if replay.timed else None,
        "stopped": game.stopped,
        "due": game.due,
        "rounds_left": game.rounds_left,
        "critical_faults": game.critical,
        "other_faults": game.other,
        "pauses": game.pauses[0],
        "paused_seconds": game.pauses[1],
        "planned_until": None if planned is None else planned.isoformat(),
        "staff_pauses": replay.staff_pauses.count,
        "staff_paused_seconds": replay.staff_pauses.seconds,
    }


def _people(log: RobotLog, replay: GameReplay) -> Iterator[dict[str, Any]]:
    answers = [answer for _, answer in replay.answers]
    for person, one in log.attention[replay.game.id].items():
        own = [answer for answer in answers if answer.person == person]
        yield {
            "person": person,
            "requests": one.requests,
            "waits": one.waits,
            "open_waits": one.open,
            "visits": one.visits,
            "seconds_with": one.seconds,
            "last_visit": one.last_visit,
            "helped": sum(one.helped.values()),
            "won": one.won,
            "won_cards": [win.card or 0 for _, win in wins_of(replay, person)],
            "won_calls": [win.call for _, win in wins_of(replay, person)],
            "asked": len(own),
            "complied": sum(answer.complied is True for answer in own),
            "late": sum(answer.complied is False and bool(answer.followed) for answer in own),
            "not_known": sum(answer.complied is None for answer in own),
        }


def _steps(log: RobotLog, replay: GameReplay) -> Iterator[dict[str, Any]]:
    for moment in replay.moments:
        if isinstance(done := moment.what, Done):
            yield {
                "step": done.number,
                "at": moment.at,
                "begun_s": done.begun if replay.timed else None,
                "over_s": done.over if replay.timed else None,
                "stage": done.state.situation.stage,
                "request": done.state.situation.request,
                "user_state": done.state.situation.user_state,
                "place": done.state.place,
                "asking": [user.id for user in done.state.users if user.request == "AR"],
                "behaviour": done.behaviour,
                "target": done.target,
                "strategy": done.strategy or None,
                "numbers": done.numbers,
                "completed": done.completed,
                "as_expected": done.right,
            }


def _responses(log: RobotLog, replay: GameReplay) -> Iterator[dict[str, Any]]:
    for moment in replay.moments:
        if isinstance(answer := moment.what, AnsweredRequest):
            yield {
                "step": moment.step,
                "at": moment.at,
                "seconds": moment.seconds,
                "person": answer.person,
                "strategy": answer.strategy,
                "complied": answer.complied,
                "followed": answer.followed,
                "took": answer.took,
            }


def _calls(log: RobotLog, replay: GameReplay) -> Iterator[dict[str, Any]]:
    activity = log.activity(replay.game)
    for order, call in enumerate(calls_in(replay), 1):
        yield {
            "order": order,
            "number": call.number,
            "label": None if activity is None else activity.deck.label(call.number),
            "seconds": call.seconds,
            "taken_back": call.taken_back,
        }


def _faults(log: RobotLog, replay: GameReplay) -> Iterator[dict[str, Any]]:
    for moment in replay.moments:
        if isinstance(moment.what, Diagnosed):
            fault = moment.what.fault
            ends = [move.seconds for move in fault.moves]
            yield {
                "fault": fault.id,
                "at": moment.at,
                "step": fault.step,
                "seconds": fault.seconds,
                "code": fault.code,
                "critical": fault.critical,
                "asks_only": fault.asks_only,
                "recovery": fault.recovery,
                "ladder": fault.ladder,
                "moves": len(fault.moves),
                "status": fault.status,
                "last_move_s": max(ends, default=None),
            }


def _staff(log: RobotLog, replay: GameReplay) -> Iterator[dict[str, Any]]:
    for moment in replay.moments:
        when = {"step": moment.step, "at": moment.at, "seconds": moment.seconds}
        match moment.what:
            case Noted(did, by, person, detail, calls=calls):
                yield {
                    **when, "kind": "note", "fault": None, "what": did, "person": person or None,
                    "detail": detail or None, "calls": calls or None, "by_person": bool(by),
                }  # fmt: skip
            case Unclear(person):
                yield {
                    **when, "kind": "unclear", "fault": None, "what": "answer not clear",
                    "person": person or None, "detail": None, "calls": None, "by_person": False,
                }  # fmt: skip
            case Moved(fault=fault, move=move) if move.by:
                yield {
                    **when, "kind": "move", "fault": fault.id, "what": move.kind, "person": None,
                    "detail": None, "calls": None, "by_person": True,
                }  # fmt: skip


TABLES = (
    DataTable(
        "games",
        (*HEAD, "number", "begun", "ended", "activity", "policy", "digest", "people", "steps",
         "seconds", "stopped", "due", "rounds_left", "critical_faults", "other_faults",
         "pauses", "paused_seconds", "planned_until", "staff_pauses", "staff_paused_seconds"),
        _games,
    ),
    DataTable(
        "people",
        (*HEAD, "person", "requests", "waits", "open_waits", "visits", "seconds_with", "last_visit",
         "helped", "won", "won_cards", "won_calls", "asked", "complied", "late", "not_known"),
        _people,
    ),
    DataTable(
        "steps",
        (*HEAD, "step", "at", "begun_s", "over_s", "stage", "request", "user_state", "place",
         "asking", "behaviour", "target", "strategy", "numbers", "completed", "as_expected"),
        _steps,
    ),
    DataTable(
        "responses",
        (*HEAD, "step", "at", "seconds", "person", "strategy", "complied", "followed", "took"),
        _responses,
    ),
    DataTable("calls", (*HEAD, "order", "number", "label", "seconds", "taken_back"), _calls),
    DataTable(
        "faults",
        (*HEAD, "fault", "at", "step", "seconds", "code", "critical", "asks_only", "recovery",
         "ladder", "moves", "status", "last_move_s"),
        _faults,
    ),
    DataTable("staff", (*HEAD, "step", "at", "seconds", "kind", "fault", "what", "person", "detail",
         "calls", "by_person"),
              _staff),
)  # fmt: skip
"""The tables; `docs/data-dictionary.md` describes their columns."""
