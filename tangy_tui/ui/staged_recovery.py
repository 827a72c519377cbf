"""A recovery in two parts: Tangy's move first, and its outcome once the move has taken its time."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from tangy_profiles.game_records import MoveKind
from tangy_tui.monitoring.fault import OPEN, Fault, Moved
from tangy_tui.monitoring.supervision import Event, Supervision

_TAKES_TIME = ("asked", "remedied")
"""The moves whose outcome takes time to become visible."""


class StagedRecovery:
    """Keeps the outcome of a recovery back until `done`."""

    def __init__(self, supervision: Supervision) -> None:
        self._supervision = supervision
        self._during: tuple[Fault, int] | None = None

    @property
    def fault(self) -> Fault | None:
        """The fault whose outcome is kept back, if nothing halts the robot."""
        if self._during is None or self._supervision.halted is not None:
            return None
        return self._during[0]

    def as_shown(self, fault: Fault) -> Fault:
        """Return a fault without the outcome of its last move, if that is to be shown later."""
        if self._during is None or self.fault is not fault:
            return fault
        return replace(fault, moves=fault.moves[: self._during[1]], status=OPEN)

    def parts(self, events: list[Event]) -> tuple[list[Event], list[Event]]:
        """Split off the outcome of a recovery, which is shown later than its start."""
        for n, event in enumerate(events):
            if isinstance(event, Moved) and event.move.kind in _TAKES_TIME and events[n + 1 :]:
                if self._supervision.halted is not None or self._supervision.question is not None:
                    break
                count = next(k for k, m in enumerate(event.fault.moves, 1) if m is event.move)
                self._during = (event.fault, count)
                return events[: n + 1], events[n + 1 :]
        return events, []

    def done(self) -> None:
        """Allow the outcome to be shown."""
        self._during = None


def takes_time(kinds: Collection[MoveKind]) -> bool:
    """Return whether the outcome of one of these moves takes time to become visible."""
    return any(kind in _TAKES_TIME for kind in kinds)
