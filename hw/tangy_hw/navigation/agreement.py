"""How well scans agree with the map that was made of them.

Where a robot came back to a place and its poses did not, the same wall stands in the map twice: one
pass looks through the wall that the other saw, and sees its own where the other saw the floor.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from scipy.ndimage import distance_transform_edt

from tangy_hw.navigation.mapping import Placed
from tangy_hw.navigation.occupancy import OCCUPIED, OccupancyMap
from tangy_hw.navigation.poses import Floats, endpoints, placed
from tangy_hw.navigation.revisits import Revisits

TORN = 0.15
"""The share of contradicted beams from which a map counts as torn.

Chosen on simulated rooms and corridors, matched: those that closed had .03 at most, those that did
not .23 at least. Of Freiburg's building 079, on which nothing was chosen, the corrected log has .07
and its scans matched anew, which tears it, .30.
"""

UNSURE = 0.025
"""The share from which on a map whose loops nothing confirms is not believed to be closed."""

REACH = 20.0  # metres beyond which beams end too far from one another
NEAR = 0.2  # metres from a beam's end within which a wall must stand
SHORT = 0.3  # metres before its end within which a beam may graze a wall
STEP = 0.1  # metres between the points of a beam that are looked at
MOST_SCANS = 400  # that are looked at, evenly


Verdict = Literal["closed", "open", "torn", "unknown"]
"""closed: it came back to places, and its poses say so; open: it never came back; torn: it came
back, and its poses say otherwise; unknown: nobody can tell which."""


def verdict(share: float, found: Revisits) -> Verdict:
    """Say whether a map closes, from the share of beams that contradict it and from its loops."""
    if share > TORN or found.tears:
        return "torn"
    if found.closed:
        return "closed"
    return "unknown" if found.unconfirmed and share > UNSURE else "open"


def contradicted(scans: Sequence[Placed], map_: OccupancyMap) -> float:
    """Return the share of beams that contradict a map, from 0 to 1.

    A beam does where no wall stands within `NEAR` of its end, or where it goes through one.
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
        ends, start = placed(points, one.pose), np.array([one.pose.x, one.pose.y])
        length = np.hypot(points[:, 0], points[:, 1])
        along = np.arange(STEP, REACH, STEP)
        on_way = start + (ends - start)[:, None, :] * (along / length[:, None])[..., None]
        before = along[None, :] < length[:, None] - SHORT
        missing = _at(far, ends, map_) > NEAR
        through = ((_at(far, on_way, map_) == 0) & before).any(axis=1)
        beams += len(points)
        against += int((missing | through).sum())
    return against / beams if beams else 0.0


def _at(far: Floats, points: Floats, map_: OccupancyMap) -> Floats:
    """Return how far from a wall points (..., 2) lie, in metres; those off the map: NaN."""
    cells = np.floor((points - map_.origin) / map_.resolution).astype(np.intp)
    rows, columns = cells[..., 1], cells[..., 0]
    inside = (rows >= 0) & (columns >= 0) & (rows < far.shape[0]) & (columns < far.shape[1])
    found = np.full(rows.shape, np.nan)
    found[inside] = far[rows[inside], columns[inside]]
    return found
