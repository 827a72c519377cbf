"""Reading given files: regular files of a bounded size; others are refused in one sentence."""

from __future__ import annotations

import os
import socket
from pathlib import Path

import pytest

from tangy_profiles.errors import ProfileError, TangyError
from tangy_profiles.given_file import open_given, read_given, read_given_text
from tangy_profiles.reading import read_toml


@pytest.fixture
def pipe(tmp_path: Path) -> Path:
    path = tmp_path / "pipe.toml"
    os.mkfifo(path)
    return path


def test_files_and_links_to_files_are_read(tmp_path: Path) -> None:
    (tmp_path / "one").write_bytes(b"a\r\nb\rc\n")
    (tmp_path / "link").symlink_to(tmp_path / "one")
    assert read_given(tmp_path / "link", 7) == b"a\r\nb\rc\n"
    assert read_given_text(tmp_path / "one", 7) == "a\nb\nc\n"
    with open_given(tmp_path / "one", 7) as file:
        assert os.get_inheritable(file.fileno()) is False


def test_endless_files_are_not_opened(tmp_path: Path, pipe: Path) -> None:
    (tmp_path / "zero").symlink_to("/dev/zero")
    bound = socket.socket(socket.AF_UNIX)
    bound.bind(str(tmp_path / "socket"))
    for path, kind in (
        (pipe, "a pipe"), (tmp_path / "zero", "a device"), (tmp_path / "socket", "a socket"),
        (tmp_path, "a folder"),
    ):  # fmt: skip
        with pytest.raises(ProfileError, match=f"{path.name}: is not a file but {kind}."):
            read_given(path, 10, ProfileError)
    bound.close()


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("none", "there is no such file"), ("a\0b", "cannot be read"), ("x" * 300, "cannot be"),
        ("large", "is larger than 10 bytes"), ("loop", "cannot be read"), ("/proc/self/status", ""),
    ],
)  # fmt: skip
def test_unreadable_files_are_reported(tmp_path: Path, name: str, told: str) -> None:
    (tmp_path / "large").write_bytes(bytes(11))
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    with pytest.raises(TangyError, match=told or "is larger than 10 bytes") as caught:
        read_given(tmp_path / name, 10)
    assert "\n" not in str(caught.value) and "\0" not in str(caught.value)


def test_a_pipe_or_a_device_named_as_a_profile_is_refused(tmp_path: Path, pipe: Path) -> None:
    (tmp_path / "zero.toml").symlink_to("/dev/zero")
    for path in (pipe, tmp_path / "zero.toml"):
        with pytest.raises(ProfileError, match="is not a file but"):
            read_toml(path)
