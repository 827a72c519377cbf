"""The dialog while a robot starts, which takes seconds and can be cancelled."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.content import Content
from textual.widgets import Static

from tangy_tui.text.live_games import (
    CALLED_OFF,
    KEEPS_GAME,
    LEAVES_OFF,
    STARTING,
    starting_again_words,
)
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.messages import Stop

LOOK_SECONDS = 0.2
"""The interval of checks for the part that is being started, in s."""


class SwitchingOnDialog(Dialog[None]):
    """Stays until the robot is on, or off again. Esc, STOP and the end of the program cancel it."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "call_off", "Leave it off")]
    DEFAULT_CSS = """
    SwitchingOnDialog.-joins { background: $background; }
    """  # the home screen below it is not where the game is
    HELP = "Wait until the robot is switched on, or press esc to leave it off."

    def __init__(
        self,
        title: str,
        call_off: Callable[[], None],
        parts: Callable[[], Sequence[str]] = tuple,
        *,
        joins: Sequence[str] = (),
        seconds: float = 0.0,
    ) -> None:
        """Create the dialog.

        Args:
            title: the robot's title.
            call_off: cancels the start; may be called more than once.
            parts: returns lines with the parts that are started, and the one in progress.
            joins: the names of new people, with whom a game goes on then; none for a new game.
            seconds: about how long that takes; 0: unknown.
        """
        super().__init__(None)
        self.set_class(bool(joins), "-joins")
        self._title = clean(title)
        self._call_off = call_off
        self._parts = parts
        self._then = starting_again_words([*map(clean, joins)], seconds) if joins else STARTING
        self._leaves = KEEPS_GAME if joins else LEAVES_OFF
        self._told: Sequence[str] = ()
        self.called_off = False
        """Whether the start was cancelled."""
        self.stopped = False
        """Whether a STOP cancelled it."""
        self._shown = asyncio.Event()

    def compose(self) -> ComposeResult:
        """Lay out the progress and the key."""
        yield Static(self._text(), id="switching-on", classes="box")

    def on_mount(self) -> None:
        """Note when the dialog is visible."""
        self.call_after_refresh(self._shown.set)
        self.set_interval(LOOK_SECONDS, self._look)

    def _look(self) -> None:
        """Show the part in progress, if it changed."""
        if (parts := tuple(self._parts())) != self._told:
            self._told = parts
            self.query_one("#switching-on", Static).update(self._text())

    async def shown(self) -> None:
        """Wait until the dialog is visible and takes keys."""
        await self._shown.wait()

    def over(self) -> None:
        """Close: the robot is on, or off again."""
        if self not in self.app.screen_stack:
            return
        while self.app.screen is not self:  # help may be open
            self.app.pop_screen()
        self.answer(None)

    def action_call_off(self) -> None:
        """Cancel the start."""
        self.called_off = True
        self._call_off()
        for text in self.query(Static):
            text.update(self._text())

    def on_stop(self, message: Stop) -> None:
        """Cancel the start on STOP."""
        self.stopped = True
        self.action_call_off()

    def _text(self) -> Content:
        head = (f"Switching {self._title} on ...", "bold")
        if self.called_off:
            return Content.assemble(head, "\n\n", CALLED_OFF)
        parts = [f"\n{clean(line)}" for line in self._told]
        return Content.assemble(
            head, *parts, "\n\n", self._then, "\n\n", ("ESC", "$success bold"), f"  {self._leaves}"
        )
