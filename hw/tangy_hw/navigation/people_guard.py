"""Limits commands near people: speed and separation monitoring, as in ISO 13855.

The robot keeps the distance that it needs to stop before it meets a person. It assumes that people
keep their velocity and approach a little faster, and that walkers may turn round and approach
faster than they walked lately. When it is driven by hand, it also assumes that people who stand may
set off at a walking pace. The assumed speeds are settings (`MotionLimits`), below the 1.6 m/s of
the standard, with which a robot could never drive up to a seat. Only motion that brings the robot
nearer to a person than stopping does is limited: the robot may drive away from a person who
approaches it. From a walker who would reach it before it stands, as they walk or if they turn
round, it drives away slowly, and only if they stay behind it: somebody who comes from the side
meets it before it has passed. It does not drive away from a body that has just come into view: its
velocity is not known yet, and from where the scanner does not see, a walker is beside the robot
within the time that it needs to stand.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, radians
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tangy_hw.device_protocols import STILL, Twist
from tangy_hw.navigation.leg_detection import TORSO
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.people_tracker import Track
from tangy_hw.navigation.poses import Floats, lengths

SHARES = (1.0, 0.85, 0.7, 0.55, 0.4, 0.3, 0.2, 0.12)  # shares of a command that are tried
REACH = 3.0  # metres beyond which people are out of reach while the robot stops
STEP = 0.1  # seconds between the checked moments
WALKS = 0.25  # m/s of a walker
NEARER = 0.005  # metres by which driving may end nearer than stopping does, to standing people
KEPT = 0.22  # metres beyond the body of a standing person within which it may not end nearer
KEPT_END = 0.2  # the same beyond a return without a track, which is on the body
FURTHER = 0.01  # metres by which driving must end further away than stopping does, from walkers
PAIR = 0.01  # m of the radius by which a track of two legs is known; one leg tells less exactly
SPOT = 0.02  # m/s below which a robot turns on the spot
FRESH = 0.5  # seconds for which a new track is assumed to approach fast
BEHIND = cos(radians(110.0))  # of the bearing from which on a walker is behind the robot
END = 0.15  # metres of a body beyond a return without a track


class NearbyPeople(NamedTuple):
    """People around, in the robot's frame: tracks, and returns (n, 2) that are not on the map."""

    tracks: Sequence[Track]
    ends: Floats


def limit_near_people(twist: Twist, around: NearbyPeople, limits: MotionLimits) -> Twist:
    """Return the part of a twist that is safe near people, on the same arc: all, less, or none.

    A round robot may always turn on the spot; a robot with corners only if they stay clear of
    people.
    """
    twist = _slower_before_followers(twist, around, limits)
    spins = abs(twist.forward) < SPOT
    if spins and (not limits.corners or twist.turn == 0.0):
        return twist
    bodies = _bodies(around, limits)
    if not len(bodies.at):
        return twist
    for share in SHARES:
        part = Twist(0.0 if spins else twist.forward * share, twist.turn * share)
        if _keeps_apart(part, bodies, limits):
            return part
    return STILL


def _slower_before_followers(twist: Twist, around: NearbyPeople, limits: MotionLimits) -> Twist:
    """Return a twist limited to `people_speed` while a walker is hidden behind the robot.

    The walker may overtake the robot, or approach where the scanner does not see.
    """
    follows = any(
        one.hidden and one.x < 0.0 and one.pace > WALKS and np.hypot(one.x, one.y) < REACH
        for one in around.tracks
    )
    if not follows or twist.forward <= limits.people_speed:
        return twist
    share = limits.people_speed / twist.forward
    return Twist(limits.people_speed, twist.turn * share)


class _Body(NamedTuple):
    """A person's track, or a return without a track, as the robot has to keep apart from it.

    If both driving and stopping come nearer than `apart` m, which grows at `approach` m/s, driving
    must gain `leeway` m over stopping: slightly negative for standing people, positive for walkers.
    A negative one only holds beyond `kept` m: else the robot would creep up to a person, command by
    command. `held` is the same for commands so slow that `apart` would let the robot nearer; 0:
    `apart` decides. Walkers may also turn, and standing people set off, and approach at `turned`
    m/s; 0 if not. The velocity (m/s) of a `fresh` body is not known yet.
    """

    x: float
    y: float
    vx: float
    vy: float
    apart: float
    approach: float
    leeway: float
    turned: float
    kept: float
    held: float
    fresh: bool


class _Bodies(NamedTuple):
    """Bodies as arrays: positions and velocities (n, 2), and the other values of `_Body` (n,)."""

    at: Floats
    velocity: Floats
    apart: Floats
    approach: Floats
    leeway: Floats
    turned: Floats
    kept: Floats
    held: Floats
    fresh: NDArray[np.bool_]


def _bodies(around: NearbyPeople, limits: MotionLimits) -> _Bodies:
    """Return the people within reach."""
    tracks = [one for one in around.tracks if np.hypot(one.x, one.y) < REACH]
    ends = around.ends[lengths(around.ends) < REACH]
    bodies = [_tracked(one, limits) for one in tracks]
    bodies += [_return(x, y, limits) for x, y in ends]
    table = np.array(bodies, dtype=np.float64).reshape(-1, len(_Body._fields))
    x, y, vx, vy, apart, approach, leeway, turned, kept, held, fresh = table.T
    at, velocity = np.column_stack((x, y)), np.column_stack((vx, vy))
    return _Bodies(at, velocity, apart, approach, leeway, turned, kept, held, fresh > 0.0)


def _tracked(one: Track, limits: MotionLimits) -> _Body:
    # a walker who turns round has no speed for a moment
    walks, fresh = max(one.speed, one.pace) > WALKS, one.age < FRESH
    return _Body(
        *(one.x, one.y, one.vx, one.vy),
        apart=one.half + limits.margin,
        approach=limits.approach_new if fresh else limits.approach,
        leeway=FURTHER if walks else -NEARER,
        turned=_turned(one, limits),
        kept=one.half + KEPT,
        held=one.half + KEPT if abs(one.half - TORSO) < PAIR else 0.0,
        fresh=fresh,
    )


def _return(x: float, y: float, limits: MotionLimits) -> _Body:
    return _Body(
        *(x, y, 0.0, 0.0),
        apart=END + limits.margin,
        approach=limits.approach,
        leeway=-NEARER,
        turned=0.0,
        kept=KEPT_END,
        held=0.0,
        fresh=False,
    )


def _turned(one: Track, limits: MotionLimits) -> float:
    """Return how fast a walker may turn and approach, or a standing person set off, in m/s."""
    if one.pace <= WALKS:
        return limits.set_off
    return min(limits.approach_turned, one.pace + limits.turned_faster)


def _keeps_apart(twist: Twist, bodies: _Bodies, limits: MotionLimits) -> bool:
    """Return whether a robot that drives this twist and then brakes stays clear of people."""
    fast, brakes = abs(twist.forward), limits.full_braking
    if not fast:
        fast, brakes = abs(twist.turn), limits.turn_acceleration
    until = limits.latency + fast / brakes
    times = np.append(np.arange(STEP, until, STEP), until)
    braking = np.maximum(times - limits.latency, 0.0)
    gone = (fast * times - brakes * braking**2 / 2) / fast  # equivalent time at full speed, in s
    along, turned = twist.forward * gone, twist.turn * gone
    half = turned / 2
    chord = along * np.sinc(half / np.pi)
    robot = np.column_stack((chord * np.cos(half), chord * np.sin(half)))
    drives = _Motion(twist, robot, turned)
    walking = bodies.at + times[:, None, None] * bodies.velocity
    keep = bodies.apart + bodies.approach * times[:, None]
    turn = bodies.apart + np.where(bodies.turned > 0, bodies.turned * times[:, None], -np.inf)
    return _stays_clear(drives, walking, keep, bodies, limits) and _stays_clear(
        drives, bodies.at[None], turn, bodies, limits
    )


class _Motion(NamedTuple):
    """A twist, and where the robot is (times, 2) and how far it has turned (times,) meanwhile."""

    twist: Twist
    robot: Floats
    turned: Floats


def _stays_clear(
    drives: _Motion, people: Floats, apart: Floats, bodies: _Bodies, limits: MotionLimits
) -> bool:
    """Return whether a motion keeps apart (times, n) from people (times, n, 2), or is an escape."""
    twist, robot, turned = drives
    seen = people - robot[:, None]
    driving = _off(seen, turned, limits)
    standing = _off(people, np.zeros(len(people)), limits)
    walk = bodies.leeway > 0.0
    near = driving < np.maximum(apart, np.where(walk, 0.0, bodies.held))
    least = standing + bodies.leeway
    least = np.where(walk, least, np.minimum(standing, np.maximum(least, bodies.kept)))
    if (near & (driving < least)).any():
        return False
    walkers = near & walk
    if not twist.forward or not walkers.any():
        return True
    if (walkers & bodies.fresh).any():
        return False
    front = seen if twist.forward > 0.0 else -seen
    slowly = abs(twist.forward) <= limits.people_speed
    return slowly and not (walkers & _not_behind(front, turned)).any()


def _not_behind(people: Floats, turned: Floats) -> NDArray[np.bool_]:
    """Return which people (times, n, 2) are not behind a robot turned by (times,) rad."""
    bearing = np.arctan2(people[..., 1], people[..., 0]) - turned[:, None]
    return np.asarray(np.cos(bearing) > BEHIND)


def _off(people: Floats, turned: Floats, limits: MotionLimits) -> Floats:
    """Return the distances of people (times, n, 2) from a robot turned by (times,) rad."""
    if not limits.corners:
        return np.asarray(np.hypot(people[..., 0], people[..., 1]) - limits.radius)
    c, s = np.cos(turned)[:, None], np.sin(turned)[:, None]
    x = c * people[..., 0] + s * people[..., 1]
    y = c * people[..., 1] - s * people[..., 0]
    return outside(np.stack((x, y), axis=-1), np.array(limits.corners))


def outside(points: Floats, corners: Floats) -> Floats:
    """Return the signed distance in m of points (..., 2) from a polygon (m, 2); negative inside."""
    sides = np.roll(corners, -1, axis=0) - corners
    far = np.hypot(sides[:, 0], sides[:, 1])
    to = points[..., None, :] - corners
    along = np.clip((to * sides).sum(axis=-1) / far**2, 0.0, 1.0)
    apart = np.linalg.norm(to - along[..., None] * sides, axis=-1).min(axis=-1)
    across = (sides[:, 0] * to[..., 1] - sides[:, 1] * to[..., 0]) / far
    within = (across > 0).all(axis=-1)
    return np.asarray(np.where(within, -apart, apart))
