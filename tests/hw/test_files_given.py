"""No given file hangs Tangy, fills its memory, or starts another program."""

from __future__ import annotations

import gzip
import os
import stat
import struct
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from tangy_hw.audio.wav import read_wav, seconds_cut_off
from tangy_hw.drivers.camera_grabber import Folder, StreamEnded
from tangy_hw.drivers.camera_source import CameraSource
from tangy_hw.navigation import scan_log
from tangy_hw.navigation.map_files import read_map
from tangy_hw.navigation.scan_log import LogError, read_log
from tangy_hw.perception.cards.labelled_set import labelled
from tangy_hw.perception.pictures import read_picture
from tangy_profiles.activity import load_activity
from tangy_profiles.errors import TangyError

YAML = "image: a.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n"
YAML += "occupied_thresh: 0.65\nfree_thresh: 0.196\n"
EPS = b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 90 90\n%%EndComments\nshowpage\n%%EOF\n"
SCAN = "FLASER 2 5 5 0 0 0 0 0 0 0 x 0\n"


def pipe_at(path: Path) -> Path:
    """Make a pipe that nobody writes to."""
    os.mkfifo(path)
    return path


def device_at(path: Path) -> Path:
    """Make a link to an endless device."""
    path.symlink_to("/dev/zero")
    return path


def of_map(path: Path) -> Any:
    """Read a map with this file as its picture."""
    path.rename(path.with_name("a.pgm"))
    (path.parent / "map.yaml").write_text(YAML)
    return read_map(path.parent / "map.yaml")


def labels(path: Path) -> Any:
    """Read this file as labels."""
    path.rename(path.with_name("labels.json"))
    deck = load_activity("bingo").deck
    assert deck is not None
    return labelled(path.parent, deck)


@pytest.fixture
def programs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[], list[str]]:
    """Put programs on the path that record when they start; return the started ones."""
    folder, told = tmp_path / "programs", tmp_path / "told"
    folder.mkdir()
    for name in ("gs", "gswin32c", "gswin64c", "convert", "magick"):
        (folder / name).write_text(f"#!/bin/sh\necho {name} >> {told}\n")
        (folder / name).chmod(stat.S_IRWXU)
    monkeypatch.setenv("PATH", f"{folder}:{os.environ['PATH']}")
    monkeypatch.setattr("PIL.EpsImagePlugin.gs_binary", None)
    return lambda: told.read_text().split() if told.exists() else []


@pytest.mark.parametrize("made", [pipe_at, device_at])
@pytest.mark.parametrize("read", [read_log, read_picture, read_wav, of_map, labels, read_map])
def test_a_pipe_or_a_device_is_refused_in_a_sentence(
    tmp_path: Path, made: Callable[[Path], Path], read: Callable[[Path], Any]
) -> None:
    with pytest.raises(TangyError, match=r"is not a file but a (pipe|device)"):
        read(made(tmp_path / "given"))


def test_a_pipe_is_not_checked_for_truncation(tmp_path: Path) -> None:
    assert seconds_cut_off(pipe_at(tmp_path / "pipe.wav")) == 0


def test_a_pipe_in_a_folder_of_pictures_is_left_out(tmp_path: Path) -> None:
    given = pipe_at(tmp_path / "a.png")
    folder = Folder(CameraSource("a.png", "folder", str(given), 5.0, False, True))
    folder.open()
    with pytest.raises(StreamEnded):
        folder.read()


class TestPictures:
    @pytest.mark.parametrize("read", [read_picture, of_map])
    def test_a_postscript_picture_starts_no_program(
        self, tmp_path: Path, programs: Callable[[], list[str]], read: Callable[[Path], Any]
    ) -> None:
        (tmp_path / "given.pgm").write_bytes(EPS)
        with pytest.raises(TangyError, match="is not a picture"):
            read(tmp_path / "given.pgm")
        assert programs() == []

    @pytest.mark.parametrize("side", [12_000, 30_000])  # Pillow itself refuses to open the larger
    @pytest.mark.parametrize("read", [read_picture, of_map])
    def test_a_decompression_bomb_is_refused_before_it_is_unpacked(
        self,
        tmp_path: Path,
        monkeypatch: pytest.MonkeyPatch,
        read: Callable[[Path], Any],
        side: int,
    ) -> None:
        def chunk(kind: bytes, content: bytes) -> bytes:
            crc = struct.pack(">I", zlib.crc32(kind + content))
            return struct.pack(">I", len(content)) + kind + content + crc

        size = struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0)
        (tmp_path / "given").write_bytes(
            b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", size) + chunk(b"IDAT", zlib.compress(bytes(99)))
        )
        monkeypatch.setattr(Image.Image, "load", lambda *_: pytest.fail("it was unpacked"))
        with pytest.raises(TangyError, match="million pixels"):
            read(tmp_path / "given")


class TestLogs:
    def test_an_oversized_packed_log_is_refused(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(scan_log, "MOST_SCANS", 1000)
        packed = gzip.compress(SCAN.encode() * 100_000)
        assert len(packed) < 20_000
        (tmp_path / "log.gz").write_bytes(packed)
        with pytest.raises(LogError, match="line 1001: there are more scans than a map needs"):
            read_log(tmp_path / "log.gz")

    def test_scans_with_too_many_readings_are_refused(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(scan_log, "MOST_READINGS", 3)
        (tmp_path / "log").write_text(SCAN * 4)
        with pytest.raises(LogError, match="line 2: there are more scans"):
            read_log(tmp_path / "log")

    def test_an_endless_line_is_refused(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(scan_log, "LONGEST_LINE", 1000)
        (tmp_path / "log.gz").write_bytes(gzip.compress(b"#" * 100_000))
        with pytest.raises(LogError, match="the line has no end"):
            read_log(tmp_path / "log.gz")

    @pytest.mark.parametrize("packed", [False, True])
    def test_a_valid_log_is_read(self, tmp_path: Path, packed: bool) -> None:
        content = (SCAN * 3).encode()
        (tmp_path / "log").write_bytes(gzip.compress(content) if packed else content)
        assert len(read_log(tmp_path / "log")) == 3

    def test_a_scan_of_one_reading_is_refused_in_a_sentence(self, tmp_path: Path) -> None:
        (tmp_path / "log").write_text("FLASER 1 5 0 0 0 0 0 0 0 x 0\n")
        with pytest.raises(LogError, match="line 1: '1' is not a number of readings"):
            read_log(tmp_path / "log")
