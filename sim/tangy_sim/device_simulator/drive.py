"""The bench's base: a differential drive with odometry, which can get stuck, slip and bump."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin
from typing import TYPE_CHECKING

from tangy_sim.device_simulator.floor import Floor, FloorPose

if TYPE_CHECKING:
    import numpy as np

SILENCE = 0.5  # s after the last command until the base stops by itself
RADIUS = 0.25  # m, of the robot's footprint
TRACK = 0.4  # m between the wheels
FASTEST, FASTEST_TURN = 1.0, 2.0  # m/s, rad/s
SPEEDS_UP, BRAKES, TURNS_UP = 0.8, 1.6, 4.0  # m/s^2, m/s^2, rad/s^2
STEP = 0.025  # s, maximum step of the integration


@dataclass(frozen=True)
class Odometer:
    """Relative errors of each wheel's odometry: a constant one, and a random one."""

    stays: float = 0.002
    varies: float = 0.03


EXACT = Odometer(0.0, 0.0)


class SimulatedWheels:
    """A base with two driven wheels.

    `pose` is the true pose in the room, `odometry` the pose counted since switching on, `forward`
    (m/s) and `turn` (rad/s) the current speeds.
    """

    def __init__(
        self,
        floor: Floor,
        pose: FloorPose,
        random: np.random.Generator,
        odometer: Odometer = Odometer(),
    ) -> None:
        self.floor = floor
        self.pose = pose
        self.odometry = FloorPose(0.0, 0.0, 0.0)
        self.forward = self.turn = 0.0
        self.bumped = False
        """Whether it is blocked by an obstacle that it was commanded to drive into."""
        self._random = random
        self._odometer = odometer
        self._wrong = random.normal(0.0, 1.0, 2) * odometer.stays
        self._wanted = (0.0, 0.0)
        self._told: float | None = None

    def drive(self, forward: float, turn: float, now: float) -> None:
        """Set the command (m/s, rad/s), which is valid for half a second; `now` in s."""
        self._wanted = (
            max(-FASTEST, min(FASTEST, forward)),
            max(-FASTEST_TURN, min(FASTEST_TURN, turn)),
        )
        self._told = now

    @property
    def commanded(self) -> tuple[float, float]:
        """Valid command in m/s and rad/s; zeros if there is none."""
        return self._wanted if self._told is not None else (0.0, 0.0)

    def halt(self) -> None:
        """Stop at once, as with the power cut."""
        self.forward = self.turn = 0.0
        self._told = None

    def step(self, now: float, seconds: float, *, stuck: bool = False, grip: float = 1.0) -> None:
        """Drive until `now`, `seconds` after the last step.

        Args:
            now: time of the world, in s.
            seconds: time since the last step, in s.
            stuck: whether the wheels are blocked.
            grip: ratio of the robot's movement to that of the wheels, 0 to 1.
        """
        if self._told is None and not self.forward and not self.turn:
            return
        count = max(1, round(seconds / STEP))
        part = seconds / count
        for number in range(count):
            self._step(now - seconds + (number + 1) * part, part, stuck, grip)

    def _step(self, now: float, seconds: float, stuck: bool, grip: float) -> None:
        if self._told is not None and now - self._told > SILENCE + 1e-9:
            self._told = None
        forward, turn = self.commanded
        brakes = abs(forward) < abs(self.forward) or forward * self.forward < 0
        self.forward = _towards(self.forward, forward, (BRAKES if brakes else SPEEDS_UP) * seconds)
        self.turn = _towards(self.turn, turn, TURNS_UP * seconds)
        if stuck:
            self.forward = self.turn = 0.0
        if not self.forward and not self.turn:
            return
        gone, turned = self.forward * seconds, self.turn * seconds
        there = moved(self.pose, gone * grip, turned * grip)
        self.bumped = bool(gone) and not self.floor.clear(there.x, there.y, RADIUS)
        if self.bumped and self._leads_out(there):
            self.bumped = False
        if self.bumped:
            self.forward = gone = 0.0
            there = moved(self.pose, 0.0, turned * grip)
        self.pose = there
        if self._odometer != EXACT:
            noise = self._wrong + self._random.normal(0.0, self._odometer.varies, 2)
            left = (gone - turned * TRACK / 2) * (1.0 + float(noise[0]))
            right = (gone + turned * TRACK / 2) * (1.0 + float(noise[1]))
            gone, turned = (left + right) / 2, (right - left) / TRACK
        self.odometry = moved(self.odometry, gone, turned)

    def _leads_out(self, there: FloorPose) -> bool:
        """Return whether a move leads away from an obstacle that the robot touches."""
        if self.floor.clear(self.pose.x, self.pose.y, RADIUS):
            return False
        ahead = moved(there, 0.0, 0.0)
        dx, dy = there.x - self.pose.x, there.y - self.pose.y
        further = FloorPose(ahead.x + 8 * dx, ahead.y + 8 * dy, ahead.heading)
        return self.floor.clear(further.x, further.y, RADIUS - 0.05)


def moved(pose: FloorPose, gone: float, turned: float) -> FloorPose:
    """Return a pose after a short arc with a length in m and a turn in rad."""
    middle = pose.heading + turned / 2
    heading = (pose.heading + turned + pi) % (2 * pi) - pi
    return FloorPose(pose.x + gone * cos(middle), pose.y + gone * sin(middle), heading)


def _towards(value: float, goal: float, most: float) -> float:
    return value + max(-most, min(most, goal - value))
