"""Notices that the program itself stood still: it was stopped by a signal, or the machine slept.

A program that only waits for a busy machine is computing whenever it may; one that stands still
computes nothing. Both clocks are the system's: one counts while the machine sleeps, too.
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
"""Between two looks."""
FROZEN_SECONDS = 5.0
"""A gap from here on is told."""
WORKED_SECONDS = 0.5
"""Who has computed for longer within the gap was not still."""


def awake_time() -> float:
    """Return s on a clock that goes on while the machine sleeps, where there is one."""
    clock = getattr(time, "CLOCK_BOOTTIME", time.CLOCK_MONOTONIC)
    return time.clock_gettime(clock)


class FreezeWatch:
    """Says once for how long the program stood still. Any thread may `tick`."""

    def __init__(
        self,
        clock: Callable[[], float] = awake_time,
        worked: Callable[[], float] = time.process_time,
    ) -> None:
        """Begin to watch.

        Args:
            clock: s, also of those in which the machine sleeps.
            worked: s for which the program has computed.
        """
        self._clock, self._worked = clock, worked
        self._lock = threading.Lock()
        self._last = (clock(), worked())

    def tick(self) -> float:
        """Return for how many s the program stood still since the last tick; 0.0: it did not."""
        with self._lock:
            (before, worked), self._last = self._last, (self._clock(), self._worked())
        gap, computed = self._last[0] - before, self._last[1] - worked
        return gap if gap >= FROZEN_SECONDS and computed < WORKED_SECONDS else 0.0


class FreezeGuard:
    """Pauses a game after the program stood still, and says so. Any thread may `look`."""

    def __init__(
        self,
        control: GameController,
        told: Callable[[float], object],
        watch: FreezeWatch | None = None,
    ) -> None:
        """Guard the games of a controller.

        Args:
            control: of the games.
            told: is told for how many s the program stood still, after the game was paused.
            watch: notices it.
        """
        self._control, self._told = control, told
        self._watch = watch or FreezeWatch()

    def look(self) -> bool:
        """Look whether the program has just stood still; the game is paused then."""
        seconds = self._watch.tick()
        if not seconds or self._control.supervision.over:
            return False
        self._control.apply(Pause())
        with suppress(TangyError):  # who stood still is not held up by a log that is full
            self._control.supervision.note(f"the program stood still for {seconds:.0f} s", "")
        self._told(seconds)
        return True

    def keep_looking(self) -> None:
        """Look by a thread of its own from now on, until the program ends."""
        threading.Thread(target=self._look_on, name="freeze", daemon=True).start()

    def _look_on(self) -> None:
        while True:
            time.sleep(LOOK_SECONDS)
            self.look()
