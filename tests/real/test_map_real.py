"""A log of a real building, from odometry poses: its loops are closed."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tangy_hw.navigation.alignment import aligned
from tangy_hw.navigation.mapping import PlacedScan, sparse
from tangy_hw.navigation.matched_map import judged, with_loops_closed
from tangy_hw.navigation.scan_log import read_log

LOG = Path(os.environ.get("TANGY_LASER_LOG", "")) / "freiburg-079.log.gz"
RESOLUTION = 0.05


@pytest.mark.slow
@pytest.mark.elsewhere
@pytest.mark.skipif(not LOG.is_file(), reason="TANGY_LASER_LOG names no folder with the log")
def test_a_map_that_scan_matching_tears_is_closed_by_the_pose_graph() -> None:
    scans = sparse(PlacedScan(one.scan, one.odometry) for one in read_log(LOG))
    before = judged(aligned(scans), RESOLUTION)
    after = with_loops_closed(before, RESOLUTION)
    assert before.closes == "torn"
    assert after.closes == "closed" and after.by_graph and not after.found.torn
