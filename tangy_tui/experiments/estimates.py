"""Summary statistics: mean, standard deviation and standard error over n."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, sqrt
from statistics import fmean, median, stdev
from typing import Any

from tangy_tui.monitoring.scoring import share_interval as share_interval


def summary(values: Sequence[float]) -> dict[str, Any]:
    """Return n, mean, sample standard deviation and standard error of the mean."""
    n = len(values)
    sd = stdev(values) if n > 1 else 0.0
    return {"n": n, "mean": fmean(values) if n else None, "sd": sd, "se": sd / sqrt(n) if n else 0}


def share_of(flags: Sequence[bool]) -> float | None:
    """Return the share of true values, or None without values."""
    return sum(flags) / len(flags) if flags else None


def spread(values: Sequence[float]) -> dict[str, Any]:
    """Return n, the median, and the 95% quantile (None without values)."""
    ordered = sorted(values)
    if not ordered:
        return {"n": 0, "median": None, "p95": None}
    at = ceil(0.95 * len(ordered)) - 1
    return {"n": len(ordered), "median": median(ordered), "p95": ordered[at]}
