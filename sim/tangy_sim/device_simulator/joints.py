"""The bench's joints, which move towards their goals with limited speed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import degrees, radians

from tangy_profiles.robot import Robot

FASTEST = 2.5  # rad/s


class Joints:
    """Joints of a robot by name, "limb/joint", in rad; they start at zero."""

    def __init__(self, robot: Robot) -> None:
        self.names = tuple(
            f"{limb.name}/{joint}" for limb in robot.limbs.values() for joint in limb.joints
        )
        self.positions = dict.fromkeys(self.names, 0.0)
        self.speeds = dict.fromkeys(self.names, 0.0)
        self._limits: Mapping[str, tuple[float, float]] = {
            f"{limb.name}/{joint}": (radians(low), radians(high))
            for limb in robot.limbs.values()
            for joint, low, high in zip(limb.joints, limb.low, limb.high, strict=True)
        }
        self._goals: dict[str, tuple[float, float]] = {}

    def move(self, names: Sequence[str], positions: Sequence[float], seconds: float) -> None:
        """Set goals in rad, to be reached within `seconds` s; unknown names are ignored.

        Goals are clipped to the joint's limits.
        """
        for name, goal in zip(names, positions, strict=False):
            if name in self.positions:
                low, high = self._limits[name]
                goal = max(low, min(high, float(goal)))
                far = abs(goal - self.positions[name])
                speed = far / seconds if seconds > 0 else FASTEST
                self._goals[name] = (goal, max(1e-6, min(FASTEST, speed)))

    def hold(self, names: Sequence[str]) -> None:
        """Drop the goals of joints, which stay where they are."""
        for name in names:
            self._goals.pop(name, None)
            if name in self.speeds:
                self.speeds[name] = 0.0

    def step(self, seconds: float, broken: Iterable[str] = ()) -> None:
        """Move for a time in s; joints of `broken` limbs stay where they are."""
        out = tuple(f"{limb}/" for limb in broken)
        for name, (goal, speed) in list(self._goals.items()):
            if out and name.startswith(out):
                self.speeds[name] = 0.0
                continue
            here = self.positions[name]
            most = speed * seconds
            if abs(goal - here) <= most:
                self.positions[name] = goal
                self.speeds[name] = 0.0
                del self._goals[name]
            else:
                self.positions[name] = here + (most if goal > here else -most)
                self.speeds[name] = speed if goal > here else -speed

    def angle(self, name: str) -> float:
        """Return the position of a joint in degrees; 0 if there is no such joint."""
        return degrees(self.positions.get(name, 0.0))
