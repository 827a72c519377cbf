"""Lines of a script that wait in a game: for some s, or until an event."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from tangy_tui.console.inputs import WAIT

if TYPE_CHECKING:
    from tangy_tui.app.game_controller import GameController

LONGEST_WAIT = 600.0  # s that a script may wait
LOOK_SECONDS = 0.05


class ScriptWaits:
    """Waits in games of a controller."""

    def __init__(self, controller: GameController, look: Callable[[], None]) -> None:
        """Wait in games; `look` is called again and again meanwhile."""
        self._controller, self._look = controller, look

    def wait(self, line: str, playing: Callable[[], bool]) -> bool:
        """Return whether a line waits, after it has; the end of the game ends each wait."""
        if (found := WAIT.fullmatch(line.casefold())) is None:
            return False
        until = time.monotonic() + min(float(found[1] or LONGEST_WAIT), LONGEST_WAIT)
        calls = self._count_calls()
        while time.monotonic() < until and playing():
            self._look()
            if found[2] is not None and self._has_come(found[2], calls):
                break
            time.sleep(LOOK_SECONDS)
        return True

    def _has_come(self, what: str, calls: int) -> bool:
        if what == "called":
            return self._count_calls() > calls
        phases = {"asked": "asking", "halted": "halted", "paused": "paused"}
        return self._controller.phase == phases.get(what)

    def _count_calls(self) -> int:
        return len(self._controller.supervision.world.scene().called)
