"""What is no usual colour picture is refused in one sentence that names it."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import numpy as np
import pytest
from PIL import Image

from tangy_hw.perception.pictures import PictureError, read_picture

Tangy = Callable[..., CompletedProcess[str]]


def bad_pictures(folder: Path) -> dict[str, Path]:
    """Write a file of each kind that is refused."""
    colour = Image.fromarray(np.random.default_rng(1).integers(0, 255, (200, 200, 3), np.uint8))
    (folder / "text.png").write_text("hello")
    (folder / "empty.jpg").write_bytes(b"")
    for name, kind in (("whole.png", "PNG"), ("whole.jpg", "JPEG")):
        colour.save(folder / name, kind)
        content = (folder / name).read_bytes()
        (folder / f"half-{name}").write_bytes(content[: len(content) // 2])
    Image.new("RGB", (1, 1)).save(folder / "dot.png")
    Image.new("1", (7_100, 7_100)).save(folder / "huge.png")
    colour.convert("L").save(folder / "grey.png")
    colour.convert("RGBA").save(folder / "clear.png")
    colour.save(folder / "other.jpg", "PNG")
    (folder / "folder.png").mkdir()
    os.mkfifo(folder / "pipe.png")
    return {
        "is not a picture": folder / "text.png",
        "not a picture (": folder / "empty.jpg",
        "breaks off": folder / "half-whole.png",
        "breaks off or": folder / "half-whole.jpg",
        "only 1 x 1": folder / "dot.png",
        "50 million pixels": folder / "huge.png",
        "grey": folder / "grey.png",
        "transparent": folder / "clear.png",
        "is PNG inside": folder / "other.jpg",
        "is not a file": folder / "folder.png",
        "not a file": folder / "pipe.png",
        "no such file": folder / "none.png",
    }


def test_what_is_no_picture_is_said_in_one_sentence(tangy: Tangy, tmp_path: Path) -> None:
    for says, path in bad_pictures(tmp_path).items():
        done = tangy("read-card", path, "--json")
        assert (done.returncode, done.stdout) == (2, ""), path
        assert says in done.stderr and path.name in done.stderr
        assert done.stderr.count("\n") == 1
        with pytest.raises(PictureError, match=path.name):
            read_picture(path)


def test_a_picture_is_turned_as_it_was_taken(tmp_path: Path) -> None:
    picture = Image.new("RGB", (100, 70), (255, 0, 0))
    exif = picture.getexif()
    exif[0x0112] = 6  # the camera was held upright
    picture.save(tmp_path / "up.png", exif=exif)
    read = read_picture(tmp_path / "up.png")
    assert read.shape == (100, 70, 3) and read[0, 0].tolist() == [0, 0, 255]


def test_a_printed_picture_is_read_and_its_state_told(tangy: Tangy, tmp_path: Path) -> None:
    tangy("cards", "print", "--first", 42, "--count", 2, "--png", tmp_path, "--dpi", 60)
    files = [tmp_path / "card-042.png", tmp_path / "card-043.png"]
    done = tangy("read-card", *files, "--json")
    read = json.loads(done.stdout)
    assert [(row["card"], row["marked"], row["hidden"]) for row in read] == [
        (42, [], []),
        (43, [], []),
    ]
    assert [len(row["cells"]) for row in read] == [5, 5]
    numbers = json.loads((tmp_path / "cards.json").read_text())["cards"][0]["numbers"]
    missing = tangy("read-card", files[0], "--called", f"{numbers[0][0]},{numbers[3][1]}")
    assert "missed numbers" in missing.stdout
    right = json.loads(tangy("read-card", files[0], "--called", "", "--json").stdout)
    assert right[0]["state"] == "correctly marked"
    foreign = json.loads(tangy("read-card", files[0], "--deck-seed", 2, "--json").stdout)
    assert foreign[0]["card"] is None and foreign[0]["problem"]


def test_a_labelled_folder_is_counted(tangy: Tangy, tmp_path: Path) -> None:
    tangy("cards", "print", "--first", 7, "--count", 2, "--png", tmp_path, "--dpi", 60)
    labels = json.loads(tangy("read-card", *tmp_path.glob("*.png"), "--json").stdout)
    labels[0]["marked"] = [[0, 0]]
    (tmp_path / "labels.json").write_text(json.dumps(labels))
    counted = json.loads(tangy("read-card", "--bench", tmp_path, "--json").stdout)
    assert (counted["pictures"], counted["read"], counted["whole"]) == (2, 2, 1)
    assert counted["wrong_cells"] == 1 and counted["wrong_cards"] == 0
    (tmp_path / "labels.json").write_text('[{"file": "x.png", "card": "7"}]')
    done = tangy("read-card", "--bench", tmp_path)
    assert done.returncode == 2 and "entry 1" in done.stderr
    assert tangy("read-card", "--bench", tmp_path / "no").returncode == 2
    assert "no number of the deck" in tangy("read-card", "x.png", "--called", "99").stderr


def test_pictures_with_a_label_beside_them_are_counted(tangy: Tangy, tmp_path: Path) -> None:
    tangy("cards", "print", "--first", 7, "--count", 3, "--png", tmp_path, "--dpi", 60)
    (tmp_path / "cards.json").unlink()
    seen = json.loads(tangy("read-card", tmp_path / "card-007.png", "--json").stdout)[0]
    labels = {"card-007": True, "card-008": {"card": 8, "marked": []}, "card-009": None}
    for name, label in labels.items():
        told = {"file": f"{name}.png", "seen": seen, "label": label}
        (tmp_path / f"{name}.json").write_text(json.dumps(told))
    counted = json.loads(tangy("read-card", "--bench", tmp_path, "--json").stdout)
    assert (counted["pictures"], counted["whole"], counted["wrong_cells"]) == (2, 2, 0)
    (tmp_path / "card-008.json").write_text('{"file": "card-008.png", "label": 3}')
    assert "card-008.json" in tangy("read-card", "--bench", tmp_path).stderr
