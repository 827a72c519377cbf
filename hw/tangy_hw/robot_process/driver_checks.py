"""Checks of what drivers do and measure: one of another package may be wrong in any way.

A driver that raises or hangs is named, and data that make no sense count as an error of the device:
the robot stands, rather than driving by them.
"""

from __future__ import annotations

import asyncio
import logging
import math
from typing import Any

import numpy as np

from tangy_hw.device_protocols import (
    Device,
    DeviceError,
    Odometry,
    Pose,
    Scan,
    Stamped,
)
from tangy_hw.navigation.poses import compose, relative_pose
from tangy_hw.robot_process.body import Body
from tangy_profiles.errors import TangyError
from tangy_profiles.health import ERROR, NEVER, Reading
from tangy_profiles.reading import plain

_LOG = logging.getLogger(__name__)

START_SECONDS = 20.0
FEWEST_BEAMS = 10
WIDEST = 2 * math.pi + 0.2  # rad; some scanners repeat a beam at their seam
FASTEST = 10.0  # m/s and rad/s
OFF_SECONDS = 600.0  # by which a stamp may differ from the robot's clock

JUMP = 0.5  # m and rad; with a limit of speed: nobody drives so far between two messages
JUMP_SPEED = 3.0  # m/s and rad/s
ORIGIN = 0.05  # m and rad from the pose that a base has when it is switched on
GAP_SECONDS = 0.3  # of silence, after which a base may have been switched on again


def fails(error: Exception) -> str:
    """Return what is told about a driver that raises an error."""
    return plain(f"its driver fails: {type(error).__name__}: {error}").rstrip(".") + "."


def hangs(seconds: float) -> str:
    """Return what is told about a driver whose `start` takes longer than some s."""
    return f"its driver has not started within {seconds:g} s."


async def start_device(device: Device, seconds: float = START_SECONDS) -> None:
    """Start a device, within so many s.

    Raises:
        TangyError: its driver fails, or takes too long; the sentence names the device.
    """
    try:
        async with asyncio.timeout(seconds):
            await device.start()
    except TangyError:
        raise
    except TimeoutError:
        raise DeviceError(f"{device.name}: {hangs(seconds)}") from None
    except Exception as error:
        raise DeviceError(f"{device.name}: {fails(error)}") from error


def safe_reading(device: Device) -> Reading:
    """Return the reading of a device; one that cannot be taken is an error of the device."""
    try:
        return device.reading()
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
        numbers = (scan.first, scan.step, scan.farthest, value.stamp)
        if not all(map(math.isfinite, numbers)) or scan.step == 0 or scan.farthest <= 0:
            return "first, step, farthest and stamp of its scan must be numbers."
    except TypeError:
        return "its scan has something else than numbers."
    if bad:
        return f"{bad} of {count} ranges are NaN: a beam without a return is inf."
    if (scan.ranges < 0).any():
        return "some ranges are negative: a beam without a return is inf."
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
    try:
        pose, twist = value.value
        numbers = (*pose, *twist, value.stamp)
        finite = all(map(math.isfinite, numbers))
    except TypeError:
        return "its odometry has something else than numbers."
    if not finite:
        return "its odometry has a NaN or an infinite number."
    if max(map(abs, twist)) > FASTEST:
        return f"its speed is above {FASTEST:g}: it is in m/s and rad/s."
    return _stamp_problem(value.stamp, now)


def _stamp_problem(stamp: float, now: float | None) -> str:
    if now is None or abs(now - stamp) <= OFF_SECONDS:
        return ""
    return "the stamps of its data are not of wiring.clock.now()."


class CheckedData:
    """The newest odometry and scan of a robot: only such that make sense.

    If a base is switched on again, its odometry begins anew. The pose goes on from the last one.
    """

    def __init__(self, body: Body) -> None:
        """Check the data of a robot's devices."""
        self._body = body
        self._known: dict[str, tuple[Any, str]] = {}
        self._good: Stamped[Scan] | None = None
        self._raw: Stamped[Odometry] | None = None
        self._begins: tuple[Pose, Pose] | None = None  # the same pose, by the base and by us

    @property
    def scan(self) -> Stamped[Scan] | None:
        """The newest scan that makes sense; None before the first."""
        value = self._body.laser.scan
        if value is not None and not self._problem("laser", value):
            self._good = value
        return self._good

    @property
    def odometry(self) -> Stamped[Odometry] | None:
        """The newest odometry that makes sense, without its jumps; None before the first."""
        value = self._body.base.odometry
        if value is not None and not self._problem("base", value) and value is not self._raw:
            if self._raw is not None and _jumps(self._raw, value):
                _LOG.warning("base: its odometry began anew")
                self._begins = (value.value.pose, self._placed(self._raw.value.pose))
            self._raw = value
        if self._raw is None or self._begins is None:
            return self._raw
        placed = self._raw.value._replace(pose=self._placed(self._raw.value.pose))
        return Stamped(placed, self._raw.stamp, self._raw.seq, self._raw.measured)

    def report(self, device: Device) -> Reading:
        """Return the reading of a base or a scanner; data that make no sense are an error."""
        reading = safe_reading(device)
        known = self._known.get(device.name)
        return reading._replace(state=ERROR) if known is not None and known[1] else reading

    def _placed(self, pose: Pose) -> Pose:
        if self._begins is None:
            return pose
        return compose(self._begins[1], relative_pose(self._begins[0], pose))

    def _problem(self, name: str, value: Any) -> str:
        known = self._known.get(name)
        if known is None or known[0] is not value:
            check = scan_problem if name == "laser" else odometry_problem
            problem = check(value)
            if problem and (known is None or known[1] != problem):
                _LOG.warning("%s: %s", name, problem)
            known = self._known[name] = (value, problem)
        return known[1]


def _jumps(last: Stamped[Odometry], value: Stamped[Odometry]) -> bool:
    """Return whether odometry began anew between two values: no base drives so far meanwhile."""
    step = relative_pose(last.value.pose, value.value.pose)
    passed = max(0.0, value.stamp - last.stamp)
    far = JUMP + JUMP_SPEED * passed
    if math.hypot(step.x, step.y) > far:
        return True
    x, y, heading = value.value.pose
    at_origin = math.hypot(x, y) < ORIGIN and abs(heading) < ORIGIN
    moved = math.hypot(step.x, step.y) > JUMP / 2 or abs(step.heading) > JUMP
    return passed > GAP_SECONDS and at_origin and moved
