"""Freezes of the program, told to staff at the lines, who are asked whether to go on."""

from __future__ import annotations

import threading
from collections.abc import Callable
from queue import SimpleQueue

from tangy_tui.app.freeze_watch import FreezeGuard, FreezeWatch
from tangy_tui.app.game_commands import GoOn
from tangy_tui.app.game_controller import GameController
from tangy_tui.console.confirming import ConfirmingStaff
from tangy_tui.text.freezes import PAUSED, stood_words


class FreezeLines:
    """Guards the games of a controller; call `ask` in the thread that takes the lines."""

    def __init__(
        self,
        controller: GameController,
        sure: ConfirmingStaff,
        write: Callable[[str], None],
        watch: FreezeWatch | None = None,
    ) -> None:
        """Ask with `sure`; `watch` detects a freeze."""
        self._controller, self._sure, self._write = controller, sure, write
        self._asks = threading.Event()
        self.guard = FreezeGuard(controller, self._stood_still, watch)
        """Pauses the game after a freeze."""

    def _stood_still(self, seconds: float) -> None:
        self._write(stood_words(seconds))
        self._asks.set()

    def ask(self, typed: SimpleQueue[str | None] | None) -> None:
        """After a freeze, ask whether to go on, unless something else is to be done first.

        Args:
            typed: the lines read so far, of which answers are dropped; None: unread input.
        """
        if not self._asks.is_set():
            return
        self._asks.clear()
        can = not self._sure.open and self._controller.phase == "paused"
        if not (can and self._sure.ask(GoOn(), typed)):
            self._write(PAUSED)
