"""Faces by ONNX files that a robot's profile names; the models here are made by hand."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any

import cv2
import numpy as np
import pytest

import tangy_profiles
from tangy_hw.perception.faces.face_detector import FaceError
from tangy_hw.perception.faces.onnx import OnnxReader
from tangy_hw.perception.faces.reader import HaarReader, open_reader
from tangy_profiles.errors import ProfileError
from tangy_profiles.robot import FaceModels, load_robot
from tests.hw.onnx_files import finder_file, recogniser_file

Tangy = Callable[..., CompletedProcess[str]]
SHIPPED = Path(tangy_profiles.__file__).parent / "robots" / "tangy.toml"


@pytest.fixture
def models(tmp_path: Path) -> FaceModels:
    """The two files."""
    (tmp_path / "finder.onnx").write_bytes(finder_file())
    (tmp_path / "recogniser.onnx").write_bytes(recogniser_file())
    return FaceModels(tmp_path / "finder.onnx", tmp_path / "recogniser.onnx")


def face(person: int, picture: int, *, unlike: float = 0.0) -> Any:
    """Make a picture that these models take for a face: squares around a green spot."""
    who, now = np.random.default_rng(person), np.random.default_rng((person, picture))
    squares: Any = np.repeat(who.integers(30, 220, (15, 25, 1)), 3, axis=2)
    squares = squares * now.uniform(1 - unlike, 1 + unlike, squares.shape[:2])[..., None]
    image: Any = cv2.resize(squares, (400, 240), interpolation=cv2.INTER_NEAREST)
    image = np.clip(image + now.normal(0, 12, image.shape), 0, 255).astype(np.uint8)
    image[96:112, 160:176] = (0, 255, 0)
    return image


def robot_file(folder: Path, finder: str, recogniser: str) -> Path:
    """Write a robot's profile that names two files beside it."""
    names = f'\n[faces]\nfinder = "{finder}"\nrecogniser = "{recogniser}"\n'
    path = folder / "robot.toml"
    path.write_text(SHIPPED.read_text(encoding="utf-8") + names, encoding="utf-8")
    return path


def test_faces_are_found_and_distinguished(models: FaceModels) -> None:
    reader = open_reader(models)
    (seen,) = reader.read(face(1, 1))
    assert seen.problem == "" and seen.vector is not None
    assert seen.box[0] == pytest.approx(128, abs=2) and seen.box[2] == pytest.approx(79, abs=2)
    again, other = reader.read(face(1, 2))[0].vector, reader.read(face(2, 1))[0].vector
    assert again is not None and other is not None
    assert float(seen.vector @ again) > 0.99 > float(seen.vector @ other)
    assert reader.read(np.full((240, 400, 3), 90, np.uint8)) == []


def test_a_large_picture_is_scaled_down_and_its_boxes_scaled_back(models: FaceModels) -> None:
    image = np.full((1536, 2560, 3), 90, np.uint8)
    image[192:224, 320:352] = (0, 255, 0)  # 16 pixels after scaling
    (seen,) = open_reader(models).read(image)
    assert seen.box == pytest.approx((257, 129, 158, 158), abs=4)


def test_the_haar_reader_is_the_default() -> None:
    assert load_robot().faces is None
    assert isinstance(open_reader(None), HaarReader)


def test_missing_or_broken_model_files_are_refused(models: FaceModels, tmp_path: Path) -> None:
    empty, text = tmp_path / "empty.onnx", tmp_path / "text.onnx"
    empty.write_bytes(b"")
    text.write_text("this is no model")
    cut = tmp_path / "cut.onnx"
    cut.write_bytes(finder_file()[:-300])
    for bad in (tmp_path / "none.onnx", empty, text, cut, tmp_path):
        for two in ((bad, models.recogniser), (models.finder, bad)):
            with pytest.raises(FaceError, match=bad.name) as refused:
                OnnxReader(*two)
            assert "\n" not in str(refused.value)


def test_a_model_with_another_interface_is_refused(models: FaceModels) -> None:
    with pytest.raises(FaceError, match="YuNet"):  # it finds none, fails, or does not load
        OnnxReader(models.recogniser, models.finder).read(face(1, 1))


@pytest.mark.slow
def test_the_verbs_use_the_robots_files(tangy: Tangy, models: FaceModels, tmp_path: Path) -> None:
    robot = robot_file(tmp_path, "finder.onnx", "recogniser.onnx")
    pictures = tmp_path / "pictures"
    pictures.mkdir()
    for number in range(4):
        cv2.imwrite(str(pictures / f"{number}.png"), face(1, number))
    new = tmp_path / "new.png"
    cv2.imwrite(str(new), face(1, 9))
    data = ("--robot", robot, "--json", "--data", tmp_path / "data")
    done = tangy("faces", "enrol", "Rosa", "--from", pictures, "--consent", "asked", *data)
    assert done.returncode == 2 and "move the head" in done.stderr  # pictures nearly the same
    for number in range(4):
        cv2.imwrite(str(pictures / f"{number}.png"), face(1, number, unlike=0.6))
    done = tangy("faces", "enrol", "Rosa", "--from", pictures, "--consent", "asked", *data)
    assert json.loads(done.stdout)["kind"].startswith("onnx"), done.stderr
    (row,) = json.loads(tangy("faces", "who", new, *data).stdout)
    assert row["nearest"] == "guest1"
    usual = tangy("faces", "who", new, "--json", "--data", tmp_path / "data")
    assert "Nobody's face is known yet" in usual.stderr  # the usual models know nobody
    missing = tangy("faces", "who", new, "--robot", robot_file(tmp_path, "no.onnx", "x.onnx"))
    assert missing.returncode == 2 and "no.onnx" in missing.stderr
    assert missing.stderr.count("\n") == 1


def test_a_profile_names_both_files_and_nothing_else(tmp_path: Path) -> None:
    path = robot_file(tmp_path, "a.onnx", "b.onnx")
    named = load_robot(str(path)).faces
    assert named == FaceModels(tmp_path / "a.onnx", tmp_path / "b.onnx")
    for wrong in ('[faces]\nfinder = "a"\n', '[faces]\nfinder = "a"\nrecogniser = "b"\nmore = 1\n'):
        path.write_text(SHIPPED.read_text(encoding="utf-8") + "\n" + wrong, encoding="utf-8")
        with pytest.raises(ProfileError, match="faces"):
            load_robot(str(path))
