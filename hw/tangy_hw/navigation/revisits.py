"""Finds revisited places, and checks whether the poses agree there.

A scan is matched with older scans that may show the same place, given the possible odometry drift
between them. If it matches one in both directions of the floor, both were taken at one place. If
the poses agree, the loop is closed; if not, it is torn, even if no beam contradicts the map,
because the two copies of a corridor can lie apart.

The limits were chosen on simulated corridors, rooms and rows of rooms (6 seeds of each of 6 shapes,
with and without wheels that slip for 6% of the way). Together with those of `agreement`, they
accept 35 of 36 maps of other seeds that close, and reject 33 of 36 that are torn; the one wrongly
rejected is a building whose parts look alike. On Freiburg's building 079, 43 scans agree and none
disagrees in the corrected log; newly matched, 9 agree and 13 disagree.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot
from typing import NamedTuple

import numpy as np

from tangy_hw.device_protocols import Pose
from tangy_hw.navigation.mapping import PlacedScan
from tangy_hw.navigation.poses import Floats, compose, relative_pose
from tangy_hw.navigation.scan_matching import Reference

LOOP = 8.0  # metres driven between two scans that can close a loop
EVERY = 0.5  # metres between the checked scans
ASTRAY = 0.2  # of the way driven in between: how much the poses may drift
FARTHEST = 8.0  # metres of drift at most
FITS = 0.85  # share of points that must match
FULLY = 1.5  # trace of the observable directions: both directions of the floor
AGREES, DISAGREES = 0.3, 0.6  # metres between the poses and the match


MOST, NEAREST, CANDIDATES = 400, 12, 40  # checked scans; older candidates for each, near and far
SURE = 2  # torn places after the last closed one that make the map torn


class LoopClosure(NamedTuple):
    """A revisited place: two scans by number, and the step between them.

    `step` is the result of matching, `off` its distance in m from the later scan's pose.
    """

    earlier: int
    later: int
    step: Pose
    off: float


@dataclass(frozen=True)
class Revisits:
    """The revisited places: those where the poses agree (`closed`), and disagree (`torn`).

    `off` is the median distance, in m, between the poses and the matches of torn places, `last` the
    number of torn places after the last closed one, and `crossed` how often the robot came back
    according to its poses. `loops` are all revisited places, torn or not.
    """

    closed: int = 0
    torn: int = 0
    off: float = 0.0
    last: int = 0
    crossed: int = 0
    loops: tuple[LoopClosure, ...] = ()

    @property
    def tears(self) -> bool:
        """Whether the loops as a whole are torn.

        New scans that resemble earlier ones count as torn until the robot is back at a known place;
        so torn ones must outnumber closed ones, or come last.
        """
        return self.torn > self.closed or self.last >= SURE

    @property
    def unconfirmed(self) -> bool:
        """Whether the robot came back, and no scan matches the earlier ones there."""
        return not self.closed and self.crossed >= SURE


def revisits(scans: Sequence[PlacedScan]) -> Revisits:
    """Check every place that the robot may have revisited."""
    places = np.array([(one.pose.x, one.pose.y) for one in scans]).reshape(-1, 2)
    way = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(places, axis=0).T))))
    chosen = _every(way[: len(scans)])
    references = {i: Reference(scans[i].scan) for i in chosen}
    closed, last, crossed, offs = 0, 0, 0, list[float]()
    loops: list[LoopClosure] = []
    for later in chosen[:: 1 + len(chosen) // MOST]:
        loop = _loop(scans, places, way, references, later, chosen)
        off = None if loop is None else loop.off
        loops += [] if loop is None else [loop]
        older = chosen[: int(np.searchsorted(way[chosen], way[later] - LOOP, side="right"))]
        crossed += bool((np.hypot(*(places[older] - places[later]).T) <= EVERY).any())
        if off is not None and off <= AGREES:
            closed, last = closed + 1, 0
        elif off is not None and off >= DISAGREES:
            offs.append(off)
            last += 1
    middle = float(np.median(offs)) if offs else 0.0
    return Revisits(closed, len(offs), middle, last, crossed, tuple(loops))


def _every(way: Floats) -> list[int]:
    """Return the numbers of scans that are `EVERY` m of the way apart."""
    chosen = [0] if len(way) else []
    for number, at in enumerate(way):
        if at - way[chosen[-1]] >= EVERY:
            chosen.append(number)
    return chosen


def _loop(
    scans: Sequence[PlacedScan],
    places: Floats,
    way: Floats,
    references: dict[int, Reference],
    later: int,
    chosen: Sequence[int],
) -> LoopClosure | None:
    """Return the loop that a scan closes with an older one; None if there is none."""
    best: tuple[float, LoopClosure] | None = None
    one = scans[later]
    driven = way[later] - way[chosen]
    apart = np.hypot(*(places[chosen] - places[later]).T)
    near = (driven >= LOOP) & (apart <= np.minimum(ASTRAY * driven, FARTHEST))
    candidates = np.flatnonzero(near)[np.argsort(apart[near], kind="stable")]
    spread = candidates[NEAREST :: 1 + len(candidates) // CANDIDATES]
    for candidate in (*candidates[:NEAREST], *spread):
        earlier = chosen[candidate]
        told = relative_pose(scans[earlier].pose, one.pose)
        guesses = [Pose(0.0, 0.0, told.heading)] + ([told] if apart[candidate] < 1.0 else [])
        for guess in guesses:
            match = references[earlier].match(one.scan, guess)
            if match.fits < FITS or np.trace(match.told) < FULLY:
                continue
            if hypot(match.pose.x, match.pose.y) > 2 * EVERY:
                continue  # the match is at another place
            found = compose(scans[earlier].pose, match.pose)
            off = hypot(found.x - one.pose.x, found.y - one.pose.y)
            loop = LoopClosure(earlier, later, match.pose, off)
            if off <= AGREES:
                return loop
            if best is None or match.fits > best[0]:
                best = match.fits, loop
    return None if best is None else best[1]
