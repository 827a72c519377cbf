"""Checks of what drivers do and measure: one of another package may be wrong in any way.

A driver that raises or hangs is named, and data that make no sense count as an error of the device:
the robot stands, rather than driving by them.
"""

from __future__ import annotations

import asyncio
import logging
import math
from collections.abc import Callable, Coroutine
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tangy_hw.device_protocols import (
    Device,
    DeviceError,
    DeviceFailed,
    Odometry,
    Pose,
    Scan,
    Stamped,
    Twist,
    fails,
    hangs,
)
from tangy_hw.navigation.poses import compose, relative_pose, up_to
from tangy_profiles.errors import TangyError
from tangy_profiles.health import ERROR, NEVER, STALE, Reading

if TYPE_CHECKING:
    from tangy_hw.robot_process.body import Body

_LOG = logging.getLogger(__name__)

START_SECONDS = 25.0  # longer than any of our drivers waits by itself
FEWEST_BEAMS = 10
WIDEST = 2 * math.pi + 0.2  # rad; some scanners repeat a beam at their seam
FASTEST = 10.0  # m/s and rad/s
FARTHEST = 500.0  # m; no scanner indoors measures so far
MOST_ZEROS = 0.2  # share of the beams
OFF_SECONDS = 600.0  # by which a stamp may be behind the robot's clock
AHEAD_SECONDS = 1.0  # by which one may be ahead of it

JUMP = 0.5  # m and rad; with a limit of speed: nobody drives so far between two messages
JUMP_SPEED = 3.0  # m/s and rad/s
ORIGIN = 0.05  # m and rad from the pose that a base has when it is switched on
GAP_SECONDS = 1.0  # of silence, after which a base may have been switched on again


async def start_device(device: Device, seconds: float = START_SECONDS) -> None:
    """Start a device, within so many s.

    Raises:
        DeviceFailed: its driver fails, or takes too long; the sentence names the device.
    """
    try:
        await _within(device, seconds, device.start)
    except TangyError as error:
        raise DeviceFailed(device.name, str(error)) from error


async def restart_device(device: Device, seconds: float = START_SECONDS) -> None:
    """Switch a device off and on again, within so many s.

    Raises:
        TangyError: its driver fails, or takes too long; the sentence names the device.
    """
    await _within(device, seconds, device.close, device.start)


async def _within(
    device: Device, seconds: float, *steps: Callable[[], Coroutine[Any, Any, None]]
) -> None:
    try:
        async with asyncio.timeout(seconds) as limit:
            for step in steps:
                await step()
    except TangyError:
        raise
    except Exception as error:
        if limit.expired():
            raise DeviceError(f"{device.name}: {hangs(seconds)}") from None
        raise DeviceError(f"{device.name}: {fails(error)}") from error


def safe_reading(device: Device) -> Reading:
    """Return the reading of a device.

    One that cannot be taken, or whose data come from the future, is an error of the device.
    """
    try:
        reading = device.reading()
        return reading._replace(state=ERROR) if reading.age < -AHEAD_SECONDS else reading
    except Exception:
        return Reading(device.name, NEVER, ERROR)


def scan_problem(value: Any, now: float | None = None) -> str:
    """Return what is wrong with the value of a scanner's `scan`, "" if nothing is.

    `now` is the robot's time in s, to check the stamp.
    """
    if not isinstance(value, Stamped) or not isinstance(value.value, Scan):
        return "its scan is no Stamped(Scan(...), stamp, seq)."
    scan = value.value
    if not isinstance(scan.ranges, np.ndarray) or scan.ranges.ndim != 1:
        return "the ranges of its scan are no array with one number for each beam."
    count = len(scan.ranges)
    if count < FEWEST_BEAMS:
        return f"its scan has {count} beams: too few."
    try:
        bad = int(np.isnan(scan.ranges).sum())
        zeros = int((scan.ranges == 0).sum())
        numbers = (scan.first, scan.step, scan.farthest, value.stamp, value.time)
        if not all(map(math.isfinite, numbers)) or scan.step == 0 or scan.farthest <= 0:
            return "first, step, farthest and stamp of its scan must be numbers."
    except TypeError:
        return "its scan has something else than numbers."
    if bad == count:
        return f"none of its {count} distances can be used: all are NaN."
    if bad:
        return f"{bad} of {count} ranges are NaN: a beam without a return is inf."
    if (scan.ranges < 0).any():
        return "some ranges are negative: a beam without a return is inf."
    if zeros > MOST_ZEROS * count:
        return f"{zeros} of {count} ranges are 0: a beam without a return is inf."
    if scan.farthest > FARTHEST:
        return f"its farthest is above {FARTHEST:g}: it is in m."
    if abs(scan.step) * (count - 1) > WIDEST:
        return "its beams go round more than once: first and step are in rad."
    met = scan.ranges[np.isfinite(scan.ranges)]
    if len(met) and float(np.median(met)) > 2 * scan.farthest:
        return "most ranges are longer than its farthest: both are in m."
    return _stamp_problem(value.stamp, now)


def odometry_problem(value: Any, now: float | None = None) -> str:
    """Return what is wrong with the value of a base's `odometry`, "" if nothing is.

    `now` is the robot's time in s, to check the stamp.
    """
    if not isinstance(value, Stamped) or not isinstance(value.value, Odometry):
        return "its odometry is no Stamped(Odometry(pose, twist), stamp, seq)."
    pose, twist = value.value
    if not isinstance(pose, Pose) or not isinstance(twist, Twist):
        return "its odometry is no Odometry(Pose(x, y, heading), Twist(forward, turn))."
    try:
        numbers = (*pose, *twist, value.stamp, value.time)
        finite = all(map(math.isfinite, numbers))
    except TypeError:
        return "its odometry has something else than numbers."
    if not finite:
        return "its odometry has a NaN or an infinite number."
    if max(map(abs, twist)) > FASTEST:
        return f"its speed is above {FASTEST:g}: it is in m/s and rad/s."
    return _stamp_problem(value.stamp, now)


def _stamp_problem(stamp: float, now: float | None) -> str:
    if now is None or -AHEAD_SECONDS <= now - stamp <= OFF_SECONDS:
        return ""
    return "the stamps of its data are not of wiring.clock.now()."


class CheckedData:
    """The newest odometry and scan of a robot: only such that make sense.

    If a base is switched on again, its odometry begins anew. The pose goes on from the last one.
    """

    def __init__(self, body: Body, clock: Callable[[], float], reach: float = math.inf) -> None:
        """Check the data of a robot's devices.

        Args:
            body: the devices.
            clock: returns the robot's time in s.
            reach: range in m beyond which the scanner is not believed.
        """
        self._body, self._clock, self._reach = body, clock, reach
        self._known: dict[str, tuple[Any, str]] = {}
        self._sent: Stamped[Scan] | None = None  # the newest scan that makes sense, as it came
        self._good: Stamped[Scan] | None = None  # up to the scanner's range
        self._raw: Stamped[Odometry] | None = None
        self._begins: tuple[Pose, Pose] | None = None  # the same pose, by the base and by us

    @property
    def scan(self) -> Stamped[Scan] | None:
        """The newest scan that makes sense, up to the scanner's range; None before the first."""
        value = self._checked("laser")
        if value is not None and value is not self._sent:
            near = up_to(value.value, self._reach)
            self._sent = value
            self._good = value if near is value.value else replace(value, value=near)
        return self._good

    @property
    def odometry(self) -> Stamped[Odometry] | None:
        """The newest odometry that makes sense, without its jumps; None before the first."""
        value = self._checked("base")
        if value is not None and value is not self._raw:
            if self._raw is not None and _jumps(self._raw, value):
                _LOG.warning("base: its odometry began anew")
                self._begins = (value.value.pose, self._placed(self._raw.value.pose))
            self._raw = value
        if self._raw is None or self._begins is None:
            return self._raw
        placed = self._raw.value._replace(pose=self._placed(self._raw.value.pose))
        return Stamped(placed, self._raw.stamp, self._raw.seq, self._raw.measured)

    def report(self, device: Device) -> Reading:
        """Return the reading of a device.

        A base or a scanner whose data make no sense has an error; one that has sent nothing is
        stale. Its data are at least as old as their stamp.
        """
        reading = safe_reading(device)
        if device is not self._body.base and device is not self._body.laser:
            return reading
        name = "base" if device is self._body.base else "laser"
        value = self._checked(name)
        if value is not None:
            return reading._replace(age=max(reading.age, min(self._clock() - value.stamp, NEVER)))
        wrong = self._known[name][1] or reading.state == ERROR
        return reading._replace(state=ERROR if wrong else STALE)

    def _placed(self, pose: Pose) -> Pose:
        if self._begins is None:
            return pose
        return compose(self._begins[1], relative_pose(self._begins[0], pose))

    def _checked(self, name: str) -> Any:
        """Return the newest value of the base or the laser; None if there is none to drive by."""
        try:
            value = self._body.laser.scan if name == "laser" else self._body.base.odometry
            known = self._known.get(name)
            if value is None:
                self._note(name, None, "")
            elif known is None or known[0] is not value:
                check = scan_problem if name == "laser" else odometry_problem
                self._note(name, value, check(value, self._clock()))
        except Exception as error:
            self._note(name, None, fails(error))
            return None
        return None if self._known[name][1] else value

    def _note(self, name: str, value: Any, problem: str) -> None:
        if problem and self._known.get(name, (None, ""))[1] != problem:
            _LOG.warning("%s: %s", name, problem)
        self._known[name] = (value, problem)


def _jumps(last: Stamped[Odometry], value: Stamped[Odometry]) -> bool:
    """Return whether odometry began anew between two values: no base drives so far meanwhile."""
    step = relative_pose(last.value.pose, value.value.pose)
    passed = max(0.0, value.stamp - last.stamp, value.time - last.time)  # some come in a burst
    far = JUMP + JUMP_SPEED * passed
    distance = math.hypot(step.x, step.y)
    if distance > far or abs(step.heading) > far:
        return True
    x, y, heading = value.value.pose
    # A base with a compass keeps its heading.
    at_origin = math.hypot(x, y) < ORIGIN and (abs(heading) < ORIGIN or distance > JUMP)
    moved = distance > JUMP / 2 or abs(step.heading) > JUMP
    return passed > GAP_SECONDS and at_origin and moved
