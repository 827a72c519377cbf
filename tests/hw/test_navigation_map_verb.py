"""`tangy map`: rooms, logs and maps, drawn, written and printed as JSON."""

from __future__ import annotations

import json
from math import pi
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner, Result

from tangy_hw.device_protocols import Pose
from tangy_hw.navigation.map_files import read_map
from tangy_hw.navigation.poses import compose
from tangy_profiles.errors import TangyError
from tangy_profiles.room import load_room
from tangy_tui.verbs.map import draw_map
from tests.hw.raycast import look, room_sides

ROOM = load_room()


def tangy_map(*words: str | Path) -> Result:
    """Run the verb; errors of the user are raised."""
    app = typer.Typer()
    app.command()(draw_map)
    done = CliRunner().invoke(app, [str(word) for word in words], env={"COLUMNS": "80"})
    if isinstance(done.exception, TangyError):
        raise done.exception
    return done


def log_of_a_room(path: Path) -> Path:
    """Write the scans of a half-circle laser at some places in the room."""
    lines = []
    for number in range(24):
        pose = Pose(1.5 + 0.3 * number, 2.0, number * 0.5)
        scan = look(room_sides(ROOM), pose, beams=181, angle=pi)
        ranges = " ".join(f"{one:.3f}" for one in np.minimum(scan.ranges, 81.91))
        where = f"{pose.x} {pose.y} {pose.heading}"
        lines.append(f"FLASER 181 {ranges} {where} {where} {number} robot {number}\n")
    path.write_text("".join(lines))
    return path


def log_that_slips(path: Path, slip: Pose) -> Path:
    """Write scans of a robot that goes round a room twice, until its wheels slip."""
    lines = []
    places = [(1.5 + 0.2 * n, 1.5, 0.1 * n) for n in range(35)] * 2
    for number, (x, y, heading) in enumerate(places):
        scan = look(room_sides(ROOM), Pose(x, y, heading), beams=181, angle=pi)
        ranges = " ".join(f"{one:.3f}" for one in np.minimum(scan.ranges, 81.91))
        told = compose(slip, Pose(x, y, heading)) if number >= 35 else Pose(x, y, heading)
        where = f"{told.x} {told.y} {told.heading}"
        lines.append(f"FLASER 181 {ranges} {where} {where} {number} robot {number}\n")
    path.write_text("".join(lines))
    return path


class TestMap:
    @pytest.mark.slow
    def test_the_share_of_contradicting_beams_is_printed(self, tmp_path: Path) -> None:
        log = log_that_slips(tmp_path / "a.log", Pose(0.05, 0.05, 0.0))
        told = json.loads(tangy_map(log, "--match", "--json").stdout)
        assert told["matched"] and told["contradicted"] < 0.05
        shown = tangy_map(log, "--match").stdout
        assert f"{told['contradicted']:.0%} of the beams contradict the map" in shown

    @pytest.mark.slow
    def test_a_torn_map_is_refused_and_only_its_picture_written(self, tmp_path: Path) -> None:
        log, png = log_that_slips(tmp_path / "a.log", Pose(2.0, 1.5, 0.9)), tmp_path / "a.png"
        with pytest.raises(TangyError, match=r"the map does not close.* a\.png shows it"):
            tangy_map(log, "--match", "--png", png, "--yaml", tmp_path / "a.yaml")
        assert png.exists() and not (tmp_path / "a.yaml").exists()
        assert json.loads(tangy_map(log, "--json").stdout)["contradicted"] > 0.15

    def test_the_map_of_a_room_is_written_in_the_ros_format(self, tmp_path: Path) -> None:
        done = tangy_map("--room", "common-room", "--yaml", tmp_path / "room.yaml", "--json")
        told = json.loads(done.stdout)
        assert told["room"] == "common-room" and told["resolution"] == 0.05
        assert {Path(name).name for name in told["written"]} >= {"room.yaml", "room.pgm"}
        read = read_map(tmp_path / "room.yaml")
        assert read.size == pytest.approx((told["width_m"], told["depth_m"]))
        assert read.keep_out.any()

    def test_the_map_of_a_log_is_drawn_from_its_poses(self, tmp_path: Path) -> None:
        log = log_of_a_room(tmp_path / "a.log")
        told = json.loads(tangy_map(log, "--json", "--resolution", "0.1").stdout)
        assert told["scans"] == told["used"] == 24 and not told["matched"]
        assert 0.5 * 80 < told["free_m2"] < 1.1 * 80

    def test_a_map_file_can_be_shown(self, tmp_path: Path) -> None:
        tangy_map("--room", "common-room", "--yaml", tmp_path / "room.yaml")
        done = tangy_map(tmp_path / "room.yaml", "--ascii", "--png", tmp_path / "room.png")
        assert done.exit_code == 0 and "#" in done.stdout and "room.png" in done.stdout
        assert (tmp_path / "room.png").read_bytes().startswith(b"\x89PNG")
        assert max(map(len, done.stdout.splitlines()[:20])) <= 80

    @pytest.mark.parametrize(
        ("words", "told"),
        [
            ([], "Say what to draw"),
            (["a.log", "--room", "common-room"], "Say what to draw"),
            (["nowhere.log"], "there is no such file"),
            (["nowhere.yaml"], "there is no such file"),
            (["--room", "comon-room"], "did you mean 'common-room'"),
            (["--room", "common-room", "--yaml", "room.txt"], "name it .yaml"),
            (["--room", "common-room", "--png", "room.gif"], "name it .png"),
            (["--room", "common-room", "--yaml", "/proc/no/room.yaml"], "cannot be written"),
        ],
    )
    def test_an_unusable_file_is_refused_in_one_sentence(self, words: list[str], told: str) -> None:
        with pytest.raises(TangyError, match=told) as error:
            tangy_map(*words)
        assert "\n" not in str(error.value)
