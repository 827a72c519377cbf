"""Poses of a log's scans by matching, where the log has only the wheels' own.

Each scan is matched with the ones that were taken near it before, the oldest first, so that a robot
that comes back to where it was finds itself there again. That takes away the small errors that add
up; a large loop, around which the wheels went far astray, is closed by `pose_graph`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import hypot

import numpy as np

from tangy_hw.device_protocols import Pose
from tangy_hw.navigation.mapping import Placed
from tangy_hw.navigation.poses import between, compose, wrap
from tangy_hw.navigation.scan_matching import Reference

NEAR = 3.0  # metres within which earlier scans are matched with
JOINED = 6  # of those, half of them the oldest and half the newest
FITS, GOOD = 0.5, 0.75  # shares of points that must fit, and that need no second try
TRIED = (-0.4, -0.2, 0.2, 0.4)  # radians by which the guess is turned for that
FARTHEST, TURNED = 0.5, 0.6  # metres and radians by which a match may differ from the wheels


def aligned(scans: Sequence[Placed], tell: Callable[[int], None] | None = None) -> list[Placed]:
    """Return the scans at the poses at which they fit one another.

    Args:
        scans: with the poses that the wheels counted, some 10 cm from one to the next.
        tell: called with the number of scans done.
    """
    found: list[Placed] = []
    references: list[Reference] = []
    places = np.zeros((len(scans), 2))
    for number, one in enumerate(scans):
        pose = one.pose
        if found:
            guess = compose(found[-1].pose, between(scans[number - 1].pose, one.pose))
            pose = _matched(one, guess, found, references, places[:number])
        found.append(Placed(one.scan, pose))
        references.append(Reference(one.scan))
        places[number] = pose.x, pose.y
        if tell is not None:
            tell(number + 1)
    return found


def _matched(
    one: Placed,
    guess: Pose,
    found: Sequence[Placed],
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
    if match.fits < GOOD:  # wheels are worst at telling how far they turned
        turns = (Pose(guess.x, guess.y, wrap(guess.heading + turn)) for turn in TRIED)
        others = [joined.match(one.scan, turn) for turn in turns]
        match = max((match, *others), key=lambda each: each.fits)
    off = hypot(match.pose.x - guess.x, match.pose.y - guess.y)
    turned = abs(wrap(match.pose.heading - guess.heading))
    if match.fits < FITS or off > FARTHEST or turned > TURNED:
        return guess
    return match.pose
