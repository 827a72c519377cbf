"""Localisation on a log of a real robot, and beside MRPT's on the same scans.

The log is Freiburg's building 079; TANGY_LASER_LOG names the folder with freiburg-079.log.gz.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from tangy_hw.navigation.localisation import Localisation
from tests.bench.localisation import (
    FOLDER,
    Moment,
    building,
    disagreements,
    doubts,
    errors,
    kidnapped,
    logged,
    moments,
)
from tests.real.mrpt_localisation import PROGRAMS, mrpt_errors

SEEDS = range(700, 705)

pytestmark = [
    pytest.mark.slow,
    pytest.mark.elsewhere,
    pytest.mark.skipif(
        not (Path(os.environ.get(FOLDER, "")) / "freiburg-079.log.gz").is_file(),
        reason=f"{FOLDER} names no folder with freiburg-079.log.gz",
    ),
]


@pytest.fixture(scope="module")
def folder() -> str:
    return os.environ[FOLDER]


@pytest.fixture(scope="module")
def way(folder: str) -> Sequence[Moment]:
    """The scans that the map was not drawn from."""
    return moments(logged(folder))[1::2]


def followed(folder: str, way: Sequence[Moment], seed: int) -> list[float]:
    localisation = Localisation(building(folder), np.random.default_rng(seed), way[0].truth)
    return [off for off, _, _ in errors(localisation, way)]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_real_robot_is_localised(seed: int, folder: str, way: Sequence[Moment]) -> None:
    median, high = np.percentile(followed(folder, way, seed), [50, 95])
    assert median <= 0.06 and high <= 0.15


def test_an_undisturbed_robot_is_never_reported_lost(folder: str, way: Sequence[Moment]) -> None:
    localisation = Localisation(building(folder), np.random.default_rng(700), way[0].truth)
    assert doubts(localisation, way) == 0


def test_nine_of_ten_kidnapped_robots_localise_again(folder: str, way: Sequence[Moment]) -> None:
    found = [kidnapped(building(folder), way, seed) for seed in range(800, 810)]
    assert sum(scans is not None and scans <= 400 for scans in found) >= 9


def test_odometry_with_the_wrong_sign_is_noticed(folder: str) -> None:
    log = logged(folder)
    assert max(disagreements(moments(log, restored=False))) > 0.3
    assert max(disagreements(moments(log))) <= 0.3


@pytest.mark.skipif(
    any(shutil.which(program) is None for program in PROGRAMS),
    reason="MRPT is not installed (Debian's mrpt-apps)",
)
def test_the_error_is_close_to_that_of_mrpt_or_below(
    folder: str, way: Sequence[Moment], tmp_path: Path
) -> None:
    theirs = np.percentile(mrpt_errors(building(folder), way, tmp_path), [50, 95])
    ours = np.percentile(followed(folder, way, SEEDS[0]), [50, 95])
    assert ours[0] <= 1.1 * theirs[0] and ours[1] <= 1.25 * theirs[1]
