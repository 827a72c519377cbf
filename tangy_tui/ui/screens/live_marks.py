"""Draws the robot's estimates over the room: pose, path, particles and obstacles."""

from __future__ import annotations

from math import pi

from tangy_hw.robot_client.robot_state import RobotState
from tangy_profiles.room import Point
from tangy_tui.ui.widgets.room_view import Mark, RoomView

ARROWS = "▸▾◂▴"  # by quarter turns; people, whom it faces at pi / 2, are drawn below


def track(room: RoomView, state: RobotState) -> None:
    """Draw the robot's pose, and its estimates on the floor."""
    marks: list[Mark] = [(Point(x, y), "∴", "dim") for x, y in state.particles]
    marks += [(Point(x, y), "·", "robot") for x, y in state.path if state.going]
    marks += [(Point(x, y), "*", "warn") for x, y in state.obstacles]
    arrow = ARROWS[round(state.pose.heading / (pi / 2)) % 4]
    room.track(Point(state.pose.x, state.pose.y), arrow if state.going else "", marks)
