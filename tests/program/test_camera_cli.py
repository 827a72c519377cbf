"""`tangy camera` and `tangy capture` on real files and streams, and the list of cameras."""

from __future__ import annotations

import json
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from subprocess import CompletedProcess

import cv2
import numpy as np
import pytest

from tangy_hw.drivers.camera import Camera
from tangy_hw.drivers.camera_devices import list_cameras
from tangy_hw.drivers.camera_recorder import capture
from tangy_hw.drivers.camera_source import CameraError, find_camera
from tangy_profiles.robot import load_robot
from tests.hw.pictures import Image, room, seen
from tests.real.camera_server import CameraServer

Tangy = Callable[..., CompletedProcess[str]]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Five pictures, of which the fourth was taken through a scarf."""
    made = tmp_path / "pictures"
    made.mkdir()
    rng = np.random.default_rng(0)
    for number in range(5):
        light, blur = (0.03, 9.0) if number == 3 else (1.0, 0.0)
        cv2.imwrite(
            str(made / f"{number}.png"),
            seen(room(70 + number, 160, 120), rng, light=light, blur=blur),
        )
    return made


class TestCamera:
    @pytest.mark.slow
    def test_a_working_stream_is_reported(self, tangy: Tangy, tmp_path: Path) -> None:
        with CameraServer() as server:
            picture = tmp_path / "last.png"
            done = tangy("camera", server.url, "--seconds", 2, "--json", "--picture", picture)
        found = json.loads(done.stdout)
        assert (done.returncode, done.stderr) == (0, "")
        assert (found["works"], found["state"], found["width"], found["height"]) == (
            True, "OK", 320, 240,
        )  # fmt: skip
        assert found["frames"] > 1
        assert cv2.imread(str(picture)) is not None

    @pytest.mark.slow
    def test_a_covered_camera_fails_with_the_reason(self, tangy: Tangy) -> None:
        with CameraServer() as server:
            server.mode = "covered"
            done = tangy("camera", server.url, "--seconds", 3)
        assert done.returncode == 1
        assert "covered: Nothing can be seen" in done.stdout

    @pytest.mark.slow
    def test_a_missing_camera_fails(self, tangy: Tangy) -> None:
        done = tangy("camera", "/dev/video93", "--seconds", 2)
        assert done.returncode == 1
        assert "there is no such camera" in done.stdout

    @pytest.mark.parametrize("options", [("none.avi",), ("0", "--picture", "a.txt")])
    def test_bad_input_is_refused_in_one_sentence(self, options: list[str], tangy: Tangy) -> None:
        done = tangy("camera", *options)
        assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)

    def test_a_file_that_is_no_video_is_refused_in_one_sentence(
        self, tangy: Tangy, tmp_path: Path
    ) -> None:
        (tmp_path / "a.avi").write_bytes(b"no video")
        done = tangy("camera", tmp_path / "a.avi")
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr == f"tangy: {tmp_path / 'a.avi'}: it is no video that can be read.\n"


class TestCapture:
    @pytest.mark.slow
    def test_every_picture_is_stored_with_its_reading(
        self, tangy: Tangy, folder: Path, tmp_path: Path
    ) -> None:
        into = tmp_path / "set"
        done = tangy("capture", into, "--from", folder, "--json")
        kept = json.loads(done.stdout)
        assert done.returncode == 0
        assert [row["file"] for row in kept] == [f"00000{number}.png" for number in range(1, 6)]
        assert [row["state"] for row in kept] == ["OK", "OK", "OK", "COVERED", "OK"]
        assert all(row["label"] is None for row in kept)
        for row in kept:
            assert json.loads((into / row["file"]).with_suffix(".json").read_text()) == row
        was = cv2.imread(str(folder / "2.png"))
        again = cv2.imread(str(into / "000003.png"))
        assert was is not None and again is not None and np.array_equal(was, again)
        assert into.stat().st_mode & 0o077 == 0
        assert (into / "000001.png").stat().st_mode & 0o077 == 0

    @pytest.mark.slow
    def test_a_set_is_extended_without_overwriting(
        self, tangy: Tangy, folder: Path, tmp_path: Path
    ) -> None:
        tangy("capture", tmp_path / "set", "--from", folder, "--count", 2)
        before = (tmp_path / "set" / "000001.png").read_bytes()
        done = tangy("capture", tmp_path / "set", "--from", folder, "--count", 1)
        assert "000003.png  working" in done.stdout
        assert (tmp_path / "set" / "000001.png").read_bytes() == before

    @pytest.mark.slow
    async def test_the_result_of_a_reader_is_stored(self, folder: Path, tmp_path: Path) -> None:
        def reader(image: Image) -> dict[str, int]:
            return {"height": int(image.shape[0])}

        async with Camera(find_camera(str(folder), each=True)) as camera:
            rows = [one async for one in capture(camera, tmp_path / "set", count=2, reader=reader)]
        assert [row["seen"] for row in rows] == [{"height": 120}] * 2

    @pytest.mark.slow
    async def test_pictures_keep_the_given_interval(self, tmp_path: Path) -> None:
        with CameraServer() as server:
            async with Camera(find_camera(server.url)) as camera:
                rows = [row async for row in capture(camera, tmp_path / "set", count=3, every=0.2)]
        stamps = [row["stamp"] for row in rows]
        assert all(later - sooner >= 0.199 for sooner, later in pairwise(stamps))

    async def test_an_unusable_folder_is_an_error(self, folder: Path, tmp_path: Path) -> None:
        (tmp_path / "file").write_bytes(b"")
        async with Camera(find_camera(str(folder), each=True)) as camera:
            with pytest.raises(CameraError, match="cannot be used"):
                async for _ in capture(camera, tmp_path / "file"):
                    pass

    def test_a_capture_without_a_picture_fails(self, tangy: Tangy, tmp_path: Path) -> None:
        done = tangy("capture", tmp_path / "set", "--from", "/dev/video93", "--seconds", 0.2)
        assert done.returncode == 1
        assert done.stderr == "tangy: /dev/video93: no picture came.\n"


def test_cameras_are_listed_by_their_system_names(tmp_path: Path) -> None:
    devices = tmp_path / "dev"
    devices.mkdir()
    for name, index, title in (
        ("video10", "0", "Overview"), ("video2", "0", "Head: C920"), ("video3", "1", "Head: C920"),
    ):  # fmt: skip
        (tmp_path / "sys" / name).mkdir(parents=True)
        (tmp_path / "sys" / name / "index").write_text(f"{index}\n")
        (tmp_path / "sys" / name / "name").write_text(f"{title}\n")
        (devices / name).write_bytes(b"")
    found = list_cameras(tmp_path / "sys", devices)
    assert [(Path(device).name, title) for device, title, _ in found] == [
        ("video2", "Head: C920"), ("video10", "Overview"),
    ]  # fmt: skip
    assert list_cameras(tmp_path / "none", devices) == []


class TestSensors:
    @pytest.mark.slow
    def test_each_device_has_a_line_and_a_working_camera_its_age(
        self, tangy: Tangy, tmp_path: Path
    ) -> None:
        with CameraServer() as server:
            done = tangy("sensors", "--camera", f"camera={server.url}", "--seconds", 2)
        lines = done.stdout.splitlines()
        assert (done.returncode, done.stderr) == (0, "")
        assert any(line.startswith("head camera") and "working" in line for line in lines)
        assert "laser scanner      simulated" in lines
        assert lines[-2:] == ["No card was read yet.", "Now: no card in sight."]

    @pytest.mark.slow
    def test_a_failing_camera_gives_the_reason(self, tangy: Tangy) -> None:
        done = tangy("sensors", "--camera", "camera=/dev/video93", "--seconds", 2, "--json")
        told = json.loads(done.stdout)
        assert (done.returncode, done.stderr, told["works"]) == (1, "", False)
        devices = {device["device"]: device for device in told["devices"]}
        assert devices["camera"]["state"] == "DISCONNECTED"
        assert "there is no such camera" in devices["camera"]["why"]
        assert devices["laser"]["simulated"] and devices["laser"]["works"] is None
        assert told["card"] == {"card": None, "problem": ""}

    def test_a_missing_camera_option_is_explained(self, tangy: Tangy) -> None:
        done = tangy("sensors", "--seconds", 0.1)
        assert done.returncode == 0
        assert "tangy sensors --camera camera=0" in done.stdout

    @pytest.mark.parametrize("source", ["camra=0", "camera", "camera=none.avi"])
    def test_an_invalid_source_is_refused_in_one_sentence(self, source: str, tangy: Tangy) -> None:
        done = tangy("sensors", "--camera", source)
        assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)

    @pytest.mark.slow
    def test_a_custom_robot_file_names_the_source_of_its_camera(
        self, tangy: Tangy, folder: Path, tmp_path: Path
    ) -> None:
        shipped = load_robot().file.read_text(encoding="utf-8")
        mine = tmp_path / "mine.toml"
        mine.write_text(shipped.replace('# source = "/dev/video0"', f'source = "{folder.name}"'))
        done = tangy("sensors", "--robot", mine, "--seconds", 1, "--json")
        devices = {device["device"]: device for device in json.loads(done.stdout)["devices"]}
        assert devices["camera"]["source"] == str(folder)
        mine.write_text(shipped.replace('# source = "/dev/video0"', 'source = "nowhere"'))
        done = tangy("sensors", "--robot", mine)
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr.startswith("tangy: mine.toml: devices[camera].source = 'nowhere': ")
