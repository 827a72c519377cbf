"""`tangy faces`: enrolment with consent, recognition, and forgetting."""

from __future__ import annotations

import io
import json
import shutil
import stat
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any

import cv2
import numpy as np
import pytest

from tangy_profiles.store import Store
from tangy_sim.rendering.faces import drawn_face

Tangy = Callable[..., CompletedProcess[str]]


@pytest.fixture(scope="session")
def album(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folders with five pictures of each of two people, and one more picture of each of three."""
    folder = tmp_path_factory.mktemp("album")
    for person in range(2):
        (folder / str(person)).mkdir()
        for picture in range(5):
            cv2.imwrite(str(folder / str(person) / f"{picture}.png"), drawn_face(person, picture))
    for person in range(3):
        cv2.imwrite(str(folder / f"new-{person}.png"), drawn_face(person, 77))
    return folder


@pytest.fixture(scope="session")
def _known(tmp_path_factory: pytest.TempPathFactory) -> Path:
    from tangy_hw.perception.faces.face_store import consent, keep_face
    from tangy_hw.perception.faces.reader import HaarReader

    folder, reader = tmp_path_factory.mktemp("known") / "data", HaarReader()
    with Store.open(folder) as store:
        for number, (person, name) in enumerate((("user2", "Rosa"), ("guest1", "Ben"))):
            store.rename(person, name)
            consent(store, person, True, f"in writing; {person} was asked by staff")
            seen = [reader.read(drawn_face(number, picture))[0].vector for picture in range(5)]
            keep_face(store, person, reader.kind, np.array(seen))
    return folder


@pytest.fixture
def data(_known: Path, tmp_path: Path) -> Path:
    """A data folder that knows Rosa, who plays, and Ben, who does not."""
    return Path(shutil.copytree(_known, tmp_path / "mine"))


@pytest.mark.slow
def test_only_enrolled_people_are_recognised(tangy: Tangy, album: Path, data: Path) -> None:
    pictures = [album / f"new-{person}.png" for person in range(3)]
    rows = json.loads(tangy("faces", "who", *pictures, "--json", "--data", data).stdout)
    assert [row["person"] for row in rows] == ["user2", "guest1", None]
    assert [row["name"] for row in rows] == ["Rosa", "Ben", None]
    told = tangy("faces", "who", *pictures, "--data", data).stdout.splitlines()
    assert "Rosa (user2)" in told[0] and "unknown" in told[2]


def test_nothing_is_stored_without_consent(tangy: Tangy, album: Path, tmp_path: Path) -> None:
    done = tangy("faces", "enrol", "user1", "--from", album / "0", "--data", tmp_path / "d")
    assert done.returncode == 2 and "has not agreed" in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "d" / "faces").exists()


@pytest.mark.slow
def test_an_enrolled_person_cannot_be_enrolled_as_another(
    tangy: Tangy, album: Path, data: Path
) -> None:
    before = sorted((path.name, path.read_bytes()) for path in (data / "faces").iterdir())
    done = tangy("faces", "enrol", "Rosa", "--from", album / "1", "--data", data)
    assert done.returncode == 2 and "do not look like Rosa as known" in done.stderr
    assert before == sorted((path.name, path.read_bytes()) for path in (data / "faces").iterdir())
    assert tangy("faces", "enrol", "Rosa", "--from", album / "0", "--data", data).returncode == 0


def test_a_failed_enrolment_stores_no_name(tangy: Tangy, tmp_path: Path) -> None:
    (tmp_path / "walls").mkdir()
    for number in range(4):
        wall = np.full((200, 200, 3), 90 + 20 * number, np.uint8)
        cv2.imwrite(str(tmp_path / "walls" / f"{number}.png"), wall)
    where = ("--from", tmp_path / "walls", "--consent", "Anna said so", "--data", tmp_path / "d")
    assert tangy("faces", "enrol", "Mathilda", *where).returncode == 2
    kept = b"".join(path.read_bytes() for path in (tmp_path / "d").rglob("*") if path.is_file())
    assert b"Mathilda" not in kept and b"Anna" not in kept


def test_options_before_a_verb_apply_to_the_verb(tangy: Tangy, data: Path) -> None:
    shown = tangy("--data", data, "faces", "list")
    assert shown.stdout == tangy("faces", "list", "--data", data).stdout
    assert "Rosa" in shown.stdout
    assert "Rosa" not in tangy("--data", data, "faces", "list", "--data", data / "other").stdout


def test_each_of_several_faces_in_a_picture_is_reported(tangy: Tangy, data: Path) -> None:
    side_by_side = np.hstack([drawn_face(1, 30), drawn_face(0, 30)])
    cv2.imwrite(str(data / "two.png"), side_by_side)
    (row,) = json.loads(tangy("faces", "who", data / "two.png", "--json", "--data", data).stdout)
    assert sorted(face["name"] for face in row["faces"]) == ["Ben", "Rosa"]
    told = tangy("faces", "who", data / "two.png", "--data", data).stdout
    assert "Rosa (user2)" in told and "Ben (guest1)" in told and "also" in told


@pytest.mark.slow
@pytest.mark.parametrize(("answer", "kept"), [("y\n", True), ("n\n", False), ("\n", False)])
def test_a_terminal_asks_the_person_for_consent(
    tangy: Tangy,
    album: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    answer: str,
    kept: bool,
) -> None:
    class Keyboard(io.StringIO):
        def isatty(self) -> bool:
            return True

    monkeypatch.setattr(io, "StringIO", Keyboard)
    asked = ("faces", "enrol", "user1", "--from", album / "0", "--data", tmp_path / "d")
    done = tangy(*asked, stdin=answer)
    assert "User 1, may Tangy know your face?" in done.stderr
    assert (done.returncode == 0) == kept == (tmp_path / "d" / "faces").exists()
    if kept:
        assert "may Tangy" not in tangy(*asked).stderr  # consent was given before


def test_the_form_of_consent_is_logged_without_names(
    tangy: Tangy, album: Path, tmp_path: Path
) -> None:
    how = "Bob said yes; bob was asked by staff"
    asked = ("--from", album / "0", "--consent", how, "--data", tmp_path / "d")
    assert tangy("faces", "enrol", "Bob", *asked).returncode == 0
    (row,) = json.loads(tangy("faces", "list", "--json", "--data", tmp_path / "d").stdout)
    assert (row["id"], row["name"]) == ("guest1", "Bob")
    assert row["how"] == "guest1 said yes; guest1 was asked by staff"


def test_face_files_are_private(data: Path) -> None:
    files = sorted((data / "faces").iterdir())
    assert len(files) == 2
    assert {stat.S_IMODE(path.stat().st_mode) for path in files} == {0o600}
    assert stat.S_IMODE((data / "faces").stat().st_mode) == 0o700


def test_consent_is_listed_by_person_and_form(tangy: Tangy, data: Path) -> None:
    rows = json.loads(tangy("faces", "list", "--json", "--data", data).stdout)
    assert [(row["id"], row["name"], row["pictures"]) for row in rows] == [
        ("guest1", "Ben", 5),
        ("user2", "Rosa", 5),
    ]
    assert rows[1]["how"] == "in writing; user2 was asked by staff"


def test_a_face_can_be_forgotten(tangy: Tangy, album: Path, data: Path) -> None:
    assert "face is forgotten." in tangy("faces", "forget", "Rosa", "--data", data).stdout
    (row,) = json.loads(tangy("faces", "who", album / "new-0.png", "--json", "--data", data).stdout)
    assert row["person"] is None
    assert [path.name for path in (data / "faces").iterdir()] == ["hoglbp1-guest1.face"]
    again = tangy("faces", "enrol", "Rosa", "--from", album / "0", "--data", data)
    assert again.returncode == 2 and "has not agreed" in again.stderr


@pytest.mark.parametrize("who", ["Rosa", "guest1"])
def test_forgetting_a_person_leaves_no_data(tangy: Tangy, data: Path, who: str) -> None:
    name, id = ("Rosa", "user2") if who == "Rosa" else ("Ben", "guest1")
    with Store.open(data) as store:
        store.pronounce(id, "R OW Z AH")
        kept = next((data / "faces").glob(f"*-{id}.face")).read_bytes().partition(b"\n")[2]
    (data / "faces" / f".hoglbp1-{id}.face").write_bytes(kept)  # as if writing had been cut off
    told = json.loads(tangy("people", "forget", who, "--yes", "--json", "--data", data).stdout)
    assert (told["id"], told["name_left_in_events"]) == (id, 0)
    left = b"".join(path.read_bytes() for path in data.rglob("*") if path.is_file())
    assert name.encode() not in left and b"R OW Z AH" not in left
    assert kept[:64] not in left
    assert len(list((data / "faces").iterdir())) == 1
    assert id not in tangy("faces", "list", "--data", data).stdout
    assert "cannot" not in tangy("people", "list", "--data", data).stderr


def test_an_invalid_picture_is_refused_in_one_sentence(tangy: Tangy, data: Path) -> None:
    dot, torn, text = data / "dot.png", data / "torn.png", data / "text.png"
    cv2.imwrite(str(dot), drawn_face(0)[:1, :1])
    cv2.imwrite(str(torn), drawn_face(0))
    torn.write_bytes(torn.read_bytes()[:2000])
    text.write_text("no picture")
    for path in (dot, torn, text, data / "none.png", data):
        done = tangy("faces", "who", path, "--json", "--data", data)
        assert (done.returncode, done.stdout) == (2, "")
        assert path.name in done.stderr and done.stderr.count("\n") == 1


def test_grey_pictures_are_accepted(tangy: Tangy, data: Path) -> None:
    cv2.imwrite(str(data / "grey.jpg"), cv2.cvtColor(drawn_face(0, 9), cv2.COLOR_BGR2GRAY))
    (row,) = json.loads(tangy("faces", "who", data / "grey.jpg", "--json", "--data", data).stdout)
    assert row["name"] == "Rosa"


def test_a_picture_without_a_face_is_reported(tangy: Tangy, data: Path) -> None:
    cv2.imwrite(str(data / "wall.png"), drawn_face(0)[:60, :100] * 0 + 120)
    done = tangy("faces", "who", data / "wall.png", "--data", data)
    assert done.returncode == 0 and "no face is seen" in done.stdout
    (row,) = json.loads(tangy("faces", "who", data / "wall.png", "--json", "--data", data).stdout)
    assert (row["person"], row["likeness"], row["faces"]) == (None, None, [])


@pytest.mark.slow
def test_bad_pictures_of_a_folder_are_named_with_the_reason(
    tangy: Tangy, album: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "mixed"
    folder.mkdir()
    for picture in range(4):
        cv2.imwrite(str(folder / f"{picture}.png"), drawn_face(0, picture))
    (folder / "4.png").write_text("no picture")
    cv2.imwrite(str(folder / "5.png"), drawn_face(0, 5, light=0.1))
    cv2.imwrite(str(folder / "6.png"), drawn_face(0, 3))
    how = ("--consent", "asked", "--data", tmp_path / "d")
    done = tangy("faces", "enrol", "user1", "--from", folder, "--json", *how)
    told = {row["file"]: row["problem"] for row in json.loads(done.stdout)["from"]}
    assert [told[f"{picture}.png"] for picture in range(4)] == [""] * 4
    assert "is not a picture" in told["4.png"] and told["5.png"]
    assert "what another one shows" in told["6.png"]
    said = tangy("faces", "enrol", "user1", "--from", folder, *how).stdout
    assert "4.png: is not a picture" in said and "from 4 pictures. With" in said
    (folder / "1.png").unlink()
    (folder / "2.png").unlink()
    done = tangy("faces", "enrol", "user1", "--from", folder, *how)
    assert done.returncode == 2 and "only 2 of 5" in done.stderr
    (row,) = json.loads(tangy("faces", "list", "--json", "--data", tmp_path / "d").stdout)
    assert row["pictures"] == 4  # the earlier ones


def test_more_pictures_can_be_added(tangy: Tangy, album: Path, data: Path, tmp_path: Path) -> None:
    cv2.imwrite(str(tmp_path / "more.png"), drawn_face(0, 50))
    done = tangy("faces", "enrol", "Rosa", "--from", tmp_path / "more.png", "--add", "--data", data)
    assert "from 6 pictures. With" in done.stdout


def test_a_similar_enrolled_person_is_reported(tangy: Tangy, album: Path, data: Path) -> None:
    done = tangy("faces", "enrol", "Eve", "--from", album / "0", "--consent", "x", "--data", data)
    assert "also look like Rosa (user2)" in done.stdout


@pytest.mark.slow
def test_a_video_enrols_and_its_frames_vote(tangy: Tangy, data: Path, tmp_path: Path) -> None:
    video = tmp_path / "video.avi"
    code = cv2.VideoWriter.fourcc(*"MJPG")
    writer = cv2.VideoWriter(str(video), code, 10, (200, 200))
    for picture in range(6):
        writer.write(drawn_face(4, 20 + picture))
    writer.release()
    found = ("--from", video, "--json", "--data", data)
    (row,) = json.loads(tangy("faces", "who", *found).stdout)
    assert (row["person"], row["frames"]) == (None, 5)
    done = tangy("faces", "enrol", "Zoe", *found, "--consent", "asked")
    assert json.loads(done.stdout)["pictures"] == 6, done.stderr
    (row,) = json.loads(tangy("faces", "who", *found).stdout)
    assert (row["name"], row["votes"], row["frames"]) == ("Zoe", 5, 5)


def test_pictures_of_one_person_vote(tangy: Tangy, album: Path, data: Path) -> None:
    pictures = [album / "0" / "1.png", album / "0" / "2.png", album / "new-0.png"]
    (row,) = json.loads(
        tangy("faces", "who", *pictures, "--together", "--json", "--data", data).stdout
    )
    assert (row["name"], row["votes"], len(row["files"])) == ("Rosa", 3, 3)


def test_a_damaged_face_file_is_reported_in_one_sentence(tangy: Tangy, data: Path) -> None:
    path = data / "faces" / "hoglbp1-user2.face"
    path.write_bytes(path.read_bytes()[:-7])
    for asked in (("list",), ("who", data / "x.png")):
        done = tangy("faces", *asked, "--data", data)
        assert done.returncode == 2 and "is broken" in done.stderr
        assert done.stderr.count("\n") == 1
    assert tangy("faces", "forget", "user2", "--data", data).returncode == 0
    assert tangy("faces", "list", "--data", data).returncode == 0


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("who",), "Give pictures"),
        (("who", "x.png", "--from", "0"), "Give pictures"),
        (("who", "--from", "none.avi"), "no such file"),
        (("who", "x.png", "--robot", "none"), "There is no robot"),
        (("enrol", "user1", "--from", "none"), "no such file"),
        (("enrol", "user1", "--from", ".", "--consent", ""), "no pictures"),
        (("enrol", " ", "--from", "x.png", "--consent", "x"), "no such file"),
        (("forget", "nobody"), "There is nobody called"),
    ],
)
def test_mistakes_are_reported_in_one_sentence(
    tangy: Tangy, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: Any, says: str
) -> None:
    monkeypatch.chdir(tmp_path)
    done = tangy("faces", *arguments, "--data", tmp_path / "d")
    assert done.returncode == 2 and says in done.stderr and done.stderr.count("\n") == 1


@pytest.mark.slow
def test_an_invalid_name_stores_nothing(tangy: Tangy, album: Path, tmp_path: Path) -> None:
    for name in (" ", "x" * 50, "a\x1bb", "front"):
        done = tangy(
            "faces",
            "enrol",
            name,
            "--from",
            album / "0",
            "--consent",
            "x",
            "--data",
            tmp_path / "d",
        )
        assert done.returncode == 2 and done.stderr.count("\n") == 1, name
        assert not (tmp_path / "d" / "faces").exists()
    with Store.open(tmp_path / "d", write=False) as store:
        assert store.names() == {} and list(store.events()) == []
