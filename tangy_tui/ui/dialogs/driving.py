"""Driving the robot by keys: it moves while a key is held, and stops when it is released."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Static

from tangy_hw.device_protocols import Twist
from tangy_tui.text.control import DRIVE_HELP, DRIVE_TITLE
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.hand_driving import DRIVE_KEYS, TELL_SECONDS, HandDriving

if TYPE_CHECKING:
    from tangy_hw.robot_client.client import RobotLink


class DrivingDialog(HandDriving, Dialog[None]):
    """The arrow keys drive; a STOP or a fault prevents motion."""

    BINDINGS: ClassVar[list[BindingType]] = [
        *DRIVE_KEYS,
        Binding("escape,q", "close", "Drive no more", key_display="esc"),
    ]
    HELP = DRIVE_HELP

    def __init__(self, link: RobotLink) -> None:
        """Create the dialog for the robot of a link."""
        HandDriving.__init__(self, link)
        Dialog.__init__(self, None)

    def compose(self) -> ComposeResult:
        """Show the keys."""
        box = Vertical(Static(DRIVE_HELP, markup=False), Static("", id="hazard"), classes="box")
        box.border_title = DRIVE_TITLE
        box.border_subtitle = Content("↑ ↓ ← → drive   esc ends")
        yield box

    def on_mount(self) -> None:
        """Poll the robot's response."""
        self.set_interval(TELL_SECONDS, self.tell_held)

    def show_words(self, words: str) -> None:
        """Show the words below the keys."""
        self.query_one("#hazard", Static).update(Content(words))

    def action_close(self) -> None:
        """Stop driving, and close."""
        self.drive(Twist())
        self.answer(None)
