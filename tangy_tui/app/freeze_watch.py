"""Detects that the program itself was frozen: stopped by a signal, or by a machine that slept.

A program on a busy machine still computes when it gets the chance; a frozen one does not. Both
clocks are the system's; the wall clock also counts while the machine sleeps.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING

from tangy_profiles.errors import TangyError
from tangy_tui.app.game_commands import Pause

if TYPE_CHECKING:
    from tangy_tui.app.game_controller import GameController

LOOK_SECONDS = 0.5
"""The interval between two checks."""
FROZEN_SECONDS = 5.0
"""Shorter gaps are not reported."""
WAKES_SECONDS = 4.0
"""The time after a freeze in which devices that waited for the program report again, in s."""
WORKED_SECONDS = 0.5
"""A process that used more CPU time than this within the gap was not frozen."""


def awake_time() -> float:
    """Return s on a clock that also counts while the machine sleeps, if there is one."""
    clock = getattr(time, "CLOCK_BOOTTIME", time.CLOCK_MONOTONIC)
    return time.clock_gettime(clock)


class FreezeWatch:
    """Reports once how long the program was frozen. Any thread may call `tick`."""

    def __init__(
        self,
        clock: Callable[[], float] = awake_time,
        worked: Callable[[], float] = time.process_time,
    ) -> None:
        """Start to watch.

        Args:
            clock: returns s, including time in which the machine slept.
            worked: returns the CPU time of the process in s.
        """
        self._clock, self._worked = clock, worked
        self._lock = threading.Lock()
        self._last = (clock(), worked())
        self._woke = float("-inf")

    @property
    def awake(self) -> bool:
        """Whether there was no freeze for a while."""
        return self._clock() - self._woke >= WAKES_SECONDS

    def tick(self) -> float:
        """Return for how many s the program was frozen since the last tick; 0.0 if it was not."""
        with self._lock:
            (before, worked), self._last = self._last, (self._clock(), self._worked())
            gap, computed = self._last[0] - before, self._last[1] - worked
            if gap < FROZEN_SECONDS or computed >= WORKED_SECONDS:
                return 0.0
            self._woke = self._last[0]
        return gap


class FreezeGuard:
    """Pauses a game after the program was frozen, and reports it. Any thread may call `look`."""

    def __init__(
        self,
        control: GameController,
        told: Callable[[float], object],
        watch: FreezeWatch | None = None,
    ) -> None:
        """Guard the games of a controller, which takes no step until everything is awake again.

        Args:
            control: runs the games.
            told: is called after the pause with the s for which the program was frozen.
            watch: detects a freeze.
        """
        self._control, self._told = control, told
        self._watch = watch or FreezeWatch()
        self._looking = threading.Lock()
        control.awake = control.supervision.watch.awake = self.awake

    def look(self) -> bool:
        """Return whether the program was just frozen; if so, pause the game.

        A thread that looks while another has found a freeze returns once the game is paused.
        """
        with self._looking:
            return self._look()

    def _look(self) -> bool:
        seconds = self._watch.tick()
        if not seconds or self._control.supervision.over:
            return False
        self._control.apply(Pause(unasked=True))
        self._control.supervision.stopped_by_staff()  # what it did meanwhile is not judged
        with suppress(TangyError):  # a full log must not prevent the report
            self._control.supervision.note("program frozen", "", detail=f"{seconds:.0f}")
        self._told(seconds)
        return True

    def awake(self) -> bool:
        """Return whether the program is not, and was not just, frozen."""
        return not self.look() and self._watch.awake

    def keep_looking(self) -> None:
        """Check in a background thread until the program ends."""
        threading.Thread(target=self._look_on, name="freeze", daemon=True).start()

    def _look_on(self) -> None:
        while True:
            time.sleep(LOOK_SECONDS)
            self.look()
