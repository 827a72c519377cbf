"""A drive without a map: the pose from wheel odometry, and the recording of its scans."""

from __future__ import annotations

from contextlib import suppress
from math import pi
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_hw.device_protocols import STILL, DeviceError, Odometry, Pose, Scan
from tangy_hw.navigation.dead_reckoning import DeadReckoning
from tangy_hw.navigation.mapping import PlacedScan, map_of_scans
from tangy_hw.navigation.occupancy import OCCUPIED
from tangy_hw.navigation.poses import IDENTITY, compose
from tangy_hw.navigation.scan_log import read_log
from tangy_hw.navigation.scan_recorder import ScanRecorder, robot_laser_line
from tangy_profiles.health import ERROR, OK
from tangy_profiles.room import load_room
from tests.hw.raycast import look, room_sides

ROOM = load_room()
LASER = Pose(0.25, 0.0, 0.17)
metres = st.floats(-50, 50)


@given(
    metres,
    metres,
    st.floats(-pi, pi),
    st.lists(st.one_of(st.floats(0.05, 9.9), st.just(float("inf"))), min_size=2, max_size=40),
)
def test_a_recorded_scan_is_read_back_unchanged(
    tmp_path_factory: pytest.TempPathFactory,
    x: float,
    y: float,
    heading: float,
    ranges: list[float],
) -> None:
    log = tmp_path_factory.mktemp("log") / "a.log"
    scan = Scan(-1.5, 0.01, np.array(ranges), 10.0)
    log.write_text(robot_laser_line(scan, Pose(x, y, heading), 3.5))
    (found,) = read_log(log)
    assert found.scan.first == pytest.approx(scan.first) and found.scan.step == pytest.approx(0.01)
    assert np.array_equal(np.isfinite(found.scan.ranges), np.isfinite(scan.ranges))
    met = np.isfinite(scan.ranges)
    assert np.allclose(found.scan.ranges[met], scan.ranges[met], atol=0.001)
    for pose in (found.pose, found.odometry):
        assert np.allclose(pose, (x, y, heading), atol=1e-4)
    assert found.stamp == 3.5


def test_a_standing_robot_records_one_scan(tmp_path: Path) -> None:
    recorder = ScanRecorder(tmp_path / "a.log")
    scan = look(room_sides(ROOM), Pose(5.0, 2.0, 0.0))
    for _ in range(10):
        recorder.note(scan, IDENTITY, 0.0)
    recorder.note(scan, Pose(0.0, 0.0, 0.1), 1.0)
    recorder.close()
    assert len(read_log(tmp_path / "a.log")) == 2


def test_an_earlier_drive_is_not_overwritten(tmp_path: Path) -> None:
    log = tmp_path / "a.log"
    log.write_text("kept")
    with pytest.raises(DeviceError, match="cannot be written"):
        ScanRecorder(log)
    assert log.read_text() == "kept"


def test_a_full_disk_does_not_stop_the_drive(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    full = Path("/dev/full").open("w", encoding="ascii", buffering=1)  # noqa: SIM115
    monkeypatch.setattr(Path, "open", lambda *_, **__: full)
    navigator = DeadReckoning(ScanRecorder(tmp_path / "a.log"))
    scan = look(room_sides(ROOM), Pose(5.0, 2.0, 0.0))
    assert navigator.readings()[0].state == OK
    for _ in range(2):
        assert navigator.tick(Odometry(IDENTITY, STILL), scan, 0.1) == STILL
    assert navigator.readings()[0].state == ERROR
    with suppress(OSError):
        full.close()


def test_a_map_from_a_recording_has_its_walls_in_place(tmp_path: Path) -> None:
    start = Pose(5.0, 1.5, pi / 2)
    recorder = ScanRecorder(tmp_path / "a.log")
    navigator = DeadReckoning(recorder, start, LASER)
    wheels = Pose(7.0, -3.0, 0.4)  # odometry begins anywhere
    for number in range(12):
        steps = Pose(0.15 * number, 0.0, 0.1 * number)
        truth = compose(start, steps)
        scan = look(room_sides(ROOM), compose(truth, LASER))
        driven = navigator.tick(Odometry(compose(wheels, steps), STILL), scan, 0.1)
        assert driven == STILL
        assert np.allclose(navigator.estimate.pose, truth)
    recorder.close()
    scans = [PlacedScan(one.scan, one.odometry) for one in read_log(tmp_path / "a.log")]
    drawn = map_of_scans(scans, 0.05)
    occupied = np.argwhere(drawn.cells == OCCUPIED)
    assert len(scans) == 12 and len(occupied)
    for row, column in occupied:
        x, y = drawn.point(row, column)
        sides = room_sides(ROOM)
        assert min(_apart((x, y), side) for side in sides) < 0.08


def _apart(point: tuple[float, float], side: object) -> float:
    (ax, ay), (bx, by) = np.reshape(np.asarray(side, dtype=float), (2, 2))
    a, b, at = np.array((ax, ay)), np.array((bx, by)), np.array(point)
    along = b - a
    share = np.clip(np.dot(at - a, along) / max(np.dot(along, along), 1e-9), 0.0, 1.0)
    return float(np.linalg.norm(at - (a + share * along)))
