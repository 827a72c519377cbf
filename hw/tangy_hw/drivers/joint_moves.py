"""Waits for joint movements until every joint has arrived."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from tangy_hw.device_protocols import DeviceError
from tangy_hw.drivers.completion import Completion
from tangy_hw.drivers.latest_value import awaited
from tangy_profiles.reading import plain

TOLERANCE = 3.0  # degrees of position error within which a joint has arrived
GRACE_SECONDS = 2.0  # after 1.5 times the planned duration, until a movement counts as late


class JointMoves:
    """Movements of one device in progress; angles in rad, by joint name."""

    def __init__(self, name: str, tolerance: float, clock: Callable[[], float]) -> None:
        """Start without movements.

        Args:
            name: name of the device, for error messages.
            tolerance: position error in rad within which a joint has arrived.
            clock: returns the time in s.
        """
        self.positions: dict[str, float] = {}
        """Latest known position of each joint."""
        self._name, self._tolerance, self._clock = name, tolerance, clock
        self._moves: set[_Move] = set()

    async def arrive(
        self, goals: Mapping[str, float], seconds: float, goes_on: Callable[[], bool]
    ) -> None:
        """Wait until joints that were just commanded have arrived.

        A newer movement that shares a joint ends this one.

        Args:
            goals: goal positions in rad, by joint.
            seconds: planned duration of the movement.
            goes_on: returns whether to go on waiting.

        Raises:
            DeviceError: a joint did not arrive in time, or the movement was ended.
        """
        move = _Move(goals)
        for other in self._moves:
            if other.goals.keys() & goals.keys():
                other.end(f"{self._name} was told otherwise meanwhile.")
        self._moves.add(move)
        until = self._clock() + 1.5 * max(seconds, 0.0) + GRACE_SECONDS
        try:
            there = await awaited(move.over, until, self._clock, goes_on)
        finally:
            self._moves.discard(move)
        if not there:
            far = [joint for joint in goals if not self._is_there(joint, goals[joint])]
            unheard = [joint for joint in far if joint not in move.heard]
            what = "says nothing" if unheard else "is not there in time"
            raise DeviceError(plain(f"{self._name}: {(unheard or far or ['it'])[0]} {what}."))
        move.over.result()

    def hear(self, positions: Mapping[str, float]) -> None:
        """Update with new positions in rad."""
        self.positions.update(positions)
        for move in self._moves:
            move.heard |= positions.keys() & move.goals.keys()
            if move.heard == move.goals.keys() and all(
                self._is_there(joint, goal) for joint, goal in move.goals.items()
            ):
                move.end()

    def end(self, why: str) -> None:
        """End all movements with an error."""
        for move in self._moves:
            move.end(why)

    def _is_there(self, joint: str, goal: float) -> bool:
        here = self.positions.get(joint)
        return here is not None and abs(here - goal) <= self._tolerance


class _Move(Completion):
    """A movement; every joint must report since its start."""

    def __init__(self, goals: Mapping[str, float]) -> None:
        super().__init__()
        self.goals = goals
        self.heard: set[str] = set()
