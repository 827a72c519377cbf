"""Folders of pictures of cards: read whole, and counted only if their label files are sound."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

Tangy = Callable[..., CompletedProcess[str]]


@pytest.mark.slow
def test_the_pictures_of_a_folder_are_read_by_their_names(tangy: Tangy, tmp_path: Path) -> None:
    tangy("cards", "print", "--first", 7, "--count", 3, "--png", tmp_path, "--dpi", 60)
    read = json.loads(tangy("read-card", tmp_path, "--json").stdout)
    assert [row["card"] for row in read] == [7, 8, 9]
    assert [row["file"] for row in read] == [str(tmp_path / f"card-00{n}.png") for n in (7, 8, 9)]
    first = tmp_path / "card-009.png"
    both = json.loads(tangy("read-card", first, tmp_path, "--json").stdout)
    assert [row["card"] for row in both] == [9, 7, 8, 9]


@pytest.mark.slow
def test_a_folder_without_pictures_is_refused_and_the_rest_is_read(
    tangy: Tangy, tmp_path: Path
) -> None:
    tangy("cards", "print", "--first", 7, "--count", 1, "--png", tmp_path, "--dpi", 60)
    (tmp_path / "empty").mkdir()
    (tmp_path / "empty" / "notes.txt").write_text("none")
    done = tangy("read-card", tmp_path / "empty", tmp_path / "card-007.png", "--json")
    assert done.returncode == 2 and "empty: is not a file" in done.stderr
    assert [row["card"] for row in json.loads(done.stdout)] == [7]


def test_a_damaged_label_file_stops_the_count(tangy: Tangy, tmp_path: Path) -> None:
    tangy("cards", "print", "--first", 7, "--count", 1, "--png", tmp_path, "--dpi", 60)
    told = {"file": "card-007.png", "label": {"card": 7, "marked": []}}
    (tmp_path / "card-007.json").write_text(json.dumps(told))
    assert tangy("read-card", "--bench", tmp_path).returncode == 0
    for damaged in ("[]", '{"file": "card-0'):
        (tmp_path / "card-008.json").write_text(damaged)
        done = tangy("read-card", "--bench", tmp_path)
        assert done.returncode == 2 and "card-008.json" in done.stderr
