"""A drive by hand on the bench: recorded, matched and drawn as a map."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from tangy_hw.navigation.alignment import aligned
from tangy_hw.navigation.mapping import PlacedScan
from tangy_hw.navigation.matched_map import judged
from tangy_hw.navigation.occupancy import OCCUPIED
from tangy_hw.navigation.scan_log import read_log
from tangy_hw.robot_client.client import RobotLink
from tangy_profiles.room import load_room
from tangy_tui.app.device_simulator import DeviceSimulator
from tests.real.bench_setup import setup_on
from tests.support.waiting import wait_until

ROOM = load_room()
OFF = 0.15  # m that a wall of the map may be off

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("robot")]


def test_the_map_of_a_drive_by_hand_has_the_walls_of_the_room(tmp_path: Path) -> None:
    log = tmp_path / "a-scans.log"
    bench = DeviceSimulator(
        seed=3, people={"user1": "Rosa"}, stepped=False, activity="bingo", robot="tangy"
    )
    link = RobotLink(replace(setup_on(bench), record=str(log)))
    try:
        link.start()

        def recorded(forward: float, scans: int) -> bool:
            """Drive on for a moment by keys; return the progress."""
            link.tell("drive", forward=forward, turn=0.6)
            return link.state.number > 0 and len(log.read_text().splitlines()) > scans

        for forward, scans in ((0.0, 25), (0.3, 50), (0.0, 75)):
            wait_until(partial(recorded, forward, scans))
        assert not link.state.hazard
    finally:
        link.close()
        bench.close()
    matched = aligned([PlacedScan(one.scan, one.odometry) for one in read_log(log)])
    drawn = judged(matched, 0.05).map
    occupied = np.argwhere(drawn.cells == OCCUPIED)
    points = np.array([drawn.point(row, column) for row, column in occupied])
    for side, wall in ((0, 0.0), (0, ROOM.width), (1, ROOM.depth)):
        near = np.abs(points[:, side] - wall) < OFF
        assert near.sum() > 20, f"the wall at {wall} m is in the map"
    inside = (points > -OFF) & (points < (ROOM.width + OFF, ROOM.depth + OFF))
    assert inside.all(axis=1).mean() > 0.95
