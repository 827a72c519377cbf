"""Closes loops with a pose graph (Lu and Milios, 1997).

Edges are the steps between successive scans, and the matches between scans of the same place.
Gauss-Newton distributes the odometry error over the path. Loops that still do not fit afterwards
are dropped: they join places that only look alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from tangy_hw.device_protocols import Pose
from tangy_hw.navigation.mapping import PlacedScan
from tangy_hw.navigation.poses import Floats, relative_pose, wrap
from tangy_hw.navigation.revisits import LoopClosure

STEP = (0.02, 0.02, 0.005)
"""Standard deviations (m, m, rad) of a matched step between successive scans."""
LOOP = (0.05, 0.05, 0.02)
"""Standard deviations (m, m, rad) of a match between two scans of the same place."""
ASTRAY = 10.0
"""Standard deviations of a residual above which a loop is dropped."""
ROUNDS, STEPS = 3, 12
"""Rounds of dropping loops, and Gauss-Newton iterations in each."""
DONE = 1e-4
"""Update in m or rad below which the iteration has converged."""

Ends: TypeAlias = NDArray[np.intp]
"""Numbers (n, 2) of the scans that edges join."""


def close_loops(scans: Sequence[PlacedScan], loops: Sequence[LoopClosure]) -> list[PlacedScan]:
    """Return the scans at the poses at which their steps and loops agree best.

    The first scan stays where it is.

    Args:
        scans: successive scans, at poses with drift.
        loops: the revisited places.
    """
    if len(scans) < 2 or not loops:
        return list(scans)
    poses = np.array([one.pose for one in scans])
    chain = np.arange(len(scans) - 1)
    ends = np.vstack(
        (np.column_stack((chain, chain + 1)), [(one.earlier, one.later) for one in loops])
    )
    steps = [relative_pose(a.pose, b.pose) for a, b in pairwise(scans)]
    told = np.array([*steps, *(one.step for one in loops)])
    spread = np.vstack((np.tile(STEP, (len(steps), 1)), np.tile(LOOP, (len(loops), 1))))
    kept = np.ones(len(ends), dtype=np.bool_)
    for _ in range(ROUNDS):
        poses = _solved(poses, ends[kept], told[kept], spread[kept])
        off = np.abs(_errors(poses, ends, told, spread)).max(axis=1)
        fits = (off < ASTRAY) | (np.arange(len(ends)) < len(steps))
        if (fits == kept).all():
            break
        kept = fits
    return [
        PlacedScan(one.scan, Pose(float(x), float(y), float(wrap(heading))))
        for one, (x, y, heading) in zip(scans, poses, strict=True)
    ]


def _solved(poses: Floats, ends: Ends, told: Floats, spread: Floats) -> Floats:
    """Return the poses (n, 3) at which the edges fit best (Gauss-Newton)."""
    for _ in range(STEPS):
        errors = _errors(poses, ends, told, spread).ravel()
        slopes = _slopes(poses, ends, spread)
        step = splu(csc_matrix(slopes.T @ slopes)).solve(-(slopes.T @ errors))
        poses = poses.copy()
        poses[1:] += step.reshape(-1, 3)
        if np.abs(step).max() < DONE:
            break
    return poses


def _errors(poses: Floats, ends: Ends, told: Floats, spread: Floats) -> Floats:
    """Return the residuals of the edges (n, 3), in standard deviations."""
    start, end = poses[ends[:, 0]], poses[ends[:, 1]]
    c, s = np.cos(start[:, 2]), np.sin(start[:, 2])
    x, y, turn = (end - start).T
    off = np.column_stack((c * x + s * y, c * y - s * x, turn)) - told
    off[:, 2] = wrap(off[:, 2])
    return np.asarray(off / spread)


def _slopes(poses: Floats, ends: Ends, spread: Floats) -> csc_matrix:
    """Return the Jacobian of the residuals (3 edges, 3 poses without the first)."""
    start, end = poses[ends[:, 0]], poses[ends[:, 1]]
    c, s = np.cos(start[:, 2]), np.sin(start[:, 2])
    x, y = (end - start)[:, :2].T
    nothing, one = np.zeros_like(c), np.ones_like(c)
    of_start = [[-c, -s, c * y - s * x], [s, -c, -c * x - s * y], [nothing, nothing, -one]]
    of_end = [[c, s, nothing], [-s, c, nothing], [nothing, nothing, one]]
    edges, axes = np.arange(len(ends)), range(3)
    values, rows, columns = list[Floats](), list[Ends](), list[Ends]()
    for side, slopes in enumerate((of_start, of_end)):
        for row in axes:
            for column in axes:
                values.append(slopes[row][column] / spread[:, row])
                rows.append(3 * edges + row)
                columns.append(3 * (ends[:, side] - 1) + column)
    value, of_error, of_pose = (
        np.concatenate(values),
        np.concatenate(rows),
        np.concatenate(columns),
    )
    free = of_pose >= 0
    return csc_matrix(
        (value[free], (of_error[free], of_pose[free])),
        shape=(3 * len(ends), 3 * (len(poses) - 1)),
    )
