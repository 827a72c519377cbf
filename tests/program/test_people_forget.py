"""`tangy people forget`: a confirmation, and the erasure of the name from the data folder."""

from __future__ import annotations

import json
import os
import pty
import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tangy_profiles.store import Store
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.own_phrases import OwnPhrases, own_phrases
from tangy_tui.learning.verification import Reply, Say
from tangy_tui.pages.page import document
from tests.support.append_body import append_body

Tangy = Callable[..., CompletedProcess[str]]

NAME = "Xanthippe"


def teach(folder: Path, *lines: str) -> None:
    """Teach by typed lines, each with a yes."""
    workspace = Workspace(folder)
    try:
        teaching = workspace.teaching("Ada", 3)
        teaching.begin()
        for line in lines:
            teaching.apply(Say(line))
            teaching.apply(Reply(True))
    finally:
        workspace.close()


@pytest.fixture
def data(tmp_path: Path) -> Path:
    """A data folder in which user2 is called Xanthippe, in every place for a name."""
    folder = tmp_path / "mine"
    with Store.open(folder) as store:
        store.rename("user2", NAME)
        store.pronounce("user2", "Z AE N TH IH P IY")
        store.rename("user3", "Xanthippe Rose")
        answered = append_body(
            store, "response", {"game": None}, person="user2", strategy="praise", complied=True
        )
        of = next(e.uuid for e in store.events() if e.seq == answered)
        append_body(
            store,
            "void",
            {"of": of, "why": f"{NAME} was asleep"},
            person="user2",
            strategy="praise",
        )
    teach(folder, "greet everyone", "go to XANTHIPPE", "go to xanthippe rose")
    shown = f"<p title='{NAME}'>{NAME}'s card, xanthippean</p>"
    (folder / "report.html").write_text(document("A report", f"of {NAME}", [shown]))
    (folder / "robot.log").write_text(f"said: {NAME}, I am coming to you.\n")
    (folder / "tangy.db.damaged-20260101T000000Z").write_bytes(b"\x00\x9auser2Xanthippe\x00")
    return folder


def bytes_of(folder: Path) -> bytes:
    return b"\n".join(path.read_bytes() for path in folder.rglob("*") if path.is_file())


def test_forgetting_erases_the_name_from_every_byte_of_the_data_folder(
    tangy: Tangy, data: Path
) -> None:
    assert bytes_of(data).lower().count(b"xanthippe") >= 9
    with Store.open(data, write=False) as store:
        before = [(e.seq, e.uuid, e.at, e.kind, e.person, e.complied) for e in store.events()]
    done = tangy("people", "forget", NAME, "--yes", "--json", "--data", data)
    told = json.loads(done.stdout)
    assert (done.returncode, told["id"], told["name_left_in_events"]) == (0, "user2", 0)
    assert told["events_changed"] == 2 and len(told["files_changed"]) == 3
    left = bytes_of(data).lower().replace(b"xanthippe rose", b"").replace(b"xanthippean", b"")
    assert b"xanthippe" not in left and b"z ae n th" not in left
    with Store.open(data) as store:
        after = [(e.seq, e.uuid, e.at, e.kind, e.person, e.complied) for e in store.events()]
        assert after[: len(before)] == before and [e[3] for e in after[len(before) :]] == [
            "forgotten"
        ]
        assert store.check() == [] and store.notices == []
        heard = [e.body["heard"] for e in store.events("demonstration step")]
        assert heard == ["greet everyone", "go to user2", "go to xanthippe rose"]
        assert store.file.db is not None
        with pytest.raises(sqlite3.IntegrityError, match="append only"):
            store.file.db.execute("UPDATE event SET body = '{}'")


def test_foreign_files_with_the_name_are_kept_and_listed(tangy: Tangy, data: Path) -> None:
    (data / "sub").mkdir()
    others = {
        data / "diary.txt": f"Lunch with {NAME} on Friday.",
        data / "sub" / "list.json": json.dumps({"said": "go to xanthippe"}),
        data / "sub" / "robot.log": f"said: {NAME}",
        data / "page.html": f"<p>{NAME}</p>",
        data / "tangy.db.notes": NAME,
    }
    for path, text in others.items():
        path.write_text(text)
    done = tangy("people", "forget", NAME, "--yes", "--json", "--data", data)
    told = json.loads(done.stdout)
    assert {path: path.read_text() for path in others} == others
    assert set(told["files_left"]) == set(map(str, others))
    assert len(told["files_changed"]) == 3


def test_a_misspelt_name_is_erased_from_copies_of_the_log(tangy: Tangy, tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    with Store.open(folder) as store:
        store.rename("user2", "Renée")
    teach(folder, "greet everyone", "go to rennee", "go to front", "go to user 1")
    for name in ("tangy.db.damaged-20260101T000000Z", "salvage-x/log"):
        (folder / name).parent.mkdir(exist_ok=True)
        shutil.copy(folder / "tangy.db", folder / name)
    assert bytes_of(folder).count(b"rennee") == 3
    done = tangy("people", "forget", "Renee", "--yes", "--json", "--data", folder)
    assert done.returncode == 0 and json.loads(done.stdout)["files_left"] == []
    left = bytes_of(folder)
    assert b"rennee" not in left and "Renée".encode() not in left
    assert left.count(b"go to user 1") == 3 and left.count(b"greet everyone") == 3
    with closing(sqlite3.connect(folder / "salvage-x" / "log")) as db:
        assert db.execute("PRAGMA integrity_check").fetchall() == [("ok",)]


def test_a_teachers_phrase_with_the_name_is_forgotten_and_the_others_work_on(
    tangy: Tangy, tmp_path: Path
) -> None:
    with closing(Workspace(tmp_path)) as workspace:
        workspace.store.rename("user2", "Rosa Weber")
        own = OwnPhrases(workspace.store, workspace.activity, workspace.teacher)
        own.note("rosa starts it all", "greeting", kept=True)
        own.note("let it all begin", "greeting", kept=True)
    shutil.copy(tmp_path / "tangy.db", tmp_path / "tangy.db.damaged-20260101T000000Z")
    assert bytes_of(tmp_path).count(b"rosa starts") == 2
    done = tangy("people", "forget", "Rosa Weber", "--yes", "--json", "--data", tmp_path)
    assert (done.returncode, json.loads(done.stdout)["events_changed"]) == (0, 1)
    assert b"rosa" not in bytes_of(tmp_path).lower()
    with closing(Workspace(tmp_path)) as workspace:
        kept = own_phrases(workspace.store, workspace.activity.name, workspace.teacher)
    assert kept == {"let it all begin": "greeting"}


def test_forgetting_beside_a_writer_changes_nothing(tangy: Tangy, data: Path) -> None:
    with Store.open(data):
        done = tangy("people", "forget", NAME, "--yes", "--data", data)
    assert done.returncode == 2 and done.stderr.count("\n") == 1
    assert NAME in (data / "robot.log").read_text()


def test_forgetting_beside_a_reader_asks_for_a_repeat(tangy: Tangy, data: Path) -> None:
    with closing(sqlite3.connect(data / "tangy.db")) as db:
        db.execute("BEGIN")
        db.execute("SELECT * FROM event").fetchone()
        done = tangy("people", "forget", NAME, "--yes", "--data", data)
        assert done.returncode == 2 and "forget once more" in done.stderr
    done = tangy("people", "forget", "user2", "--yes", "--data", data)
    assert done.returncode == 0
    left = bytes_of(data).lower().replace(b"xanthippe rose", b"").replace(b"xanthippean", b"")
    assert b"xanthippe" not in left


def test_also_erases_an_earlier_name(tangy: Tangy, data: Path) -> None:
    with Store.open(data) as store:
        store.rename("user2", "Rosa")
    done = tangy("people", "forget", "Rosa", "--also", NAME, "--yes", "--data", data)
    assert done.returncode == 0
    left = bytes_of(data).lower().replace(b"xanthippe rose", b"").replace(b"xanthippean", b"")
    assert b"xanthippe" not in left and b"rosa" not in left


def test_forgetting_mark_keeps_the_word_mark(tangy: Tangy, tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.rename("user2", "Mark")
    teach(tmp_path, "greet everyone", "go to mark")
    with Store.open(tmp_path) as store:
        step = store.last("demonstration step")
        assert step is not None
        again = {**step.body, "behaviour": "mark numbers", "heard": "mark numbers"}
        append_body(store, "demonstration step", again)
    assert tangy("people", "forget", "Mark", "--yes", "--data", tmp_path).returncode == 0
    with Store.open(tmp_path, write=False) as store:
        heard = [e.body["heard"] for e in store.events("demonstration step")]
        behaviours = [e.body["behaviour"] for e in store.events("demonstration step")]
    assert heard == ["greet everyone", "go to user2", "mark numbers"]
    assert behaviours[-1] == "mark numbers"


def test_a_teacher_of_the_same_name_is_kept_and_reported(tangy: Tangy, data: Path) -> None:
    with Store.open(data) as store:
        store.rename("user2", "Ada")
    done = tangy("people", "forget", "Ada", "--yes", "--data", data)
    assert "The name stays in 1 entry of the log, as a teacher's name." in done.stdout
    with Store.open(data, write=False) as store:
        begun = store.last("demonstration begun")
    assert begun is not None and begun.body["teacher"] == "Ada"


def test_forgetting_without_a_terminal_needs_the_option_yes(tangy: Tangy, data: Path) -> None:
    done = tangy("people", "forget", NAME, "--data", data)
    assert (done.returncode, done.stdout) == (2, "")
    assert "--yes" in done.stderr and "cannot be taken back" in done.stderr
    assert done.stderr.count("\n") == 1
    with Store.open(data, write=False) as store:
        assert store.names()["user2"] == NAME


@pytest.mark.slow
@pytest.mark.parametrize(("answer", "status", "there"), [("n", 1, True), ("y", 0, False)])
def test_forgetting_on_a_terminal_needs_a_confirmation(
    data: Path, answer: str, status: int, there: bool
) -> None:
    ours, theirs = pty.openpty()
    os.write(ours, f"{answer}\n".encode())
    start = [sys.executable, "-c", "from tangy_tui.cli import main; main()"]
    command = [*start, "people", "forget", NAME, "--data", str(data)]
    with subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=theirs) as program:  # noqa: S603
        os.close(theirs)
        shown = b""
        while True:
            try:
                more = os.read(ours, 4096)
            except OSError:
                break
            if not more:
                break
            shown += more
    os.close(ours)
    assert program.returncode == status, shown
    for word in (b"Xanthippe (user2)", b"voice", b"face", b"file", b"cannot be taken back"):
        assert word in b" ".join(shown.split())
    with Store.open(data, write=False) as store:
        assert (store.names().get("user2") == NAME) is there


@pytest.mark.parametrize("verb", [("teach", "--plain"), ("play", "--headless")])
@pytest.mark.parametrize(
    ("name", "why"),
    [("x" * 41, "at most 40"), ("a\x1b[2Jb", "cannot be shown"), (" ", "must not be empty")],
)
def test_a_teachers_name_has_the_limits_of_other_names(
    tangy: Tangy, tmp_path: Path, verb: tuple[str, ...], name: str, why: str
) -> None:
    done = tangy(*verb, "--teacher", name, "--data", tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert "teacher's name" in done.stderr and why in done.stderr


@pytest.mark.slow
def test_a_first_name_is_erased_from_commands_for_that_person(tangy: Tangy, tmp_path: Path) -> None:
    data = ("--data", tmp_path / "mine")
    assert tangy("people", "rename", "user1", "Rosa Weber", *data).returncode == 0
    typed = "greet everyone\ny\ncall number\ny\ngo to rosa\ny\ngo to frau weber\ny\n"
    tangy("teach", "--plain", "--seed", "1", *data, stdin=typed)
    with Store.open(tmp_path / "mine", write=False) as store:
        heard = [e.body.get("heard") for e in store.events() if e.body.get("target") == "user1"]
    assert any("rosa" in str(one) for one in heard), "it was said before"
    assert tangy("people", "forget", "Rosa Weber", "--yes", *data).returncode == 0
    left = bytes_of(tmp_path / "mine").lower()
    assert b"rosa" not in left and b"weber" not in left
