"""Checks how well scans agree with the map that was drawn from them.

If a robot revisits a place with wrong poses, the map contains the same wall twice: the beams of one
pass go through the wall that the other pass saw, and end where the other pass saw free floor.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from scipy.ndimage import distance_transform_edt

from tangy_hw.navigation.mapping import PlacedScan
from tangy_hw.navigation.occupancy import OCCUPIED, OccupancyMap
from tangy_hw.navigation.poses import endpoints, transform_points
from tangy_hw.navigation.revisits import Revisits

TORN = 0.1
"""Share of contradicted beams from which a map counts as torn.

On simulated rooms and corridors with matched scans, maps that closed had at most .03, maps that did
not close at least .23. On Freiburg's building 079 the corrected log has .07, and newly matched
scans, which tear the map, .30. In three drives round a corridor of 22 x 15 m, maps that were at
most .25 and .39 m off the true walls had .04 and .06; one that was .58 m off had .13, and with its
loops closed, .13 m off, .03.
"""

UNSURE = 0.025
"""Share from which a map without confirmed loops is not believed to be closed."""

REACH = 20.0  # metres: the ends of more distant beams are too far apart
NEAR = 0.2  # metres from a beam's end within which there must be a wall
SHORT = 0.3  # metres before its end within which a beam may graze a wall
STEP = 0.1  # metres between the points checked along a beam
MOST_SCANS = 400  # evenly spaced scans that are checked at most


Verdict = Literal["closed", "open", "torn", "unknown"]
"""closed: the robot revisited places, and its poses agree there; open: it revisited none; torn: it
revisited places, and its poses disagree; unknown: the scans do not tell."""


def verdict(share: float, found: Revisits) -> Verdict:
    """Judge whether a map closes, from its loops and the share (0 to 1) of contradicted beams."""
    if share > TORN or found.tears:
        return "torn"
    if found.closed:
        return "closed"
    return "unknown" if found.unconfirmed and share > UNSURE else "open"


def contradicted(scans: Sequence[PlacedScan], map_: OccupancyMap) -> float:
    """Return the share of beams that contradict a map, from 0 to 1.

    A beam contradicts the map if there is no wall within `NEAR` of its end, or if it crosses a
    wall.
    """
    walls = map_.cells == OCCUPIED
    far = distance_transform_edt(~walls) * map_.resolution if walls.any() else None
    if far is None or not len(scans):
        return 0.0
    beams = against = 0
    for one in scans[:: max(1, len(scans) // MOST_SCANS)]:
        points = endpoints(one.scan, REACH)
        if not len(points):
            continue
        ends, start = transform_points(points, one.pose), np.array([one.pose.x, one.pose.y])
        length = np.hypot(points[:, 0], points[:, 1])
        along = np.arange(STEP, REACH, STEP)
        on_way = start + (ends - start)[:, None, :] * (along / length[:, None])[..., None]
        before = along[None, :] < length[:, None] - SHORT
        missing = map_.values_at(ends, far, np.nan) > NEAR
        through = ((map_.values_at(on_way, far, np.nan) == 0) & before).any(axis=1)
        beams += len(points)
        against += int((missing | through).sum())
    return against / beams if beams else 0.0
