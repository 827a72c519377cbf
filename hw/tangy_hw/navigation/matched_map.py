"""Judges the map of a log: do its loops close, and if not, does a pose graph close them?"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tangy_hw.navigation.agreement import Verdict, contradicted, verdict
from tangy_hw.navigation.mapping import PlacedScan, map_of_scans
from tangy_hw.navigation.occupancy import OccupancyMap
from tangy_hw.navigation.pose_graph import close_loops
from tangy_hw.navigation.revisits import Revisits, revisits

BETTER = 0.7
"""Share of the contradicted beams that may be left after closing loops.

If wheels slipped along a bare corridor, no scan shows where, and closing the loops bends the map
without removing contradictions. Both limits were chosen on simulated corridors; on Freiburg's
building 079, which was not used for choosing, .30 are left.
"""
SLIPPED = 0.015
"""Share of the path length above which a correction is not drift: the wheels slipped."""
CLOSED_PER_TORN = 3
"""Closed loops required for each torn one, which may be a place that only looks alike."""
TRIES = 2
"""How often loops are searched and closed."""


class JudgedMap(NamedTuple):
    """A map and its scans, with the share of contradicted beams, the loops, and the verdict."""

    scans: Sequence[PlacedScan]
    map: OccupancyMap
    share: float
    found: Revisits
    closes: Verdict
    by_graph: bool = False
    """Whether a pose graph closed its loops."""


def judged(scans: Sequence[PlacedScan], resolution: float) -> JudgedMap:
    """Draw and judge the map of scans, with cells of `resolution` m."""
    map_ = map_of_scans(scans, resolution)
    share, found = contradicted(scans, map_), revisits(scans)
    return JudgedMap(scans, map_, share, found, verdict(share, found))


def with_loops_closed(drawn: JudgedMap, resolution: float) -> JudgedMap:
    """Return the map with its loops closed, or unchanged if that does not improve it.

    Args:
        drawn: the judged map.
        resolution: metres per cell.
    """
    best = drawn
    for _ in range(TRIES):
        if best.closes not in ("torn", "unknown") or not best.found.loops:
            break
        best = judged(close_loops(best.scans, best.found.loops), resolution)
    loops = best.found
    good = best.closes == "closed" and loops.closed >= CLOSED_PER_TORN * loops.torn
    if good and best.share <= BETTER * drawn.share and _corrected(drawn, best) < SLIPPED:
        return best._replace(by_graph=True)
    return drawn


def _corrected(before: JudgedMap, after: JudgedMap) -> float:
    """Return the largest correction of a scan's position, as a share of the path length."""
    old, new = (np.array([one.pose[:2] for one in drawn.scans]) for drawn in (before, after))
    way = np.hypot(*np.diff(old, axis=0).T).sum()
    return float(np.hypot(*(new - old).T).max() / way) if way else 0.0
