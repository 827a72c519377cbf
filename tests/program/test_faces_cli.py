"""`tangy faces`: who is known by the face, with consent, until it is taken back."""

from __future__ import annotations

import json
import stat
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import cv2
import pytest

from tangy_profiles.store import Store
from tests.hw.drawn_faces import drawn_face

Tangy = Callable[..., CompletedProcess[str]]


@pytest.fixture(scope="session")
def album(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folders with pictures of two people, five each, and one picture more of each of three."""
    folder = tmp_path_factory.mktemp("album")
    for person in range(2):
        (folder / str(person)).mkdir()
        for picture in range(5):
            cv2.imwrite(str(folder / str(person) / f"{picture}.png"), drawn_face(person, picture))
    for person in range(3):
        cv2.imwrite(str(folder / f"new-{person}.png"), drawn_face(person, 77))
    return folder


@pytest.fixture
def data(tmp_path: Path, album: Path, tangy: Tangy) -> Path:
    """A data folder in which Rosa, who plays, and Ben, who does not, are known."""
    folder = tmp_path / "mine"
    with Store.open(folder) as store:
        store.rename("user2", "Rosa")
    for name, pictures in (("Rosa", album / "0"), ("Ben", album / "1")):
        how = f"in writing; {name} was asked by staff"
        done = tangy("faces", "enrol", name, "--from", pictures, "--consent", how, "--data", folder)
        assert done.returncode == 0, done.stderr
    return folder


def test_the_enrolled_are_known_and_others_are_not(tangy: Tangy, album: Path, data: Path) -> None:
    pictures = [album / f"new-{person}.png" for person in range(3)]
    rows = json.loads(tangy("faces", "who", *pictures, "--json", "--data", data).stdout)
    assert [row["person"] for row in rows] == ["user2", "guest1", None]
    assert [row["name"] for row in rows] == ["Rosa", "Ben", None]
    told = tangy("faces", "who", *pictures, "--data", data).stdout.splitlines()
    assert "Rosa (user2)" in told[0] and "unknown" in told[2]


def test_without_consent_nothing_is_kept(tangy: Tangy, album: Path, tmp_path: Path) -> None:
    done = tangy("faces", "enrol", "user1", "--from", album / "0", "--data", tmp_path / "d")
    assert done.returncode == 2 and "has not agreed" in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "d" / "faces").exists()


def test_what_is_kept_is_for_its_owner_alone(data: Path) -> None:
    files = sorted((data / "faces").iterdir())
    assert len(files) == 2
    assert {stat.S_IMODE(path.stat().st_mode) for path in files} == {0o600}
    assert stat.S_IMODE((data / "faces").stat().st_mode) == 0o700


def test_the_log_says_who_agreed_how_without_a_name(tangy: Tangy, data: Path) -> None:
    rows = json.loads(tangy("faces", "list", "--json", "--data", data).stdout)
    assert [(row["id"], row["name"], row["pictures"]) for row in rows] == [
        ("guest1", "Ben", 5),
        ("user2", "Rosa", 5),
    ]
    assert rows[1]["how"] == "in writing; user2 was asked by staff"


def test_a_face_is_forgotten(tangy: Tangy, album: Path, data: Path) -> None:
    assert "is forgotten" in tangy("faces", "forget", "Rosa", "--data", data).stdout
    (row,) = json.loads(tangy("faces", "who", album / "new-0.png", "--json", "--data", data).stdout)
    assert row["person"] is None
    assert [path.name for path in (data / "faces").iterdir()] == ["hoglbp1-guest1.face"]
    again = tangy("faces", "enrol", "Rosa", "--from", album / "0", "--data", data)
    assert again.returncode == 2 and "has not agreed" in again.stderr


@pytest.mark.parametrize("who", ["Rosa", "guest1"])
def test_of_somebody_who_is_forgotten_nothing_is_left(tangy: Tangy, data: Path, who: str) -> None:
    name, id = ("Rosa", "user2") if who == "Rosa" else ("Ben", "guest1")
    with Store.open(data) as store:
        store.pronounce(id, "R OW Z AH")
        kept = next((data / "faces").glob(f"*-{id}.face")).read_bytes().partition(b"\n")[2]
    (data / "faces" / f".hoglbp1-{id}.face").write_bytes(kept)  # as if writing it had been cut off
    told = json.loads(tangy("people", "forget", who, "--json", "--data", data).stdout)
    assert (told["id"], told["name_left_in_events"]) == (id, 0)
    left = b"".join(path.read_bytes() for path in data.rglob("*") if path.is_file())
    assert name.encode() not in left and b"R OW Z AH" not in left
    assert kept[:64] not in left
    assert len(list((data / "faces").iterdir())) == 1
    assert id not in tangy("faces", "list", "--data", data).stdout
    assert "cannot" not in tangy("people", "list", "--data", data).stderr
