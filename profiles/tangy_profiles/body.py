"""A robot's body, read from its profile: size, dynamics, and the mounting of its devices.

The origin is the midpoint between its wheels, about which it turns: x is ahead, y to the left, in
m.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from math import hypot
from types import MappingProxyType

from tangy_profiles.reading import Table

LARGEST = 2.0  # metres from its centre to its edge
FASTEST_TURN = 6.0  # rad/s
HARDEST = 5.0  # m/s^2
HIGHEST = 3.0  # metres above the floor
SHORTEST = 1.0  # metres that a scanner must see
MEASURED = ("radius", "turn", "acceleration", "braking", "laser")
"""The values that have to be measured on each robot: it drives by them."""


@dataclass(frozen=True)
class Mount:
    """The mounting of a device: x, y and height in m; yaw in degrees, to the left.

    `reach` is its range in m, beyond which a scanner is not believed; 0: the range that the device
    reports.
    """

    x: float = 0.0
    y: float = 0.0
    height: float = 0.0
    yaw: float = 0.0
    reach: float = 0.0


@dataclass(frozen=True)
class BodyProfile:
    """The body of a robot; the defaults are Tangy's.

    It is round with `radius` m, or has `corners` (x, y) in m, and `radius` is then the distance of
    the outermost one. `turn` is in rad/s; `acceleration` and `braking` are in m/s^2. `arms` is how
    far its arms reach, in m from its centre. `assumed` are the values of `MEASURED` that the file
    leaves out, so that Tangy's own are used.
    """

    radius: float = 0.25
    corners: tuple[tuple[float, float], ...] = ()
    turn: float = 1.0
    acceleration: float = 0.5
    braking: float = 1.0
    laser: Mount = field(default_factory=Mount)
    cameras: Mapping[str, Mount] = field(default_factory=dict)
    arms: float = 0.0
    assumed: tuple[str, ...] = field(default=(), compare=False)


def read_body(top: Table, cameras: Iterable[str]) -> BodyProfile:
    """Read the table `body` of a robot's profile; `cameras` are the names of its cameras.

    Raises:
        ProfileError: names the key and its problem.
    """
    if "body" not in top:
        return BodyProfile(assumed=MEASURED)
    entry, usual = top.table("body"), BodyProfile()
    corners = _corners(entry)
    if corners:
        if "radius" in entry:
            raise entry.wrong("radius", "is too much beside corners: remove one of the two.")
        radius = max(hypot(x, y) for x, y in corners)
    else:
        radius = entry.number("radius", 0.05, LARGEST, usual.radius, unit="m")
    seen = entry.table("cameras", optional=True)
    known = tuple(cameras)
    body = BodyProfile(
        radius,
        corners,
        entry.number("turn", 0.1, FASTEST_TURN, usual.turn, unit="rad/s"),
        entry.number("acceleration", 0.05, HARDEST, usual.acceleration, unit="m/s²"),
        entry.number("braking", 0.2, HARDEST, usual.braking, unit="m/s²"),
        _laser(entry.table("laser", optional=True)),
        MappingProxyType({name: _mount(seen.table(name)) for name in seen if name in known}),
        entry.number("arms", 0.0, LARGEST, usual.arms, unit="m"),
        tuple(key for key in MEASURED if key not in entry and (key != "radius" or not corners)),
    )
    seen.close(also=known)
    entry.close(also=() if corners else ("radius", "corners"))
    return body


def _laser(entry: Table) -> Mount:
    mount = _mount(entry)
    if 0 < mount.reach < SHORTEST:
        raise entry.wrong("range", f"must be at least {SHORTEST:g} m, or left out.")
    return mount


def _mount(entry: Table) -> Mount:
    mount = Mount(
        entry.number("x", -LARGEST, LARGEST, 0.0, unit="m"),
        entry.number("y", -LARGEST, LARGEST, 0.0, unit="m"),
        entry.number("height", 0.0, HIGHEST, 0.0, unit="m"),
        entry.number("yaw", -180.0, 180.0, 0.0, unit="degrees"),
        entry.number("range", 0.0, 1000.0, 0.0, unit="m"),
    )
    entry.close()
    return mount


def _corners(entry: Table) -> tuple[tuple[float, float], ...]:
    """Read the corners of a polygonal footprint: x, y, x, y, ... around the robot, in m."""
    if "corners" not in entry:
        return ()
    count = entry.length("corners")
    if count < 6 or count % 2:
        raise entry.wrong("corners", "must be x, y of at least three corners, one after another.")
    numbers = entry.numbers("corners", count, -LARGEST, LARGEST)
    corners = tuple(zip(numbers[::2], numbers[1::2], strict=True))
    after, next_but_one = corners[1:] + corners[:1], corners[2:] + corners[:2]
    turns = {_left_of(*three) for three in zip(corners, after, next_but_one, strict=True)}
    if len(turns) != 1 or 0 in turns:
        raise entry.wrong(
            "corners", "must go once round a shape without a dent, each corner beside the last."
        )
    side = turns.pop()
    if any(_left_of(a, b, (0.0, 0.0)) != side for a, b in zip(corners, after, strict=True)):
        raise entry.wrong("corners", "must go round 0, 0, the middle between the wheels.")
    return corners if side > 0 else corners[::-1]


Point = tuple[float, float]


def _left_of(a: Point, b: Point, c: Point) -> int:
    """Return whether c is to the left (1) or right (-1) of the line from a to b, or on it (0)."""
    across = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return (across > 1e-9) - (across < -1e-9)
