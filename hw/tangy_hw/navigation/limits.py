"""Motion limits of a base, for planning and driving by hand."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite, radians

from tangy_hw.device_protocols import STILL, Pose, Twist
from tangy_profiles.robot import Robot

PLANNED = 0.6  # of how hard a base brakes, by which drives are planned


@dataclass(frozen=True)
class MotionLimits:
    """How a base may drive: m/s, rad/s, m/s^2, rad/s^2, and metres.

    `radius` is the robot's own, or that of its outermost corner where it has `corners` (x, y in m,
    once round it to the left); `gap` is what it always keeps free ahead. Within `wary` of people,
    on any side, it drives at no more than `gentle`. `unseen` is how fast it drives where its laser
    does not look; within `close` of anything it turns no faster than `turn_close`.

    Past people it must be able to stop before they meet (see `people_guard`): `late` is how many s
    pass until it brakes, `stops` how hard it then does, `spare` how many metres are left at the
    end. People are taken to come `approach` m/s faster than they do now, those who have just
    appeared `approach_new`; those who walk may turn, and come at `approach_turned`.
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
        """Return how a robot may drive, as its file describes its body."""
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
        """Return a twist on the same arc that is no faster than it may be; no number is none.

        Whatever is not a finite number stands still.
        """
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
    """Return where a robot's scanner sits on it: x and y in m, its heading in rad."""
    laser = robot.body.laser
    return Pose(laser.x, laser.y, radians(laser.yaw))
