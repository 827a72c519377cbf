"""Keeps keys that were typed for a dialog until its line or its list can take them.

This is the second half of what `KeyReader` begins, and it takes both: the reader opens the dialog
before it reads the next key, since a key that opens nothing keeps none, and a dialog that is open
has the focus only later.
"""

from __future__ import annotations

from typing import Any

from textual import events
from textual.app import App
from textual.screen import Screen

LONGEST = 1.0
"""The longest time, in s, for which keys are kept: a dialog may have nothing to focus."""


class EarlyKeys:
    """Holds keys back, in their order, between the key that opens a dialog and its focus.

    Textual would send them to the dialog as a whole, which drops letters.
    """

    def __init__(self, app: App[None]) -> None:
        self._app = app
        self._dialog: Screen[Any] | None = None
        self._kept: list[events.Key | events.Paste] = []

    def wait_for(self, dialog: Screen[Any]) -> None:
        """Keep the next keys until a dialog has the focus, or for `LONGEST`."""
        if dialog.focused is None:
            self._dialog = dialog
            self._app.set_timer(LONGEST, lambda: self._give_up(dialog))

    def keep(self, event: events.Key | events.Paste) -> bool:
        """Keep a key if its dialog is not ready; return whether it was kept.

        Keys with ctrl, such as the one that stops the robot, are never kept.
        """
        if self._dialog is None or (isinstance(event, events.Key) and event.key[:5] == "ctrl+"):
            return False
        self._kept.append(event)
        self._app.call_later(self.give)
        return True

    async def give(self) -> None:
        """Handle the kept keys again if the dialog can take them, or is gone."""
        dialog = self._dialog
        if dialog is None or (dialog.focused is None and dialog in self._app.screen_stack):
            return
        await self._give()

    async def _give_up(self, dialog: Screen[Any]) -> None:
        if self._dialog is dialog:
            await self._give()

    async def _give(self) -> None:
        kept, self._dialog, self._kept = self._kept, None, []
        for event in kept:  # one of them may open another dialog
            await self._app.on_event(event)
