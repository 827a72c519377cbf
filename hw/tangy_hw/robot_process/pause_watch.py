"""Pauses: the robot stands while data is late, and resumes slowly when it is fresh."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Mapping

from tangy_hw.device_protocols import Twist
from tangy_hw.navigation.limits import MotionLimits
from tangy_profiles.liveness import OFTEN, PAUSING, SELDOM, TOO_OFTEN, Liveness, Pausing

CONTROL = "control"
"""Name of the robot's own control, if it was delayed."""

LATE_LOOK = 0.25
"""Maximum time between two looks in s; control was delayed if it is exceeded."""

GIVES_UP_SECONDS = 0.5
"""Time after which a pause counts as a fault; the diagnosis aborts a drive before."""

SLOW_TURN = 0.4  # rad/s, limit while the robot resumes slowly


class PauseWatch:
    """Tracks what a robot waits for, and the lost time. Call `begin` when it is on."""

    def __init__(
        self,
        liveness: Liveness,
        limits: MotionLimits,
        label: Callable[[str], str] = str,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Prepare the watch.

        Args:
            liveness: limits on the age of data.
            limits: the normal motion limits.
            label: returns the label of a device.
            clock: returns real time in s.
        """
        self.count = 0
        """Number of finished pauses, except those that became faults."""
        self.seconds = 0.0
        """Total duration of the pauses."""
        self.longest = 0.0
        self._liveness = liveness
        self._slow = MotionLimits(
            max_speed=min(liveness.slow_speed, limits.max_speed), max_turn=SLOW_TURN
        )
        self._label = label
        self._clock = clock
        self._looked: float | None = None
        self._since = 0.0
        self._by = ""  # the device that was late first
        self._wanted: dict[str, int] = {}  # fresh readings still required of each device
        self._ages: dict[str, float] = {}
        self._lost: deque[tuple[float, float]] = deque()  # end and duration of recent pauses, in s
        self._slow_until = 0.0
        self._level: Pausing = SELDOM

    def begin(self) -> None:
        """Start to watch."""
        self._looked = self._clock()

    @property
    def why(self) -> str:
        """Why the robot waits for fresh data, "" if it does not."""
        return f"{self._label(self._by)} is late" if self._wanted else ""

    def look(self, ages: Mapping[str, float], late: Mapping[str, float]) -> None:
        """Update with the ages of the devices' data, in s, and of those that are late."""
        if self._looked is None:
            return
        now, before = self._clock(), self._looked
        if now <= before:
            return
        self._looked = now
        missed = list(late)
        if now - before > LATE_LOOK:
            missed.append(CONTROL)
        if missed and not self._wanted:
            self._by = missed[-1]
            self._since = now - max(0.0, now - before - LATE_LOOK)
        fresh = int(self._liveness.fresh_readings)
        for name in list(self._wanted):
            if name == CONTROL or ages.get(name, 0.0) <= self._ages.get(name, 0.0):
                self._wanted[name] -= 1
        self._wanted |= dict.fromkeys(missed, fresh)
        over = bool(self._wanted) and not any(left > 0 for left in self._wanted.values())
        self._wanted = {name: left for name, left in self._wanted.items() if left > 0}
        self._ages = dict(ages)
        if over:
            self._end(now)

    def _end(self, now: float) -> None:
        took = now - self._since
        self._slow_until = now + self._liveness.slow_seconds
        if took > self._liveness.fault_after + GIVES_UP_SECONDS:
            return  # that was a fault, which staff handled
        self.count += 1
        self.seconds += took
        self.longest = max(self.longest, took)
        self._lost.append((now, took))

    def patience(self, late: Mapping[str, float]) -> float:
        """Return for how many s a drive may wait for late data, 0 if none is late."""
        waits = bool(late) or bool(self._wanted)
        return self._liveness.fault_after + GIVES_UP_SECONDS if waits else 0.0

    def limited(self, command: Twist) -> Twist:
        """Return a command limited to a slow speed for a while after a pause."""
        slow = self._looked is not None and self._clock() < self._slow_until
        return self._slow.clamped(command) if slow else command

    @property
    def lost(self) -> float:
        """Share (ratio) of the recent window that was lost to pauses."""
        now, window = self._clock(), self._liveness.window_seconds
        while self._lost and self._lost[0][0] < now - window:
            self._lost.popleft()
        return min(1.0, sum(took for _, took in self._lost) / window)

    @property
    def level(self) -> Pausing:
        """Level of lost time; with hysteresis, a level ends at half of its threshold."""
        lost, kept = self.lost, self._level
        shares: dict[Pausing, float] = {
            TOO_OFTEN: self._liveness.fault_share,
            OFTEN: self._liveness.warn_share,
        }
        self._level = SELDOM
        for level, share in shares.items():
            was_so = PAUSING.index(kept) >= PAUSING.index(level)
            if lost > (share / 2 if was_so else share):
                self._level = level
                break
        return self._level
