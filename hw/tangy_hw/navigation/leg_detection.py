"""Detects legs and bodies in a scan: clusters of returns, and pairs of legs."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import cos, hypot, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tangy_hw.device_protocols import Pose, Scan
from tangy_hw.navigation.likelihood import NEAREST
from tangy_hw.navigation.poses import IDENTITY, Floats, bearings, compose

FARTHEST = 5.0  # metres beyond which too few beams hit a leg
SPLIT, SPLIT_SHARE = 0.10, 0.02  # gap between two clusters: metres, and share of the range
SKIPPED = 3  # beams without a return that a cluster may contain
LEG = (0.03, 0.30)  # width in metres
BEHIND = 0.06  # metres from the visible side of a leg to its centre
APART = (0.10, 0.45)  # metres between the legs of a person
EXPECTED = 0.15  # metres from where a person is expected to the centre of their legs
CHAIR, SOLID = 0.25, 0.06  # legs further apart than CHAIR must be SOLID wide, in m
CLOSE = 0.6  # metres from the middle of a pair within which other legs count
WIDEST = 0.9  # metres of width above which a cluster is furniture
TORSO = 0.22  # metres from the centre of a person to the edge of the torso
REACH = 0.2  # minimum of metres that torso and toes extend beyond the centre of one leg


class LegSighting(NamedTuple):
    """A person, leg or object in a scan: its centre in m in the robot's frame.

    `half` is its radius in m; `legs` says whether a pair of legs was seen. `width` is that of the
    narrower leg in m, and `others` counts other legs close by, if a pair was seen side by side.
    """

    x: float
    y: float
    half: float
    legs: bool
    width: float = 0.0
    others: int = 0


class Cluster(NamedTuple):
    """Returns from one object: its centre, behind the visible side, and its width, in m."""

    x: float
    y: float
    width: float


def sightings(
    scan: Scan,
    laser: Pose = IDENTITY,
    unmapped: NDArray[np.bool_] | None = None,
    expected: Sequence[tuple[float, float]] = (),
) -> list[LegSighting]:
    """Return the people and objects in a scan that are not on the map.

    Args:
        scan: the scan.
        laser: pose of the scanner on the robot.
        unmapped: (n,) for each beam, whether it ends away from everything on the map; None: all do.
        expected: where people are expected, in m in the robot's frame. If there are several, legs
            that fit one of them are paired first: people who pass each other keep their own legs.
    """
    found = clusters(scan, laser, unmapped)
    legs = [one for one in found if LEG[0] <= one.width <= LEG[1]]
    pairs = _pairs(legs, expected)
    paired = {number for pair in pairs for number in pair}
    people = [_person(legs, a, b) for a, b in pairs]
    single = [
        LegSighting(leg.x, leg.y, REACH, False)
        for number, leg in enumerate(legs)
        if number not in paired
    ]
    wide = [
        LegSighting(one.x, one.y, max(one.width / 2, REACH), False)
        for one in found
        if LEG[1] < one.width <= WIDEST
    ]
    return people + single + wide


def clusters(scan: Scan, laser: Pose, unmapped: NDArray[np.bool_] | None) -> list[Cluster]:
    """Return the clusters of returns in a scan that are nearer than `FARTHEST`.

    Only `unmapped` beams (n,) count; None: all do.
    """
    kept = (scan.ranges > NEAREST) & (scan.ranges < min(FARTHEST, scan.farthest))
    if unmapped is not None:
        kept &= unmapped
    beams = np.flatnonzero(kept)
    if not len(beams):
        return []
    ranges, angles = scan.ranges[beams], bearings(scan)[beams]
    points = np.column_stack((ranges * np.cos(angles), ranges * np.sin(angles)))
    gaps = np.hypot(*np.diff(points, axis=0).T)
    cut = (gaps > SPLIT + SPLIT_SHARE * ranges[1:]) | (np.diff(beams) > SKIPPED + 1)
    bounds = [0, *(np.flatnonzero(cut) + 1).tolist(), len(beams)]
    return [
        _cluster(points[a:b], float(ranges[a:b].mean()), abs(scan.step), laser)
        for a, b in pairwise(bounds)
    ]


def _cluster(points: Floats, far: float, step: float, laser: Pose) -> Cluster:
    first, last = points[0], points[-1]
    width = hypot(*(last - first)) + far * step
    x, y = points.mean(axis=0)
    out = 1.0 + BEHIND / max(hypot(x, y), BEHIND)
    middle = compose(laser, Pose(float(x * out), float(y * out), 0.0))
    return Cluster(middle.x, middle.y, width)


def _person(legs: Sequence[Cluster], a: int, b: int) -> LegSighting:
    """Return the person whose legs have these numbers."""
    x, y = (legs[a].x + legs[b].x) / 2, (legs[a].y + legs[b].y) / 2
    others = sum(
        hypot(leg.x - x, leg.y - y) < CLOSE for n, leg in enumerate(legs) if n not in (a, b)
    )
    return LegSighting(x, y, TORSO, True, min(legs[a].width, legs[b].width), others)


def _pairs(legs: list[Cluster], expected: Sequence[tuple[float, float]]) -> list[tuple[int, int]]:
    """Return the pairs of legs by their numbers: expected people first, then the closest pairs."""
    near = []
    for a, one in enumerate(legs):
        for b in range(a + 1, len(legs)):
            apart = hypot(one.x - legs[b].x, one.y - legs[b].y)
            solid = min(one.width, legs[b].width) >= SOLID
            if APART[0] <= apart <= (APART[1] if solid else CHAIR):
                near.append((apart, a, b))
    found = _expected_pairs(legs, [(a, b) for _, a, b in near], expected)
    taken = {number for pair in found for number in pair}
    for _, a, b in sorted(near):
        if a not in taken and b not in taken:
            taken |= {a, b}
            found.append((a, b))
    return found


def _expected_pairs(
    legs: list[Cluster], pairs: list[tuple[int, int]], expected: Sequence[tuple[float, float]]
) -> list[tuple[int, int]]:
    """Return the pairs that fit expected people best, one for each; none for a single person."""
    if len(expected) < 2:
        return []
    fits = sorted(
        (hypot((legs[a].x + legs[b].x) / 2 - x, (legs[a].y + legs[b].y) / 2 - y), a, b, person)
        for a, b in pairs
        for person, (x, y) in enumerate(expected)
    )
    found: list[tuple[int, int]] = []
    taken: set[int] = set()
    met: set[int] = set()
    for off, a, b, person in fits:
        if off < EXPECTED and person not in met and a not in taken and b not in taken:
            met.add(person)
            taken |= {a, b}
            found.append((a, b))
    return found


def turned(x: float, y: float, heading: float) -> tuple[float, float]:
    """Return a vector rotated by an angle in rad."""
    c, s = cos(heading), sin(heading)
    return c * x - s * y, s * x + c * y
