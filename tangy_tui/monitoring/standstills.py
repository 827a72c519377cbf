"""When a game stood still though staff had not paused it: halts, questions, and interruptions."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime

from tangy_profiles.game_records import MoveKind
from tangy_tui.monitoring.fault import Moved
from tangy_tui.monitoring.pauses import PauseTotal
from tangy_tui.monitoring.replay import Done, GameReplay, Moment, Noted

ANSWERS: tuple[MoveKind, ...] = ("taught", "accepted", "went on", "given up", "left open")
"""What ends a question to staff."""


def halts_in(replay: GameReplay) -> Iterator[tuple[Moment, Moment | None]]:
    """Yield when faults halted the robot, and when it went on; None: at no time in this game."""
    begun: Moment | None = None
    for moment in replay.moments:
        kind = moment.what.move.kind if isinstance(moment.what, Moved) else ""
        if kind == "halted":
            begun = begun or moment
        elif kind in ("cleared", "given up") and begun is not None:
            yield begun, moment
            begun = None
    if begun is not None:
        yield begun, None


def halts(replay: GameReplay) -> PauseTotal:
    """Return how often faults halted the robot in a game, and for how many s of its time."""
    lengths = [
        (replay.seconds if over is None else over.seconds) - begun.seconds
        for begun, over in halts_in(replay)
    ]
    return PauseTotal(len(lengths), sum(lengths))


def answer_waits(replay: GameReplay) -> PauseTotal:
    """Return how often a game waited for staff to say what to do, and for how many s.

    A wait ends as the next behaviour begins, or with the answer, whichever is first: the log has
    an answer that leads to a behaviour only after it, and a call may be due later.
    """
    lengths = list[float]()
    asked: Moment | None = None
    for moment in replay.moments:
        match moment.what:
            case Moved() as moved if moved.move.kind == "teacher asked":
                asked = moment
            case Moved() as moved if asked is not None and moved.move.kind in ANSWERS:
                since, until = (datetime.fromisoformat(one.at) for one in (asked, moment))
                lengths.append((until - since).total_seconds())
                asked = None
            case Done(begun=begun) if asked is not None:
                lengths.append(begun - asked.seconds)
                asked = None
            case _:
                pass
    if asked is not None:
        lengths.append(replay.seconds - asked.seconds)
    return PauseTotal(len(lengths), sum(max(0.0, one) for one in lengths))


def interruptions(replay: GameReplay) -> PauseTotal:
    """Return how often a game was interrupted and resumed, and for how many s in all.

    These are not part of the time of the game.
    """
    count, seconds = 0, 0.0
    before = replay.game.at
    for moment in replay.moments:
        at = datetime.fromisoformat(moment.at)
        if isinstance(moment.what, Noted) and moment.what.did == "resumed":
            count += 1
            seconds += max(0.0, (at - before).total_seconds())
        before = at
    return PauseTotal(count, seconds)
