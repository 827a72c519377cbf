"""Maps: rooms drawn from their profiles, files in the ROS format, and maps from scans."""

from __future__ import annotations

import gzip
from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from tangy_hw.device_protocols import Pose, Scan
from tangy_hw.navigation.agreement import TORN, contradicted
from tangy_hw.navigation.alignment import aligned
from tangy_hw.navigation.map_drawing import map_lines
from tangy_hw.navigation.map_files import MapFileError, read_map, write_map
from tangy_hw.navigation.mapping import MapError, PlacedScan, map_of_scans, sparse
from tangy_hw.navigation.occupancy import FREE, OCCUPIED, UNKNOWN, OccupancyMap, map_of_room
from tangy_hw.navigation.poses import compose, relative_pose
from tangy_hw.navigation.scan_log import LogError, read_log
from tangy_profiles.room import load_room
from tests.hw.raycast import Wheels, driven, look, room_sides, tour

ROOM = load_room()
YAML = "image: a.pgm\nresolution: 0.1\norigin: [-1.0, 2.0, 0.0]\nnegate: 0\n"


def folder_with(tmp_path: Path, yaml: str = YAML, pixels: bytes = b"\x00\xcd\xfe\xfe") -> Path:
    (tmp_path / "a.pgm").write_bytes(b"P5\n# drawn by hand\n2 2\n255\n" + pixels)
    (tmp_path / "a.yaml").write_text(yaml)
    return tmp_path / "a.yaml"


class TestRooms:
    def test_the_walls_of_the_map_match_the_profile(self) -> None:
        drawn = map_of_room(ROOM)
        for x, y in ((0, 4), (ROOM.width, 4), (5, 0), (5, ROOM.depth)):
            row, column = drawn.cell(x, y)
            assert drawn.cells[row, column] == OCCUPIED
            assert np.allclose(drawn.point(row, column), (x, y), atol=1e-9)

    def test_a_table_is_a_keep_out_area_with_visible_legs(self) -> None:
        drawn = map_of_room(ROOM)
        left, near, right, far = ROOM.table
        middle = drawn.cell((left + right) / 2, (near + far) / 2)
        assert drawn.keep_out[middle] and drawn.obstacles[middle]
        assert drawn.cells[middle] == FREE
        assert drawn.cells[drawn.cell(left + 0.1, near + 0.1)] == OCCUPIED

    def test_an_empty_seat_is_free_space(self) -> None:
        seat = ROOM.seats[0]
        assert map_of_room(ROOM).keep_out[map_of_room(ROOM).cell(seat.x, seat.y)]
        bare = map_of_room(ROOM, people=0)
        assert not bare.obstacles[bare.cell(seat.x, seat.y)]

    @pytest.mark.parametrize("resolution", [0.02, 0.1])
    def test_a_finer_map_is_of_the_same_room(self, resolution: float) -> None:
        drawn = map_of_room(ROOM, resolution)
        free = (drawn.cells == FREE).sum() * resolution**2
        assert free == pytest.approx(ROOM.width * ROOM.depth, rel=0.05)


class TestFiles:
    def test_a_written_map_is_read_back_unchanged(self, tmp_path: Path) -> None:
        drawn = map_of_room(ROOM)
        written = write_map(drawn, tmp_path / "room.yaml")
        again = read_map(tmp_path / "room.yaml")
        assert [path.name for path in written] == [
            "room.yaml", "room.pgm", "room-keep-out.yaml", "room-keep-out.pgm",
        ]  # fmt: skip
        assert (again.cells == drawn.cells).all() and (again.keep_out == drawn.keep_out).all()
        assert again.resolution == drawn.resolution
        assert again.origin == pytest.approx(drawn.origin)

    @given(
        cells=st.lists(
            st.lists(st.sampled_from([FREE, OCCUPIED, UNKNOWN]), min_size=3, max_size=3),
            min_size=1,
            max_size=6,
        )
    )
    @settings(max_examples=20, deadline=None)
    def test_each_state_of_a_cell_survives_a_file(
        self, cells: list[list[int]], tmp_path_factory: pytest.TempPathFactory
    ) -> None:
        path = tmp_path_factory.mktemp("maps") / "m.yaml"
        drawn = OccupancyMap(np.array(cells, dtype=np.int8), 0.05, (0.0, 0.0))
        write_map(drawn, path)
        assert (read_map(path).cells == drawn.cells).all()

    def test_the_lowest_line_of_the_picture_is_the_lowest_y(self, tmp_path: Path) -> None:
        read = read_map(folder_with(tmp_path))
        assert read.cells.tolist() == [[FREE, FREE], [OCCUPIED, UNKNOWN]]
        assert read.origin == (-1.0, 2.0) and read.resolution == 0.1

    def test_negate_turns_dark_and_light_around(self, tmp_path: Path) -> None:
        read = read_map(folder_with(tmp_path, YAML.replace("negate: 0", "negate: 1")))
        assert read.cells.tolist() == [[OCCUPIED, OCCUPIED], [FREE, OCCUPIED]]

    def test_the_thresholds_of_the_file_classify_cells(self, tmp_path: Path) -> None:
        read = read_map(folder_with(tmp_path, YAML + "free_thresh: 0.25\noccupied_thresh: 0.9\n"))
        assert read.cells.tolist() == [[FREE, FREE], [OCCUPIED, FREE]]

    def test_an_origin_in_lines_and_a_png_are_read(self, tmp_path: Path) -> None:
        yaml = "image: 'a.png' # drawn\nresolution: 5e-2\norigin:\n- 1.0\n- 2.0\n- 0.0\nnegate: 0\n"
        path = folder_with(tmp_path, yaml)
        Image.fromarray(np.full((3, 4), 254, dtype=np.uint8)).save(tmp_path / "a.png")
        read = read_map(path)
        assert read.shape == (3, 4) and read.origin == (1.0, 2.0)

    @pytest.mark.parametrize(
        ("yaml", "told"),
        [
            (YAML.replace("0.0]", "0.5]"), "yaw of 0.5"),
            (YAML.replace("resolution: 0.1\n", ""), "resolution is missing"),
            (YAML.replace("0.1", "wide"), "'wide', which is not a number"),
            (YAML.replace("0.1", ".nan"), "which is not a number"),
            (YAML.replace("0.1", "-0.1"), "resolution must be"),
            (YAML + "mode: scale\n", "mode 'scale' is not known"),
            (YAML + "negate: 1\n", "stands there twice"),
            (YAML + "freethresh: 1\n", "did you mean 'free_thresh'"),
            (YAML + "free_thresh: 0.9\n", "must not be above"),
            (YAML.replace("[-1.0, 2.0, 0.0]", "3"), "origin must be"),
            (YAML.replace("a.pgm", "b.pgm"), "there is no such file"),
            (YAML.replace("a.pgm", "a.yaml"), "is not a picture"),
        ],
    )
    def test_an_invalid_map_file_is_refused_in_one_sentence(
        self, yaml: str, told: str, tmp_path: Path
    ) -> None:
        with pytest.raises(MapFileError, match=told) as error:
            read_map(folder_with(tmp_path, yaml))
        assert "\n" not in str(error.value) and str(tmp_path) in str(error.value)

    def test_a_truncated_picture_is_refused(self, tmp_path: Path) -> None:
        with pytest.raises(MapFileError, match="breaks off"):
            read_map(folder_with(tmp_path, pixels=b"\x00"))

    def test_a_keep_out_of_another_size_is_refused(self, tmp_path: Path) -> None:
        write_map(map_of_room(ROOM), tmp_path / "room.yaml")
        other = map_of_room(ROOM, 0.1)
        write_map(replace(other, cells=other.cells * 0), tmp_path / "room-keep-out.yaml")
        with pytest.raises(MapFileError, match="not of the size"):
            read_map(tmp_path / "room.yaml")


def scans_of_a_tour(scale: float, noise: float) -> tuple[list[PlacedScan], list[Pose]]:
    """Drive through the room; return scans at the poses by odometry, and the true poses."""
    rng = np.random.default_rng(3)
    sides, pose, wheels = room_sides(ROOM), Pose(5.0, 1.2, 0.0), Wheels(rng, scale, noise)
    start, counted, truth = pose, [], []
    for number, twist in enumerate(tour([(5, 1.2), (8, 4), (2, 4), (1, 7), (9, 7), (8, 1)])):
        pose, odometry = driven(pose, twist, 0.1), wheels.turn(twist, 0.1)
        if number % 4 == 0:
            counted.append(PlacedScan(look(sides, pose, rng), compose(start, odometry)))
            truth.append(pose)
    return counted, truth


class TestScans:
    def test_scans_of_a_room_make_its_map(self) -> None:
        counted, truth = scans_of_a_tour(1.0, 0.0)
        scans = sparse(PlacedScan(one.scan, pose) for one, pose in zip(counted, truth, strict=True))
        made, drawn = map_of_scans(scans), map_of_room(ROOM)
        seen = made.free_points()
        rows, columns = drawn.cells_of(seen)
        assert (drawn.cells[rows, columns] == FREE).mean() > 0.98
        assert len(seen) * 0.05**2 > 0.9 * ROOM.width * ROOM.depth
        rows, columns = np.nonzero(made.cells == OCCUPIED)
        walls = np.array([made.point(int(r), int(c)) for r, c in zip(rows, columns, strict=True)])
        off = drawn.seen_distance[drawn.cells_of(walls)]
        assert np.percentile(off, 95) <= 0.06

    @pytest.mark.slow
    def test_scan_matching_corrects_the_odometry(self) -> None:
        counted, truth = scans_of_a_tour(1.04, 0.05)
        found = aligned(counted)
        off = [abs(one.pose.x - t.x) + abs(one.pose.y - t.y)
               for one, t in zip(found, truth, strict=True)]  # fmt: skip
        drifted = [abs(one.pose.x - t.x) + abs(one.pose.y - t.y)
                   for one, t in zip(counted, truth, strict=True)]  # fmt: skip
        assert max(off) < 0.1 < 0.4 < max(drifted)

    @pytest.mark.slow
    def test_the_share_of_contradicting_beams_separates_closed_and_torn_maps(self) -> None:
        counted, _ = scans_of_a_tour(1.04, 0.05)
        found = aligned(counted)
        assert contradicted(found, map_of_scans(found)) < TORN / 3
        assert contradicted(counted, map_of_scans(counted)) > TORN
        half = len(found) // 2
        away = [
            PlacedScan(one.scan, compose(Pose(0.6, 0.3, 0.0), one.pose)) for one in found[half:]
        ]
        torn = [*found[:half], *away]
        assert contradicted(torn, map_of_scans(torn)) > TORN

    def test_no_beams_contradict_an_empty_map(self) -> None:
        empty = PlacedScan(Scan(0.0, 0.1, np.array([np.inf, np.inf]), 30.0), Pose(0, 0, 0))
        wall = PlacedScan(Scan(0.0, 0.1, np.array([2.0, 2.1]), 30.0), Pose(0, 0, 0))
        made = map_of_scans([wall])
        assert contradicted([], made) == contradicted([empty], made) == 0.0

    def test_an_oversized_map_is_refused(self) -> None:
        scan = Scan(0.0, 0.1, np.array([5.0, 6.0]), 30.0)
        with pytest.raises(MapError, match="coarser"):
            map_of_scans([PlacedScan(scan, Pose(0, 0, 0)), PlacedScan(scan, Pose(9e5, 0, 0))])

    def test_a_map_can_be_drawn_in_ascii(self) -> None:
        lines = map_lines(map_of_room(ROOM), 60, ascii_only=True)
        text = "\n".join(lines)
        assert max(map(len, lines)) <= 60 and text.isascii()
        assert all(sign in text for sign in "#+. ")


FLASER = "FLASER 3 1.0 2.0 81.91 1 2 0.5 3 4 0.25 10.5 host 10.5\n"
ROBOTLASER = (
    "ROBOTLASER1 0 -1.0 2.0 1.0 30.0 0.01 0 3 1.0 31.0 2.0 0 5 6 0.1 4 6 0.2 0 0 .2 .2 0 99.5 h 1\n"
)


class TestLogs:
    def test_old_and_new_line_formats_are_read(self, tmp_path: Path) -> None:
        log = tmp_path / "a.log"
        log.write_text("# made by hand\nODOM 7 8 0.5 0 0 0 1 h 1\n" + FLASER + ROBOTLASER)
        old, new = read_log(log)
        assert old.pose == Pose(1, 2, 0.5) and old.odometry == Pose(3, 4, 0.25)
        assert old.wheels == Pose(7, 8, 0.5) and old.stamp == 10.5
        assert old.scan.first == -pi / 2 and old.scan.step == pytest.approx(pi / 2)
        assert old.scan.ranges.tolist() == [1.0, 2.0, np.inf]
        assert new.scan.first == -1.0 and new.scan.ranges.tolist() == [1.0, np.inf, 2.0]
        assert new.pose == Pose(5, 6, 0.1) and new.odometry == Pose(4, 6, 0.2)
        assert new.stamp == 99.5

    def test_a_packed_log_reads_like_the_plain_one(self, tmp_path: Path) -> None:
        (tmp_path / "a.log.gz").write_bytes(gzip.compress(FLASER.encode()))
        assert read_log(tmp_path / "a.log.gz")[0].stamp == 10.5

    @pytest.mark.parametrize(
        ("text", "told"),
        [
            ("", "has no scans"),
            ("FLASER 3 1.0 2.0\n", "line 1: the line ends too early"),
            (FLASER + FLASER.replace("2.0", "two", 1), "line 2: 'two' is not a number"),
            (FLASER.replace("1.0", "nan", 1), "not a number that can be used"),
            (FLASER.replace("FLASER 3", "FLASER -3"), "not a number of readings"),
            (FLASER.replace("FLASER 3", "FLASER 999999999"), "not a number of readings"),
        ],
    )
    def test_an_invalid_line_is_refused_with_its_number(
        self, text: str, told: str, tmp_path: Path
    ) -> None:
        log = tmp_path / "a.log"
        log.write_text(text)
        with pytest.raises(LogError, match=told):
            read_log(log)

    def test_files_that_are_no_logs_are_refused(self, tmp_path: Path) -> None:
        (tmp_path / "a.log").write_bytes(bytes(range(128, 256)))
        (tmp_path / "b.log").write_bytes(gzip.compress(FLASER.encode())[:-12])
        for name, told in (
            ("a.log", "not text"),
            ("b.log", "breaks off"),
            ("c.log", "no such file"),
        ):
            with pytest.raises(LogError, match=told):
                read_log(tmp_path / name)


def test_composing_a_relative_pose_gives_the_second_pose() -> None:
    one, other = Pose(1.0, 2.0, 3.0), Pose(-2.0, 0.5, -3.0)
    assert compose(one, relative_pose(one, other)) == pytest.approx(other)
