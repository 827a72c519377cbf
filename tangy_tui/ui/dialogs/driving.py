"""Driving the robot by keys: it moves as long as a key is held, and stands when it is let go."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Static

from tangy_hw.device_protocols import Twist
from tangy_tui.text.control import DRIVE_HELP, DRIVE_TITLE, HELD, stands_words
from tangy_tui.ui.base import Dialog

if TYPE_CHECKING:
    from tangy_hw.robot_client.client import RobotLink

FORWARD, BACK, TURN = 0.3, 0.1, 0.6
"""m/s, m/s and rad/s: slower than it drives by itself, and slowest where it does not see."""
TELL_SECONDS = 0.1  # between two looks at what the robot does about it


class DrivingDialog(Dialog[None]):
    """The arrow keys drive; nothing moves that must not (a STOP, a fault)."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up", "drive(1, 0)", "Forward"),
        Binding("down", "drive(-1, 0)", "Back"),
        Binding("left", "drive(0, 1)", "Turn left"),
        Binding("right", "drive(0, -1)", "Turn right"),
        Binding("shift+up", "override(1, 0)", "Crawl forward"),
        Binding("shift+down", "override(-1, 0)", "Crawl back"),
        Binding("space", "drive(0, 0)", "Stand still"),
        Binding("escape,q", "close", "Drive no more", key_display="esc"),
    ]
    HELP = DRIVE_HELP

    def __init__(self, link: RobotLink) -> None:
        """Make the dialog for the robot at the other end of a link."""
        super().__init__(None)
        self._link = link

    def compose(self) -> ComposeResult:
        """Say what the keys do."""
        box = Vertical(Static(DRIVE_HELP, markup=False), Static("", id="hazard"), classes="box")
        box.border_title = DRIVE_TITLE
        box.border_subtitle = Content("↑ ↓ ← → drive   esc ends")
        yield box

    def on_mount(self) -> None:
        """Look all the time what the robot does."""
        self.set_interval(TELL_SECONDS, self._tell)

    def _tell(self) -> None:
        """Say why it does not drive as it is told; that stays there until the next key."""
        state = self._link.state
        why = self._link.silent or state.hazard
        words = stands_words(why) if why else HELD.get(state.held, "")
        if words:
            self._say(words)

    def _drive(self, twist: Twist, *, overrides: bool = False) -> None:
        self._link.tell("drive", forward=twist.forward, turn=twist.turn, overrides=overrides)

    def _say(self, words: str) -> None:
        self.query_one("#hazard", Static).update(Content(words))

    def action_drive(self, forward: int, turn: int) -> None:
        """Drive for a moment, or stand still."""
        self._drive(Twist(forward * (FORWARD if forward > 0 else BACK), turn * TURN))
        self._say("")
        self._tell()

    def action_override(self, forward: int, turn: int) -> None:
        """Crawl for a moment past what holds it up, as staff see that there is room."""
        self._drive(Twist(forward * BACK, turn * TURN), overrides=True)
        self._say("")
        self._tell()

    def action_close(self) -> None:
        """Stand still, and drive no more."""
        self._drive(Twist())
        self.answer(None)
