"""Motion limits of a base, for planning and driving by hand."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite, radians

from tangy_hw.device_protocols import STILL, Pose, Twist
from tangy_profiles.robot import Robot

PLANNED = 0.6  # share of the braking deceleration that planned drives use


@dataclass(frozen=True)
class MotionLimits:
    """Limits of a base in m/s, rad/s, m/s^2, rad/s^2, and m.

    `radius` is that of the robot, or of its outermost corner if it has `corners` (x, y in m,
    counter-clockwise). `clearance` always stays free ahead. Within `people_range` of people on any
    side, the speed limit is `people_speed`; `unseen_speed` is the limit in directions that the
    laser does not see. Within `close_range` of obstacles, `close_turn` limits turning.

    Near people the robot must be able to stop in time (see `people_guard`): `latency` is the time
    until it brakes in s, `full_braking` the deceleration, `margin` the distance left at the end.
    People are assumed to approach `approach` m/s faster than now, and new tracks `approach_new`;
    walkers may turn round and approach `turned_faster` m/s faster than they walked lately, at
    `approach_turned` at most. People who stand may set off at `set_off` m/s; with 0 they
    may not, so that planned drives reach a seat beside a person.
    """

    max_speed: float = 0.5
    max_turn: float = 1.0
    acceleration: float = 0.5
    planned_braking: float = 0.6
    turn_acceleration: float = 2.0
    radius: float = 0.25
    clearance: float = 0.12
    people_range: float = 1.2
    people_speed: float = 0.25
    unseen_speed: float = 0.1
    close_turn: float = 0.4
    close_range: float = 0.27
    latency: float = 0.3
    full_braking: float = 1.0
    margin: float = 0.09
    approach: float = 0.35
    approach_new: float = 0.8
    turned_faster: float = 0.6
    approach_turned: float = 1.25
    set_off: float = 0.0
    corners: tuple[tuple[float, float], ...] = ()

    @classmethod
    def of(cls, robot: Robot) -> MotionLimits:
        """Return the limits of a robot from the body in its file."""
        body = robot.body
        return cls(
            max_speed=robot.speed,
            max_turn=body.turn,
            acceleration=body.acceleration,
            planned_braking=PLANNED * body.braking,
            radius=body.radius,
            full_braking=body.braking,
            corners=body.corners,
        )

    def clamped(self, twist: Twist) -> Twist:
        """Scale a twist to the limits, on the same arc; a twist that is not finite becomes zero."""
        forward, turn = twist
        if not (isfinite(forward) and isfinite(turn)):
            return STILL
        over = max(abs(forward) / self.max_speed, abs(turn) / self.max_turn)
        if over <= 1.0:
            return twist
        clamped = Twist(
            max(-self.max_speed, min(self.max_speed, forward / over)),
            max(-self.max_turn, min(self.max_turn, turn / over)),
        )
        return clamped if isfinite(over) else STILL

    def reached(self, told: Twist, measured: Twist) -> Twist:
        """Return the twist that a base is about to reach, as far as its latency explains.

        Commands and odometry lag: the measured speed is older than the last command.
        """
        least = measured.forward - self.full_braking * self.latency
        most = measured.forward + self.acceleration * self.latency
        turn = min(abs(told.turn), abs(measured.turn) + self.turn_acceleration * self.latency)
        return Twist(max(least, min(told.forward, most)), max(abs(measured.turn), turn))


def laser_of(robot: Robot) -> Pose:
    """Return the pose of a robot's scanner on it: x and y in m, heading in rad."""
    laser = robot.body.laser
    return Pose(laser.x, laser.y, radians(laser.yaw))


def reach_of(robot: Robot) -> float:
    """Return the range in m beyond which a robot's scanner is not believed; inf: its own."""
    return robot.body.laser.reach or inf
