"""Scan matching: how the robot moved between two scans, from the walls alone.

Iterative closest point with point-to-line distances (A. Censi, 2008). Along a bare corridor, a scan
does not show how far the robot went: directions that the walls do not constrain stay as guessed,
and the result says which.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from tangy_hw.device_protocols import Pose, Scan
from tangy_hw.navigation.poses import IDENTITY, Floats, endpoints, lengths, transform_points, wrap

REACH = 12.0  # metres beyond which points are too sparse
POINTS = 120  # of a scan to match
STRAIGHT = 0.03  # metres that a point may be off the line through its neighbours
GAP = 0.4  # metres between neighbouring points on one wall
RINGS = (0.5, 0.35, 0.25, 0.15, 0.1, 0.1)  # metres to a matching point, in each iteration
FITS = 0.05  # metres off its line within which a point matches
TOLD = 0.04  # mean square of normals along a direction that makes it observable


@dataclass(frozen=True, eq=False)
class ScanMatch:
    """Match of a scan with an earlier one.

    `pose` is the scan's pose relative to the earlier one, `fits` the share of points that match,
    and `told` (2, 2) projects planar steps onto the observable directions.
    """

    pose: Pose
    fits: float
    told: Floats


class Reference:
    """A scan that others are matched with."""

    def __init__(self, scan: Scan | None, laser: Pose = IDENTITY) -> None:
        points = np.zeros((0, 2)) if scan is None else endpoints(scan, REACH, laser)
        self._take(*_lines(points))

    @classmethod
    def joined(cls, parts: Sequence[tuple[Reference, Pose]]) -> Reference:
        """Join scans at their poses into one reference."""
        made = cls(None)
        made._take(
            np.vstack([transform_points(part._points, pose) for part, pose in parts]),
            np.vstack(
                [transform_points(part._normals, Pose(0, 0, pose.heading)) for part, pose in parts]
            ),
        )
        return made

    def _take(self, points: Floats, normals: Floats) -> None:
        self._points, self._normals = points, normals
        self._tree = cKDTree(points) if len(points) else None

    def match(self, scan: Scan, guess: Pose, laser: Pose = IDENTITY) -> ScanMatch:
        """Find the relative pose of another scan, starting from a guess."""
        points = endpoints(scan, REACH, laser)
        if len(points) > POINTS:
            points = points[np.linspace(0, len(points) - 1, POINTS).round().astype(np.intp)]
        if self._tree is None or len(points) < 20:
            return ScanMatch(guess, 0.0, np.zeros((2, 2)))
        pose, hessian = guess, np.zeros((3, 3))
        for ring in RINGS:
            moved = transform_points(points, pose)
            far, partner = self._tree.query(moved, distance_upper_bound=ring)
            near = np.isfinite(far)
            if near.sum() < 10:
                return ScanMatch(guess, 0.0, np.zeros((2, 2)))
            normals, at = self._normals[partner[near]], moved[near]
            off = ((at - self._points[partner[near]]) * normals).sum(axis=1)
            arm = at - np.array([pose.x, pose.y])
            lever = normals[:, 1] * arm[:, 0] - normals[:, 0] * arm[:, 1]
            jacobian = np.column_stack((normals, lever))
            weight = 1.0 / (1.0 + (off / FITS) ** 2)
            hessian = (jacobian * weight[:, None]).T @ jacobian / weight.sum()
            step = _solve(hessian, (jacobian * weight[:, None]).T @ off / weight.sum())
            pose = Pose(pose.x - step[0], pose.y - step[1], wrap(pose.heading - step[2]))
        return ScanMatch(pose, self._fits(points, pose), _told(hessian))

    def _fits(self, points: Floats, pose: Pose) -> float:
        moved = transform_points(points, pose)
        tree = self._tree
        if tree is None:
            return 0.0
        far, partner = tree.query(moved, distance_upper_bound=0.3)
        near = np.isfinite(far)
        off = ((moved[near] - self._points[partner[near]]) * self._normals[partner[near]]).sum(
            axis=1
        )
        return float((np.abs(off) < FITS).sum() / len(points))


def _lines(points: Floats) -> tuple[Floats, Floats]:
    """Return the points that lie on a line with their neighbours, and their normals."""
    if len(points) < 5:
        return points[:0], points[:0]
    before, middle, after = points[:-4], points[2:-2], points[4:]
    along = after - before
    length = np.maximum(lengths(along), 1e-9)
    normals = np.column_stack((-along[:, 1], along[:, 0])) / length[:, None]
    off = np.abs(((middle - before) * normals).sum(axis=1))
    steps = lengths(np.diff(points, axis=0))
    widest = np.max([steps[i : len(steps) - 3 + i] for i in range(4)], axis=0)
    good = (off < STRAIGHT) & (widest < GAP) & (length > 0.02)
    return middle[good], normals[good]


def _directions(matrix: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    values, vectors = np.linalg.eigh(matrix)
    return np.asarray(vectors), np.asarray(values > TOLD)


def _solve(hessian: Floats, gradient: Floats) -> tuple[float, float, float]:
    """Solve for the step in the observable directions; it is zero in the others."""
    # eliminate the rotation first (Schur complement)
    if hessian[2, 2] < 1e-6:
        turn = np.zeros(2)
        left = 0.0
    else:
        turn = hessian[:2, 2] / hessian[2, 2]
        left = gradient[2] / hessian[2, 2]
    floor = hessian[:2, :2] - np.outer(turn, hessian[:2, 2])
    vectors, told = _directions(floor)
    basis = vectors[:, told]
    step = np.zeros(2)
    if basis.size:
        step = basis @ np.linalg.solve(
            basis.T @ floor @ basis, basis.T @ (gradient[:2] - turn * gradient[2])
        )
    return float(step[0]), float(step[1]), float(left - turn @ step)


def _told(hessian: Floats) -> Floats:
    turn = hessian[:2, 2] / max(hessian[2, 2], 1e-6)
    vectors, told = _directions(hessian[:2, :2] - np.outer(turn, hessian[:2, 2]))
    basis = vectors[:, told]
    return np.asarray(basis @ basis.T)
