"""Motion limits of a base, for planning and driving by hand."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite, radians

from tangy_hw.device_protocols import STILL, Pose, Twist
from tangy_profiles.robot import Robot

PLANNED = 0.6  # share of the braking deceleration that planned drives use


@dataclass(frozen=True)
class MotionLimits:
    """Limits of a base in m/s, rad/s, m/s^2, rad/s^2, and m.

    `radius` is that of the robot, or of its outermost corner if it has `corners` (x, y in m,
    counter-clockwise). `gap` always stays free ahead. Within `wary` of people on any side, the
    speed limit is `gentle`; `unseen` is the limit in directions that the laser does not see. Within
    `close` of obstacles, `turn_close` limits turning.

    Near people the robot must be able to stop in time (see `people_guard`): `late` is the latency
    until it brakes in s, `stops` the deceleration, `spare` the distance left at the end. People are
    assumed to approach `approach` m/s faster than now, and new tracks `approach_new`; walkers may
    turn round and approach at `approach_turned`.
    """

    speed: float = 0.5
    turn: float = 1.0
    gain: float = 0.5
    brake: float = 0.6
    spin_up: float = 2.0
    radius: float = 0.25
    gap: float = 0.12
    wary: float = 1.2
    gentle: float = 0.25
    unseen: float = 0.1
    turn_close: float = 0.4
    close: float = 0.27
    late: float = 0.3
    stops: float = 1.0
    spare: float = 0.09
    approach: float = 0.35
    approach_new: float = 0.8
    approach_turned: float = 1.25
    corners: tuple[tuple[float, float], ...] = ()

    @classmethod
    def of(cls, robot: Robot) -> MotionLimits:
        """Return the limits of a robot from the body in its file."""
        body = robot.body
        return cls(
            speed=robot.speed,
            turn=body.turn,
            gain=body.acceleration,
            brake=PLANNED * body.braking,
            radius=body.radius,
            stops=body.braking,
            corners=body.corners,
        )

    def clamped(self, twist: Twist) -> Twist:
        """Scale a twist to the limits, on the same arc; a twist that is not finite becomes zero."""
        forward, turn = twist
        if not (isfinite(forward) and isfinite(turn)):
            return STILL
        over = max(abs(forward) / self.speed, abs(turn) / self.turn)
        if over <= 1.0:
            return twist
        clamped = Twist(
            max(-self.speed, min(self.speed, forward / over)),
            max(-self.turn, min(self.turn, turn / over)),
        )
        return clamped if isfinite(over) else STILL


def laser_of(robot: Robot) -> Pose:
    """Return the pose of a robot's scanner on it: x and y in m, heading in rad."""
    laser = robot.body.laser
    return Pose(laser.x, laser.y, radians(laser.yaw))
