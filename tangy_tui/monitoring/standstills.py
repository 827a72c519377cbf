"""When a game stood still though staff had not paused it: halts, and interruptions."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import datetime

from tangy_tui.monitoring.fault import Moved
from tangy_tui.monitoring.pauses import PauseTotal
from tangy_tui.monitoring.replay import GameReplay, Moment, Noted


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
