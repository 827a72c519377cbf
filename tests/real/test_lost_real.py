"""Global localisation: a robot without a start pose finds its place on a map."""

from __future__ import annotations

from math import hypot
from pathlib import Path

import pytest

from tangy_hw.navigation.map_files import write_map
from tangy_hw.navigation.occupancy import map_of_room
from tangy_profiles.fault_file import load_faults
from tangy_tui.app.robot_opening import open_bench
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.app.workspace import Workspace

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("robot")]
FOUND = 0.15  # metres of error allowed


@pytest.mark.parametrize("seed", [5, 9])
def test_a_robot_without_a_start_pose_localises_and_drives_to_the_front(
    workspace: Workspace, tmp_path: Path, seed: int
) -> None:
    map_ = tmp_path / "room.yaml"
    write_map(map_of_room(workspace.room, people=4), map_)
    book = load_faults(workspace.robot)
    with open_bench(
        workspace, seed=seed, stepped=True, book=book, kind=BenchedWorld, map_=str(map_), lost=True
    ) as world:
        assert world.lost
        world.bench.do("inject", kind="carried-off")  # to anywhere in the room
        world.begin()
        assert not world.lost
        x, y, _ = world.truth()["pose"]
        believed = world.link.beat().pose
        assert hypot(believed.x - x, believed.y - y) < FOUND
        assert hypot(workspace.room.front.x - x, workspace.room.front.y - y) < 0.5
