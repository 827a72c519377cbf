"""Vectorised operations on particles (n, 3): motion model, KLD sampling, resampling, clustering."""

from __future__ import annotations

from math import atan2, hypot, pi, sqrt

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from tangy_hw.device_protocols import Pose
from tangy_hw.navigation.poses import Floats, wrap

ALPHA = 0.2  # all four alphas of the odometry model: squared error for each squared unit moved
WHOLE = 0.1  # metres and radians: a longer step has the error of several steps
FEWEST, MOST = 300, 600
BIN, BIN_ANGLE = 0.5, pi / 18  # metres and radians of a bin of the KLD histogram
ERROR, QUANTILE = 0.05, 2.33  # bound on the KL divergence, and normal quantile of probability .99
MOST_BINS = 1 << 16  # that are counted without being sorted first, which is faster
CLUSTER, CLUSTER_ANGLE = 0.6, 0.6  # metres and radians around a pose that belong to its cluster


def move(particles: Floats, step: Pose, rng: Generator, alpha: float = ALPHA) -> Floats:
    """Move particles (n, 3) by an odometry step (m, rad) with noise (Thrun et al., table 5.6).

    The variance of the noise grows with the square of steps up to `WHOLE`, and in proportion to the
    length of longer ones, because errors along a long way partly cancel.
    """
    distance = hypot(step.x, step.y)
    first = atan2(step.y, step.x) if distance > 0.01 else 0.0
    last = wrap(step.heading - first)
    # driving backwards is not a turn by pi
    turned = _errs(min(abs(first), abs(wrap(first - pi))))
    turned_last = _errs(min(abs(last), abs(wrap(last - pi))))
    n, square = len(particles), _errs(distance)
    noise = rng.standard_normal((3, n))
    way = distance + sqrt(alpha * (square + turned + turned_last)) * noise[0]
    heading = particles[:, 2] + first + sqrt(alpha * (turned + square)) * noise[1]
    ends = heading + last + sqrt(alpha * (turned_last + square)) * noise[2]
    return np.column_stack(
        (
            particles[:, 0] + way * np.cos(heading),
            particles[:, 1] + way * np.sin(heading),
            wrap(ends),
        )
    )


def moved(poses: Floats, step: Pose) -> Floats:
    """Return poses (n, 3) moved by an odometry step (m, rad) without noise."""
    heading = poses[:, 2]
    cos, sin = np.cos(heading), np.sin(heading)
    there = np.empty_like(poses)
    there[:, 0] = poses[:, 0] + cos * step.x - sin * step.y
    there[:, 1] = poses[:, 1] + sin * step.x + cos * step.y
    there[:, 2] = wrap(heading + step.heading)
    return there


def _errs(moved: float) -> float:
    """Return the effective square of a step in m, or of a turn in rad."""
    return moved * min(moved, WHOLE)


def around(
    pose: Pose, deviations: tuple[float, float, float], count: int, rng: Generator
) -> Floats:
    """Draw particles (n, 3) around a pose; standard deviations in m and rad."""
    drawn: Floats = np.asarray(pose) + rng.standard_normal((count, 3)) * np.asarray(deviations)
    drawn[:, 2] = wrap(drawn[:, 2])
    return drawn


def _bins(particles: Floats, angle: float) -> NDArray[np.int64]:
    """Return the bin of each particle (n, 3), `BIN` m wide and long and `angle` rad in heading."""
    x, y, heading = np.floor(np.ascontiguousarray((particles / (BIN, BIN, angle)).T))
    columns, headings = y.max() - y.min() + 1, heading.max() - heading.min() + 1
    bins = ((x - x.min()) * columns + (y - y.min())) * headings + (heading - heading.min())
    return np.asarray(bins.astype(np.int64))


def needed(particles: Floats) -> int:
    """Return how many particles the spread of (n, 3) requires (KLD sampling; D. Fox, 2003)."""
    bins = np.sort(_bins(particles, BIN_ANGLE))
    k = 1 + np.count_nonzero(bins[1:] != bins[:-1])
    if k < 2:
        return FEWEST
    a = 2.0 / (9.0 * (k - 1))
    return int(np.clip((k - 1) / (2 * ERROR) * (1 - a + sqrt(a) * QUANTILE) ** 3, FEWEST, MOST))


def resample(particles: Floats, weights: Floats, count: int, rng: Generator) -> Floats:
    """Draw from particles (n, 3) in proportion to weights (n,) (low-variance sampling)."""
    if count == 0:
        return particles[:0]
    at = (np.arange(count) + rng.random()) / count
    chosen = np.searchsorted(np.cumsum(weights), at)
    return particles.take(np.minimum(chosen, len(particles) - 1), axis=0)


def _mean(rows: Floats, weights: Floats) -> Pose:
    """Return the weighted mean of poses: x, y, and sine and cosine of the heading (4, n)."""
    x, y, sin, cos = (rows @ weights / weights.sum()).tolist()
    return Pose(x, y, atan2(sin, cos))


def near(particles: Floats, pose: Pose) -> NDArray[np.bool_]:
    """Return which of the particles (n, 3) belong to the cluster around a pose."""
    x, y, heading = (particles - np.asarray(pose)).T
    turned = np.abs(heading)  # below 2 pi, as both headings are wrapped
    turns = (turned < CLUSTER_ANGLE) | (turned > 2 * pi - CLUSTER_ANGLE)
    return np.asarray((x * x + y * y < CLUSTER**2) & turns)


def likeliest(particles: Floats, weights: Floats) -> tuple[Pose, Floats]:
    """Return the mean of the most likely cluster of particles, and its covariance (3, 3)."""
    bins = _bins(particles, pi / 6)
    if bins.max() > MOST_BINS:
        _, bins = np.unique(bins, return_inverse=True)
    inside = bins == np.argmax(np.bincount(bins, weights))
    headings = particles[:, 2]
    rows = np.vstack((particles[:, :2].T, np.sin(headings), np.cos(headings)))
    guess = _mean(rows, weights * inside)
    for _ in range(2):
        before, inside = inside, near(particles, guess)
        if not inside.any() or np.array_equal(before, inside):
            break
        guess = _mean(rows, weights * inside)
    offs = particles[inside] - np.asarray(guess)
    offs[:, 2] = wrap(offs[:, 2])
    share = weights[inside] / weights[inside].sum() if inside.any() else weights[inside]
    return guess, np.asarray((offs * share[:, None]).T @ offs)
