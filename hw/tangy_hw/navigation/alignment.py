"""Finds the poses of logged scans by scan matching if the log has wheel odometry only.

Each scan is matched with earlier scans nearby, the oldest among them, so that a robot that revisits
a place gets the same pose there again. This removes small accumulated errors; `pose_graph` closes
large loops with more drift.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import hypot

import numpy as np

from tangy_hw.device_protocols import Pose
from tangy_hw.navigation.mapping import PlacedScan
from tangy_hw.navigation.poses import compose, relative_pose, wrap
from tangy_hw.navigation.scan_matching import Reference

NEAR = 3.0  # metres within which earlier scans are matched
JOINED = 6  # earlier scans to match with: half the oldest, half the newest
FITS, GOOD = 0.5, 0.75  # shares of points: a match needs FITS; below GOOD, turned guesses are tried
TRIED = (-0.4, -0.2, 0.2, 0.4)  # radians, rotations of those guesses
FARTHEST, TURNED = 0.5, 0.6  # metres and radians that a match may differ from odometry


def aligned(
    scans: Sequence[PlacedScan], tell: Callable[[int], None] | None = None
) -> list[PlacedScan]:
    """Return the scans at poses at which they match one another.

    Args:
        scans: the scans with odometry poses, some 10 cm apart.
        tell: called with the number of scans done so far.
    """
    found: list[PlacedScan] = []
    references: list[Reference] = []
    places = np.zeros((len(scans), 2))
    for number, one in enumerate(scans):
        pose = one.pose
        if found:
            guess = compose(found[-1].pose, relative_pose(scans[number - 1].pose, one.pose))
            pose = _matched(one, guess, found, references, places[:number])
        found.append(PlacedScan(one.scan, pose))
        references.append(Reference(one.scan))
        places[number] = pose.x, pose.y
        if tell is not None:
            tell(number + 1)
    return found


def _matched(
    one: PlacedScan,
    guess: Pose,
    found: Sequence[PlacedScan],
    references: Sequence[Reference],
    places: np.ndarray[tuple[int, ...], np.dtype[np.float64]],
) -> Pose:
    near = np.flatnonzero(np.hypot(places[:, 0] - guess.x, places[:, 1] - guess.y) < NEAR)
    half = JOINED // 2
    chosen = near if len(near) <= JOINED else np.concatenate((near[:half], near[-half:]))
    if not len(chosen):
        return guess
    joined = Reference.joined([(references[i], found[i].pose) for i in chosen])
    match = joined.match(one.scan, guess)
    if match.fits < GOOD:  # odometry is worst at rotation
        turns = (Pose(guess.x, guess.y, wrap(guess.heading + turn)) for turn in TRIED)
        others = [joined.match(one.scan, turn) for turn in turns]
        match = max((match, *others), key=lambda each: each.fits)
    off = hypot(match.pose.x - guess.x, match.pose.y - guess.y)
    turned = abs(wrap(match.pose.heading - guess.heading))
    if match.fits < FITS or off > FARTHEST or turned > TURNED:
        return guess
    return match.pose
