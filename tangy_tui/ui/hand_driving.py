"""The keys by which staff drive the robot, for every screen and dialog that takes them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.binding import Binding, BindingType

from tangy_hw.device_protocols import Twist
from tangy_tui.text.control import HELD, stands_words

if TYPE_CHECKING:
    from tangy_hw.robot_client.client import RobotLink

FORWARD, BACK, TURN = 0.3, 0.1, 0.6
"""m/s, m/s and rad/s: slower than it drives by itself, and slowest where it does not see."""
TELL_SECONDS = 0.1  # between two looks at what the robot does about it

DRIVE_KEYS: list[BindingType] = [
    Binding("up", "drive(1, 0)", "Forward"),
    Binding("down", "drive(-1, 0)", "Back"),
    Binding("left", "drive(0, 1)", "Turn left"),
    Binding("right", "drive(0, -1)", "Turn right"),
    Binding("shift+up", "override(1, 0)", "Crawl forward"),
    Binding("shift+down", "override(-1, 0)", "Crawl back"),
    Binding("space", "drive(0, 0)", "Stand still"),
]


class HandDriving:
    """The actions of `DRIVE_KEYS`. A screen says by `show_words` what the robot does about it."""

    def __init__(self, link: RobotLink) -> None:
        """Take the link to the robot."""
        self.link = link

    def show_words(self, words: str) -> None:
        """Show why the robot does not drive as it is told; "" clears that."""
        raise NotImplementedError

    def tell_held(self) -> None:
        """Say why it does not drive as it is told; that stays there until the next key."""
        why = self.link.silent or self.link.state.hazard
        words = stands_words(why) if why else HELD.get(self.link.state.held, "")
        if words:
            self.show_words(words)

    def drive(self, twist: Twist, *, overrides: bool = False) -> None:
        """Drive for a moment; the robot stands when no further command comes."""
        self.link.tell("drive", forward=twist.forward, turn=twist.turn, overrides=overrides)

    def action_drive(self, forward: int, turn: int) -> None:
        """Drive for a moment, or stand still."""
        self._command(Twist(forward * (FORWARD if forward > 0 else BACK), turn * TURN))

    def action_override(self, forward: int, turn: int) -> None:
        """Crawl for a moment past what holds it up, as staff see that there is room."""
        self._command(Twist(forward * BACK, turn * TURN), overrides=True)

    def _command(self, twist: Twist, *, overrides: bool = False) -> None:
        self.drive(twist, overrides=overrides)
        self.show_words("")
        self.tell_held()
