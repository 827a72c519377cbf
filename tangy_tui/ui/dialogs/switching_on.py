"""The dialog while a robot starts, which takes seconds and can be cancelled."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.content import Content
from textual.widgets import Static

from tangy_tui.text.live_games import CALLED_OFF, STARTING
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.messages import Stop

LOOK_SECONDS = 0.2
"""Between two looks at what is being started."""


class SwitchingOnDialog(Dialog[None]):
    """Stays until the robot is on, or off again. Esc, STOP, and leaving the program call it off."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "call_off", "Leave it off")]
    HELP = "Wait until the robot is switched on, or press esc to leave it off."

    def __init__(
        self,
        title: str,
        call_off: Callable[[], None],
        parts: Callable[[], Sequence[str]] = tuple,
    ) -> None:
        """Make it.

        Args:
            title: which robot it is.
            call_off: is called when somebody wants it left off, perhaps more than once.
            parts: returns, in lines, what was started so far, and what is being started.
        """
        super().__init__(None)
        self._title = clean(title)
        self._call_off = call_off
        self._parts = parts
        self._told: Sequence[str] = ()
        self.called_off = False
        """Whether somebody wants it left off."""
        self._shown = asyncio.Event()

    def compose(self) -> ComposeResult:
        """Lay out what goes on, and the key."""
        yield Static(self._text(), id="switching-on", classes="box")

    def on_mount(self) -> None:
        """Take note when this can be read."""
        self.call_after_refresh(self._shown.set)
        self.set_interval(LOOK_SECONDS, self._look)

    def _look(self) -> None:
        """Show what is being started, if that is another part now."""
        if (parts := tuple(self._parts())) != self._told:
            self._told = parts
            self.query_one("#switching-on", Static).update(self._text())

    async def shown(self) -> None:
        """Wait until this can be read, and keys are heard."""
        await self._shown.wait()

    def over(self) -> None:
        """Go: the robot is on, or off again."""
        if self not in self.app.screen_stack:
            return
        while self.app.screen is not self:  # somebody may read the help
            self.app.pop_screen()
        self.answer(None)

    def action_call_off(self) -> None:
        """Leave the robot off."""
        self.called_off = True
        self._call_off()
        for text in self.query(Static):
            text.update(self._text())

    def on_stop(self, message: Stop) -> None:
        """Take STOP for it."""
        self.action_call_off()

    def _text(self) -> Content:
        head = (f"Switching {self._title} on ...", "bold")
        if self.called_off:
            return Content.assemble(head, "\n\n", CALLED_OFF)
        parts = [f"\n{clean(line)}" for line in self._told]
        return Content.assemble(
            head, *parts, "\n\n", STARTING, "\n\n", ("ESC", "$success bold"), "  leave it off"
        )
