"""A map of a log, judged: do its loops close, and if not, does a graph of poses close them?"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tangy_hw.navigation.agreement import Verdict, contradicted, verdict
from tangy_hw.navigation.mapping import Placed, map_of_scans
from tangy_hw.navigation.occupancy import OccupancyMap
from tangy_hw.navigation.pose_graph import close_loops
from tangy_hw.navigation.revisits import Revisits, revisits

BETTER = 0.7
"""Share of the contradicted beams that may be left once loops are closed.

Where wheels slipped along a bare corridor, nothing tells where, and loops that were closed bend the
map without contradicting it less. Both limits were chosen on simulated corridors; in Freiburg's
building 079, on which nothing was chosen, .30 are left.
"""
SLIPPED = 0.015
"""Share of the way driven from which on a correction is no drift: the wheels slipped somewhere."""
CLOSED_PER_TORN = 3
"""Loops that must close for each that stays torn, as a place that only looks alike does."""
TRIES = 2
"""How often loops are looked for and closed."""


class JudgedMap(NamedTuple):
    """A map and its scans; the share of beams that contradict it, its loops, and the verdict."""

    scans: Sequence[Placed]
    map: OccupancyMap
    share: float
    found: Revisits
    closes: Verdict
    by_graph: bool = False
    """Whether a graph of poses closed its loops."""


def judged(scans: Sequence[Placed], resolution: float) -> JudgedMap:
    """Draw the map of scans at cells of so many metres, and judge it."""
    map_ = map_of_scans(scans, resolution)
    share, found = contradicted(scans, map_), revisits(scans)
    return JudgedMap(scans, map_, share, found, verdict(share, found))


def with_loops_closed(drawn: JudgedMap, resolution: float) -> JudgedMap:
    """Return the map with its loops closed, or as it was where that does not make it better.

    Args:
        drawn: the map, judged.
        resolution: of the map, in metres to a cell.
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
    """Return how far the scan that moved most did, as a share of the way."""
    old, new = (np.array([one.pose[:2] for one in drawn.scans]) for drawn in (before, after))
    way = np.hypot(*np.diff(old, axis=0).T).sum()
    return float(np.hypot(*(new - old).T).max() / way) if way else 0.0
