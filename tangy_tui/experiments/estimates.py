"""Numbers said with how sure they are: mean, deviation and standard error over n."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, sqrt
from statistics import fmean, median, stdev
from typing import Any


def summary(values: Sequence[float]) -> dict[str, Any]:
    """Return n, mean, standard deviation (of the sample) and standard error of the mean."""
    n = len(values)
    sd = stdev(values) if n > 1 else 0.0
    return {"n": n, "mean": fmean(values) if n else None, "sd": sd, "se": sd / sqrt(n) if n else 0}


def share_of(flags: Sequence[bool]) -> float | None:
    """Return the share of what is true, or None of nothing."""
    return sum(flags) / len(flags) if flags else None


def share_interval(share: float, n: int) -> tuple[float, float]:
    """Return the 95% interval of a share seen in n tries (Wilson), which never leaves [0, 1]."""
    z = 1.96
    middle = (share + z * z / (2 * n)) / (1 + z * z / n)
    half = z * sqrt(share * (1 - share) / n + z * z / (4 * n * n)) / (1 + z * z / n)
    return max(0.0, min(share, middle - half)), min(1.0, max(share, middle + half))


def spread(values: Sequence[float]) -> dict[str, Any]:
    """Return n, the median, and the quantile that 95% do not exceed (None of nothing)."""
    ordered = sorted(values)
    if not ordered:
        return {"n": 0, "median": None, "p95": None}
    at = ceil(0.95 * len(ordered)) - 1
    return {"n": len(ordered), "median": median(ordered), "p95": ordered[at]}
