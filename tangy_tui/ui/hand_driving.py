"""The keys with which staff drive the robot, for screens and dialogs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual.binding import Binding, BindingType

from tangy_hw.device_protocols import Twist
from tangy_tui.text.control import HELD, stands_words

if TYPE_CHECKING:
    from tangy_hw.robot_client.client import RobotLink

FORWARD, BACK, TURN = 0.3, 0.1, 0.6
"""m/s, m/s and rad/s: slower than autonomous driving, slowest backwards, where the robot is blind.
"""
TELL_SECONDS = 0.1  # between two checks of the robot's response

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
    """The actions of `DRIVE_KEYS`. `show_words` shows why the robot does not obey."""

    def __init__(self, link: RobotLink) -> None:
        """Drive the robot of a link."""
        self.link = link

    def show_words(self, words: str) -> None:
        """Show why the robot does not drive as told; "" clears the words."""
        raise NotImplementedError

    def tell_held(self) -> None:
        """Show why the robot does not drive as told, until the next key."""
        why = self.link.silent or self.link.state.hazard
        words = stands_words(why) if why else HELD.get(self.link.state.held, "")
        if words:
            self.show_words(words)

    def drive(self, twist: Twist, *, overrides: bool = False) -> None:
        """Drive for a moment; the robot stops without further commands."""
        self.link.tell("drive", forward=twist.forward, turn=twist.turn, overrides=overrides)

    def action_drive(self, forward: int, turn: int) -> None:
        """Drive for a moment, or stop."""
        self._command(Twist(forward * (FORWARD if forward > 0 else BACK), turn * TURN))

    def action_override(self, forward: int, turn: int) -> None:
        """Crawl for a moment past an obstacle that staff see to be clear."""
        self._command(Twist(forward * BACK, turn * TURN), overrides=True)

    def _command(self, twist: Twist, *, overrides: bool = False) -> None:
        self.drive(twist, overrides=overrides)
        self.show_words("")
        self.tell_held()
