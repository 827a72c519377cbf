"""Cameras by name, and refused names."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tangy_hw.drivers.camera_source import CameraError, CameraSource, find_camera, pictures_in
from tangy_profiles.codec import decode, encode


class TestNames:
    @pytest.mark.parametrize(
        ("name", "kind", "target"),
        [
            ("0", "device", "/dev/video0"),
            ("/dev/video2", "device", "/dev/video2"),
            ("http://robot:8080/stream", "stream", "http://robot:8080/stream"),
            ("rtsp://10.0.0.7/1", "stream", "rtsp://10.0.0.7/1"),
        ],
    )
    def test_cameras_and_streams(self, name: str, kind: str, target: str) -> None:
        source = find_camera(name)
        assert (source.kind, source.target, source.live) == (kind, target, True)

    def test_files_and_folders(self, tmp_path: Path) -> None:
        for name in ("video.avi", "one.PNG", "notes.txt"):
            (tmp_path / name).write_bytes(b"x")
        assert find_camera(str(tmp_path)).kind == "folder"
        assert find_camera(str(tmp_path / "one.PNG")).kind == "folder"
        assert find_camera(str(tmp_path / "video.avi")).kind == "file"
        assert not find_camera(str(tmp_path)).live

    def test_a_path_under_dev_shm_is_a_file_and_no_device(self) -> None:
        with pytest.raises(CameraError, match="there is no such file"):
            find_camera("/dev/shm/nowhere/video.avi")  # noqa: S108 - it is not there

    def test_the_name_of_a_camera_leaves_out_its_password(self) -> None:
        source = find_camera("rtsp://staff:secret@10.0.0.7/1")
        assert source.name == "rtsp://10.0.0.7/1"
        assert "secret" in source.target

    @pytest.mark.parametrize(
        ("name", "word"),
        [
            ("none.avi", "no such file"),
            ("a\0b", "no such file"),
            ("http://", "no address"),
            ("http://host:99999/", "no address"),
            ("http://host/a b", "no address"),
            ("concat://a|b", "no address"),
            ("file://host/a.png", "no address"),
            ("ftp://u:secret@host", "^ftp://host: is no address"),
        ],
    )
    def test_an_invalid_camera_name_is_refused_in_one_sentence(self, name: str, word: str) -> None:
        with pytest.raises(CameraError, match=word) as refused:
            find_camera(name)
        assert "\n" not in str(refused.value)

    def test_an_empty_folder_and_a_pipe_are_refused(self, tmp_path: Path) -> None:
        with pytest.raises(CameraError, match="no pictures in this folder"):
            find_camera(str(tmp_path))
        os.mkfifo(tmp_path / "pipe")
        with pytest.raises(CameraError, match="neither a file nor a folder"):
            find_camera(str(tmp_path / "pipe"))

    def test_a_source_can_be_encoded_for_another_process(self) -> None:
        source = find_camera("http://host/")
        assert decode(CameraSource, encode(source)) == source


def test_pictures_are_sorted_in_natural_number_order(tmp_path: Path) -> None:
    for name in ("10.png", "9.png", "b2.jpg", "b10.JPG", "notes.txt", "a.png"):
        (tmp_path / name).write_bytes(b"")
    (tmp_path / "folder.png").mkdir()
    found = [path.name for path in pictures_in(tmp_path)]
    assert found == ["9.png", "10.png", "a.png", "b2.jpg", "b10.JPG"]
