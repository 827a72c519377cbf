"""Driving the robot by keys: it moves as long as a key is held, and stands when it is let go."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Static

from tangy_hw.devices import Twist
from tangy_tui.ui.base import Dialog

FORWARD, TURN = 0.3, 0.6  # m/s and rad/s: slower than it drives by itself

TEXT = (
    "↑ and ↓ drive, ← and → turn, as long as a key is held. While you drive, Tangy stops for "
    "nobody and nothing in its way: look where it goes. Space stands still; esc ends."
)


class DrivingDialog(Dialog[None]):
    """The arrow keys drive; nothing moves that must not (a STOP, a fault)."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up", "drive(1, 0)", "Forward"),
        Binding("down", "drive(-1, 0)", "Back"),
        Binding("left", "drive(0, 1)", "Turn left"),
        Binding("right", "drive(0, -1)", "Turn right"),
        Binding("space", "drive(0, 0)", "Stand still"),
        Binding("escape,q", "close", "Drive no more", key_display="esc"),
    ]
    HELP = TEXT

    def __init__(self, drive: Callable[[Twist], None], hazard: Callable[[], str]) -> None:
        """Make the dialog.

        Args:
            drive: tells the robot how to drive, for a moment.
            hazard: says why it stands still, "" if it may drive.
        """
        super().__init__(None)
        self._drive = drive
        self._hazard = hazard

    def compose(self) -> ComposeResult:
        """Say what the keys do."""
        box = Vertical(Static(TEXT, markup=False), Static("", id="hazard"), classes="box")
        box.border_title = "Drive by keys"
        box.border_subtitle = Content("↑ ↓ ← → drive   esc ends")
        yield box

    def action_drive(self, forward: int, turn: int) -> None:
        """Drive for a moment, or stand still."""
        self._drive(Twist(forward * FORWARD, turn * TURN))
        why = self._hazard()
        self.query_one("#hazard", Static).update(Content(f"It stands still: {why}" if why else ""))

    def action_close(self) -> None:
        """Stand still, and drive no more."""
        self._drive(Twist())
        self.answer(None)
