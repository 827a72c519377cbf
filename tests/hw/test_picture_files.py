"""Pictures of all kinds are read; other files are refused in one sentence that names them."""

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
    (folder / "folder.png").mkdir()
    os.mkfifo(folder / "pipe.png")
    return {
        "is not a picture": folder / "text.png",
        "not a picture (": folder / "empty.jpg",
        "breaks off": folder / "half-whole.png",
        "breaks off or": folder / "half-whole.jpg",
        "only 1 x 1": folder / "dot.png",
        "50 million pixels": folder / "huge.png",
        "is not a file": folder / "folder.png",
        "not a file": folder / "pipe.png",
        "no such file": folder / "none.png",
    }


@pytest.mark.slow
def test_a_file_that_is_no_picture_is_refused_in_one_sentence(tangy: Tangy, tmp_path: Path) -> None:
    for says, path in bad_pictures(tmp_path).items():
        done = tangy("read-card", path, "--json")
        assert (done.returncode, done.stdout) == (2, ""), path
        assert says in done.stderr and path.name in done.stderr
        assert done.stderr.count("\n") == 1
        with pytest.raises(PictureError, match=path.name):
            read_picture(path)


def test_good_pictures_are_read_beside_bad_ones(tangy: Tangy, tmp_path: Path) -> None:
    tangy("cards", "print", "--first", 42, "--count", 1, "--png", tmp_path, "--dpi", 60)
    (tmp_path / "text.png").write_text("hello")
    files = [tmp_path / "text.png", tmp_path / "card-042.png", tmp_path / "none.png"]
    done = tangy("read-card", *files, "--json")
    assert done.returncode == 2 and done.stderr.count("\n") == 2
    assert [row["card"] for row in json.loads(done.stdout)] == [42]


@pytest.fixture
def card(tangy: Tangy, tmp_path: Path) -> Image.Image:
    """The printed card 42."""
    tangy("cards", "print", "--first", 42, "--count", 1, "--png", tmp_path, "--dpi", 60)
    return Image.open(tmp_path / "card-042.png")


@pytest.mark.parametrize(
    ("kind", "file", "says"),
    [
        ("L", "a.png", "is grey"),
        ("1", "a.png", "is grey"),
        ("I;16", "a.png", "is grey"),
        ("LA", "a.png", "has transparent parts"),
        ("RGBA", "a.png", "has transparent parts"),
        ("RGB", "a.jpg", "is PNG inside; name it .png"),
    ],
)
def test_pictures_without_true_colours_are_refused_for_cards(
    kind: str, file: str, says: str, card: Image.Image, tangy: Tangy, tmp_path: Path
) -> None:
    path = tmp_path / file
    if kind == "I;16":
        Image.fromarray(np.asarray(card.convert("L")).astype(np.uint16) * 257).save(path, "PNG")
    else:
        card.convert(kind).save(path, "PNG")
    done = tangy("read-card", path, "--json")
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert f"{path}: {says}" in done.stderr
    assert read_picture(path).shape == (card.height, card.width, 3)  # grey is enough for faces


@pytest.mark.parametrize(("kind", "file"), [("P", "a.png"), ("RGB", "a.jpeg"), ("CMYK", "a.tiff")])
def test_a_card_is_read_from_colours_of_any_kind(
    kind: str, file: str, card: Image.Image, tangy: Tangy, tmp_path: Path
) -> None:
    card.convert(kind).save(tmp_path / file)
    done = tangy("read-card", tmp_path / file, "--json")
    assert done.returncode == 0, done.stderr
    [row] = json.loads(done.stdout)
    keys = ["file", "card", "marked", "hidden", "confidence", "cells", "cards", "problem"]
    assert [*row] == keys
    assert (row["card"], row["marked"], row["hidden"]) == (42, [], [])
    assert (row["cards"], row["problem"]) == ([42], "")


@pytest.mark.slow
def test_no_card_is_read_if_a_picture_shows_several(tangy: Tangy, tmp_path: Path) -> None:
    tangy("cards", "print", "--first", 42, "--count", 2, "--png", tmp_path, "--dpi", 60)
    one, other = (Image.open(tmp_path / f"card-04{last}.png") for last in (2, 3))
    both = Image.new("RGB", (one.width * 2, one.height), (120, 90, 60))
    both.paste(one, (0, 0))
    both.paste(other, (one.width, 0))
    both.paste((200, 170, 150), (0, 0, one.width, one.height // 4))  # a sleeve on the upper tags
    both.save(tmp_path / "both.png")
    done = tangy("read-card", tmp_path / "both.png", "--called", "1,2")
    assert done.returncode == 0 and done.stderr == ""
    assert "two cards in sight: 42 and 43; which one is meant cannot be told" in done.stdout
    done = tangy("read-card", tmp_path / "both.png", "--called", "1,2", "--json")
    [row] = json.loads(done.stdout)
    assert done.returncode == 0
    assert (row["card"], row["marked"], row["cards"]) == (None, [], [42, 43])
    assert row["state"] == "occluded" and row["problem"] == "two cards in sight: 42 and 43"
    files = [tmp_path / "both.png", tmp_path / "card-043.png"]
    [row] = json.loads(tangy("read-card", *files, "--together", "--json").stdout)
    assert row["card"] is None


@pytest.mark.slow
def test_the_reading_is_drawn_into_the_picture(tangy: Tangy, tmp_path: Path) -> None:
    tangy("cards", "print", "--first", 42, "--count", 1, "--png", tmp_path, "--dpi", 60)
    done = tangy("read-card", tmp_path / "card-042.png", "--draw", tmp_path / "drawn")
    assert done.returncode == 0 and "card 42, 0 marked" in done.stdout
    drawn = read_picture(tmp_path / "drawn" / "card-042-read.png")
    assert drawn.shape == read_picture(tmp_path / "card-042.png").shape
    assert (drawn[..., 0] > drawn[..., 2] + 100).any()  # the grid, in blue


@pytest.mark.slow
def test_pictures_of_one_card_are_read_together(tangy: Tangy, tmp_path: Path) -> None:
    tangy("cards", "print", "--first", 42, "--count", 1, "--png", tmp_path, "--dpi", 60)
    whole = Image.open(tmp_path / "card-042.png")
    for name, box in (("a", (60, 130, 140, 210)), ("b", (200, 300, 280, 380))):
        part = whole.copy()
        part.paste((120, 150, 210), box)
        part.save(tmp_path / f"{name}.png")
    files = [tmp_path / "a.png", tmp_path / "b.png"]
    each = json.loads(tangy("read-card", *files, "--json").stdout)
    assert all(row["hidden"] for row in each)
    assert "--together" in tangy("read-card", *files).stdout
    [one] = json.loads(tangy("read-card", *files, "--together", "--json").stdout)
    assert (one["file"], one["card"], one["hidden"]) == (str(files[0]), 42, [])
    refused = tangy("read-card", *files, "--together", "--method", "paper")
    assert refused.returncode == 2 and refused.stderr.count("\n") == 1


def test_a_picture_is_rotated_by_its_exif_orientation(tmp_path: Path) -> None:
    picture = Image.new("RGB", (100, 70), (255, 0, 0))
    exif = picture.getexif()
    exif[0x0112] = 6  # the camera was held upright
    picture.save(tmp_path / "up.png", exif=exif)
    read = read_picture(tmp_path / "up.png")
    assert read.shape == (100, 70, 3) and read[0, 0].tolist() == [0, 0, 255]


@pytest.mark.slow
def test_a_printed_card_is_read_with_its_state(tangy: Tangy, tmp_path: Path) -> None:
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
    assert foreign[0]["card"] is None
    assert "not a card of this deck" in tangy("read-card", files[0], "--deck-seed", 2).stdout


@pytest.mark.slow
def test_a_labelled_folder_is_evaluated(tangy: Tangy, tmp_path: Path) -> None:
    tangy("cards", "print", "--first", 7, "--count", 2, "--png", tmp_path, "--dpi", 60)
    labels = json.loads(tangy("read-card", *tmp_path.glob("*.png"), "--json").stdout)
    labels[0]["marked"] = [[0, 0]]
    (tmp_path / "labels.json").write_text(json.dumps(labels))
    counted = json.loads(tangy("read-card", "--bench", tmp_path, "--json").stdout)
    assert (counted["pictures"], counted["read"], counted["whole"]) == (2, 2, 1)
    assert counted["wrong_cells"] == 1 and counted["wrong_cards"] == 0
    assert "cells read wrongly" in tangy("read-card", "--bench", tmp_path).stdout
    (tmp_path / "labels.json").write_text('[{"file": "x.png", "card": "7"}]')
    done = tangy("read-card", "--bench", tmp_path)
    assert done.returncode == 2 and "entry 1" in done.stderr
    assert tangy("read-card", "--bench", tmp_path / "no").returncode == 2
    assert "no number of the deck" in tangy("read-card", "x.png", "--called", "99").stderr


@pytest.mark.slow
def test_pictures_with_label_files_are_evaluated(tangy: Tangy, tmp_path: Path) -> None:
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


@pytest.mark.slow
def test_captured_pictures_are_confirmed_and_evaluated(tangy: Tangy, tmp_path: Path) -> None:
    tangy("cards", "print", "--first", 7, "--count", 2, "--png", tmp_path / "in", "--dpi", 60)
    kept = tmp_path / "kept"
    done = tangy("capture", kept, "--from", tmp_path / "in", "--cards", "--seconds", 60)
    assert done.returncode == 0, done.stderr
    assert "card 7: 0 marked" in done.stdout
    for beside in sorted(kept.glob("*.json")):
        told = json.loads(beside.read_text())
        beside.write_text(json.dumps({**told, "label": True}))
    counted = json.loads(tangy("read-card", "--bench", kept, "--json").stdout)
    assert (counted["with_card"], counted["whole"], counted["wrong_cells"]) == (2, 2, 0)


@pytest.mark.slow
def test_a_hidden_cell_that_decides_the_state_is_reported(
    card: Image.Image, tangy: Tangy, tmp_path: Path
) -> None:
    wide, high = card.size
    card.paste((120, 150, 210), (wide // 6, high // 4, wide // 3, high // 2))
    card.save(tmp_path / "hand.png")
    numbers = json.loads((tmp_path / "cards.json").read_text())["cards"][0]["numbers"]
    [row] = json.loads(tangy("read-card", tmp_path / "hand.png", "--json").stdout)
    line, column = row["hidden"][0]
    done = tangy("read-card", tmp_path / "hand.png", "--called", numbers[line][column])
    assert "card 42" in done.stdout
    assert "hangs on what is not to be told" in done.stdout
