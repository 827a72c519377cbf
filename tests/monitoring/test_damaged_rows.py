"""A damaged row in the log is named and left out, and breaks nothing else."""

from __future__ import annotations

import json
import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing, suppress
from pathlib import Path
from random import Random
from subprocess import CompletedProcess
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tangy_profiles.activity import load_activity
from tangy_profiles.errors import TangyError
from tangy_profiles.events import kinds
from tangy_profiles.store import Store
from tangy_tui.app.workspace import Workspace
from tangy_tui.doctor import examine
from tangy_tui.interaction.feedback import Feedback
from tangy_tui.learning.demonstration_rows import heard_words, list_rows
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policies import changes, load_policy, stored_policies
from tangy_tui.monitoring.accepted import expected_effects, read_accepted
from tangy_tui.monitoring.drill_log import last_sheet, read_sheets
from tangy_tui.monitoring.games import read_games, uncleared
from tangy_tui.monitoring.log_check import log_problems
from tangy_tui.monitoring.replay import read_replays
from tangy_tui.monitoring.session import read_session
from tangy_tui.pages.session import session_page
from tangy_tui.text.documents import entry_document, library_document, person_document
from tangy_tui.text.log import replay_lines, session_lines
from tangy_tui.text.situations import edit_words
from tests.support.append_body import append_body
from tests.support.every_kind import write_every_kind

Tangy = Callable[..., CompletedProcess[str]]
BINGO = {"bingo": load_activity("bingo")}


@pytest.fixture(scope="session")
def _every_kind(_taught: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = Path(shutil.copytree(_taught, tmp_path_factory.mktemp("kinds") / "data"))
    write_every_kind(folder)
    return folder


@pytest.fixture
def every_kind(_every_kind: Path, tmp_path: Path) -> Path:
    """A data folder with events of every kind."""
    return Path(shutil.copytree(_every_kind, tmp_path / "kinds"))


def change(folder: Path, sql: str, *values: object) -> None:
    """Change events directly in the database, as damage does."""
    with closing(sqlite3.connect(folder / "tangy.db")) as db:
        db.executescript("DROP TRIGGER IF EXISTS unchanged; DROP TRIGGER IF EXISTS undeleted;")
        db.execute(sql, values)
        db.commit()


def seqs(folder: Path, kind: str) -> list[int]:
    with closing(sqlite3.connect(folder / "tangy.db")) as db:
        return [seq for (seq,) in db.execute("SELECT seq FROM event WHERE kind = ?", (kind,))]


def drop(folder: Path, seq: int, key: str) -> None:
    """Take a key out of the body of an event."""
    change(folder, f"UPDATE event SET body = json_remove(body, '$.{key}') WHERE seq = {seq}")  # noqa: S608


def put(folder: Path, seq: int, key: str, value: object) -> None:
    """Replace a value of an event's body."""
    sql = "UPDATE event SET body = json_set(body, '$.' || ?, ?) WHERE seq = ?"
    change(folder, sql, key, value, seq)


def read_all(folder: Path) -> None:
    """Read everything from a log that the verbs read; errors that people can correct may occur."""
    workspace = Workspace(folder, write=False)
    try:
        store, name = workspace.store, workspace.activity.name
        library_document(workspace)
        library = read_library(store, name)
        list_rows(workspace.activity, library)
        for entry in library.entries.values():
            heard_words(store, entry.demonstration)
        for edit in (*library.done, *library.undone):
            edit_words(workspace.activity, library, edit)
        games = read_games(store)
        for replay in read_replays(store, games, BINGO, workspace.names):
            list(replay_lines(replay, workspace.activity, workspace.name))
        if games:
            session = read_session(store, games, BINGO, workspace.names)
            list(session_lines(session))
            session_page(session)
        uncleared(store)
        for record in workspace.records():
            person_document(record)
            [entry_document(entry) for entry in record.history]
        workspace.persuasion(Random(1))
        workspace.game_seed(None)
        Feedback(store).last_change()
        read_accepted(store, name)
        read_sheets(store)
        last_sheet(store)
        try:
            policy, _ = load_policy(store, workspace.activity)
            [changes(kept, policy) for kept in stored_policies(store, name)]
            expected_effects(store, workspace.activity, policy)
        except TangyError as error:
            assert str(error).endswith(".")  # a sentence
        log_problems(store)
    finally:
        workspace.close()


# ------------------------------------------------------------------------------------- any damage

ODD = st.sampled_from(
    [None, 0, -1, 7, 10**30, -1e300, "x", "user9", [], [1], ["x"], {}, {"a": 1}, True, "\ud800"]
)
BROKEN = st.sampled_from(["{", "", "[]", "null", '{"game":NaN}', "[" * 5000, b"\xff{", b"\xff"])
COLUMNS = st.sampled_from(["at", "kind", "uuid", "robot", "person", "strategy", "complied", "seq"])


def places(value: Any, way: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the path to every value in a body."""
    keys = value if isinstance(value, dict) else range(len(value)) if _is_list(value) else ()
    return [one for key in keys for one in ((*way, key), *places(value[key], (*way, key)))]


def _text_or_bytes(read: bytes) -> str | bytes:
    try:
        return read.decode()
    except UnicodeDecodeError:
        return read


def _is_list(value: Any) -> bool:
    return isinstance(value, list)


@st.composite
def damages(draw: st.DrawFn) -> Callable[[sqlite3.Connection], None]:
    """Draw a possible damage of one row."""
    kind, place = draw(st.sampled_from(sorted(kinds()))), draw(st.integers(0, 10**6))
    how = draw(st.sampled_from(["inside", "inside", "inside", "body", "column"]))
    value, gone = draw(ODD), draw(st.booleans())
    broken, column = draw(BROKEN), draw(COLUMNS)

    def happen(db: sqlite3.Connection) -> None:
        rows = db.execute("SELECT seq, body FROM event WHERE kind = ?", (kind,)).fetchall()
        if not rows:
            return
        seq, text = rows[place % len(rows)]
        if how == "column":
            odd = value if isinstance(value, str | int | None) and value != "\ud800" else b"\xff"
            odd = 2**60 if odd == 10**30 else odd
            db.execute(f"UPDATE OR IGNORE event SET {column} = ? WHERE seq = ?", (odd, seq))  # noqa: S608
            return
        if how == "inside" and isinstance(text, str) and text.startswith('{"'):
            body = json.loads(text)
            ways = places(body)
            way = ways[place % len(ways)]
            inner = body
            for key in way[:-1]:
                inner = inner[key]
            if gone:
                del inner[way[-1]]
            else:
                inner[way[-1]] = value
            db.execute("UPDATE event SET body = ? WHERE seq = ?", (json.dumps(body), seq))
            return
        db.execute("UPDATE event SET body = cast(? AS TEXT) WHERE seq = ?", (broken, seq))

    return happen


def _survives(folder: Path, several: list[Callable[[sqlite3.Connection], None]]) -> None:
    with TemporaryDirectory() as scratch:
        copy = Path(shutil.copytree(folder, Path(scratch) / "data"))
        with closing(sqlite3.connect(copy / "tangy.db")) as db:
            db.executescript("DROP TRIGGER unchanged; DROP TRIGGER undeleted;")
            db.text_factory = _text_or_bytes  # a damaged row can be damaged again
            for damage in several:
                with suppress(sqlite3.IntegrityError):  # SQLite itself refuses it
                    damage(db)
            db.commit()
        read_all(copy)


@pytest.mark.slow
@settings(max_examples=8, deadline=None)  # and 500 in the slow test below
@given(several=st.lists(damages(), min_size=1, max_size=3))
def test_damaged_rows_break_no_reader_of_the_log(_every_kind: Path, several: Any) -> None:
    _survives(_every_kind, several)


@pytest.mark.slow
@settings(max_examples=500, deadline=None)
@given(several=st.lists(damages(), min_size=1, max_size=20))
def test_many_damaged_rows_break_no_reader_of_the_log(_every_kind: Path, several: Any) -> None:
    _survives(_every_kind, several)


# ----------------------------------------------------------------------------------------- reports

NEEDED = [
    ("demonstration begun", "seed", ("demonstrations", "list")),
    ("demonstration step", "state", ("demonstrations", "list")),
    ("demonstration step", "after", ("policy",)),
    ("demonstrations edited", "what", ("demonstrations", "list")),
    ("demonstrations edit undone", "edit", ("demonstrations", "list")),
    ("policy learnt", "activity", ("policy",)),
    ("policy learnt", "forest", ("policy",)),
    ("policy learnt", "demonstrations", ("policy",)),
    ("game begun", "people", ("log", "list")),
    ("game begun", "game", ("play", "--headless")),
    ("game step", "state", ("log", "show", "1")),
    ("game ended", "steps", ("log", "list")),
    ("fault", "criticality", ("log", "report", "all")),
    ("fault", "evidence", ("log", "list")),
    ("recovery", "kind", ("log", "report", "all")),
    ("staff action", "did", ("log", "report", "all")),
    ("strategy switched", "on", ("people", "list")),
    ("void", "of", ("people", "history", "user1")),
    ("effect accepted", "state", ("demonstrations", "accepted")),
    ("acceptance taken back", "number", ("demonstrations", "accepted")),
    ("drill", "answers", ("drill", "--scores")),
]


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "key", "verb"), NEEDED)
def test_a_verb_names_a_damaged_row_and_continues(
    every_kind: Path, tangy: Tangy, kind: str, key: str, verb: tuple[str, ...]
) -> None:
    seq = seqs(every_kind, kind)[0]
    drop(every_kind, seq, key)
    ran = tangy(*verb, "--data", every_kind)
    named = f"event {seq} ({kind}) is damaged and left out: it has no '{key}'"
    assert named in ran.stderr
    if (kind, verb) != ("policy learnt", ("policy",)):  # then nothing was learnt, it says
        assert ran.returncode == 0, ran.stderr


@pytest.mark.slow
def test_the_log_of_every_kind_has_an_event_of_every_kind(every_kind: Path) -> None:
    with Store.open(every_kind, write=False) as store:
        missing = kinds().keys() - store.kinds().keys()
    assert not missing, "let tests/support/every_kind.py write them"


@pytest.mark.slow
def test_doctor_and_store_check_name_every_bad_row(every_kind: Path, tangy: Tangy) -> None:
    assert tangy("store", "check", "--data", every_kind).returncode == 0
    step, fault = seqs(every_kind, "demonstration step")[7], seqs(every_kind, "fault")[1]
    change(every_kind, f"UPDATE event SET body = '{{' WHERE seq IN ({step}, {fault})")  # noqa: S608
    checked = tangy("store", "check", "--json", "--data", every_kind)
    problems = json.loads(checked.stdout)["problems"]
    assert checked.returncode == 1
    for seq, kind in ((step, "demonstration step"), (fault, "fault")):
        said = f"event {seq} ({kind}) is damaged and left out: its body is not JSON."
        assert any(said in problem for problem in problems)
    (found,) = (f for f in examine(every_kind, lambda _: None) if f.part == "data folder")
    assert (found.ok, found.broken) == (False, True)
    assert "`tangy store check` names them" in found.text


def test_store_check_names_a_demonstrated_step_unknown_to_the_activity(
    every_kind: Path, tangy: Tangy
) -> None:
    step = seqs(every_kind, "demonstration step")[7]
    put(every_kind, step, "behaviour", "call nummer")
    checked = tangy("store", "check", "--data", every_kind)
    assert checked.returncode == 1
    assert "is left out: Bingo has no" in checked.stdout and "call nummer" in checked.stdout


@pytest.mark.parametrize("kind", ["demonstration step", "game step"])
@pytest.mark.parametrize(("key", "value"), [("target", "user77"), ("state.users[1][0]", "user78")])
def test_store_check_names_a_step_with_unknown_people(
    every_kind: Path, tangy: Tangy, kind: str, key: str, value: str
) -> None:
    step = seqs(every_kind, kind)[5]
    put(every_kind, step, key, value)
    put(every_kind, step, key.replace("state", "after"), value)
    checked = tangy("store", "check", "--data", every_kind)
    assert checked.returncode == 1
    assert f"event {step} ({kind}): '{value}' took no part in the game." in checked.stdout


def test_store_check_names_a_game_step_unknown_to_the_activity(
    every_kind: Path, tangy: Tangy
) -> None:
    step = seqs(every_kind, "game step")[5]
    put(every_kind, step, "behaviour", "call nummer")
    checked = tangy("store", "check", "--data", every_kind)
    assert checked.returncode == 1
    assert f"event {step} (game step): Bingo has no 'call nummer'." in checked.stdout


@pytest.mark.parametrize(
    ("key", "value"), [("trees", 10**8), ("trees", 0), ("min_samples_leaf", 10**12)]
)
def test_a_policy_with_excessive_settings_is_left_out(
    every_kind: Path, tangy: Tangy, key: str, value: int
) -> None:
    kept = seqs(every_kind, "policy learnt")[-1]
    put(every_kind, kept, f"forest.{key}", value)
    ran = tangy("policy", "--data", every_kind)
    assert f"event {kept} (policy learnt) is damaged and left out: " in ran.stderr
    assert "is not a count from 1 to" in ran.stderr and "Traceback" not in ran.stderr


@pytest.mark.parametrize(
    ("key", "times", "told"),
    [
        ("demonstrations", 1000, "names a demonstration twice"),
        ("rows", 1000, "has two rows for a situation"),
        ("name", 1_500_000, "its body is too long"),
    ],
)
def test_a_policy_with_huge_lists_or_words_is_left_out(
    every_kind: Path, tangy: Tangy, key: str, times: int, told: str
) -> None:
    kept = seqs(every_kind, "policy learnt")[-1]
    with closing(sqlite3.connect(every_kind / "tangy.db")) as db:
        sql = "SELECT body FROM event WHERE seq = ?"
        body = json.loads(db.execute(sql, (kept,)).fetchone()[0])
    body[key] = body[key] * times
    change(every_kind, "UPDATE event SET body = ? WHERE seq = ?", json.dumps(body), kept)
    for verb in ("policy", "play"):
        ran = tangy(verb, *(["--headless"] if verb == "play" else []), "--data", every_kind)
        assert f"event {kept} (policy learnt) is damaged and left out: " in ran.stderr
        assert told in ran.stderr and "Traceback" not in ran.stderr


def test_an_unknown_kind_of_event_is_named(every_kind: Path, tangy: Tangy) -> None:
    change(every_kind, "UPDATE event SET kind = 'drlll' WHERE kind = 'drill'")
    checked = tangy("store", "check", "--data", every_kind)
    assert (checked.returncode, "'drlll' are not known" in checked.stdout) == (1, True)


def test_an_unknown_method_is_left_out(every_kind: Path, tangy: Tangy) -> None:
    chosen = seqs(every_kind, "method chosen")[-1]
    body = json.dumps({"chosen": {"method": "thomson"}})
    change(every_kind, "UPDATE event SET body = ? WHERE seq = ?", body, chosen)
    ran = tangy("people", "list", "--data", every_kind)
    assert ran.returncode == 0
    assert f"event {chosen} (method chosen)" in ran.stderr
    assert "'thomson' (did you mean 'thompson'?)" in ran.stderr


# -------------------------------------------------------------- events that depend on damaged ones


def steps_of(folder: Path, place: int) -> list[int]:
    with Store.open(folder, write=False) as store:
        entry = list(read_library(store, "bingo").entries.values())[place]
        return [step.id for step in entry.demonstration.steps]


def test_undoing_a_damaged_step_undoes_no_other(every_kind: Path) -> None:
    """The last demonstration had two steps undone and the first of these redone."""
    first, _ = seqs(every_kind, "demonstration step undone")
    with Store.open(every_kind, write=False) as store:
        chain = [e for e in store.events("demonstration step") if e.seq < first][-2:]
    before = steps_of(every_kind, 3)
    assert chain[0].seq in before and chain[1].seq not in before
    drop(every_kind, chain[1].seq, "state")
    assert steps_of(every_kind, 3) == [seq for seq in before if seq != chain[1].seq]


def test_an_undo_belongs_to_its_edit_despite_damage(every_kind: Path) -> None:
    """The split was undone and redone: without the split's row, the merge stays as it was."""
    merge, split, *_ = seqs(every_kind, "demonstrations edited")
    undone = seqs(every_kind, "demonstrations edit undone")[0]
    drop(every_kind, split, "kept")
    change(every_kind, "UPDATE event SET body = '{' WHERE kind = 'demonstrations edit redone'")
    with Store.open(every_kind, write=False) as store:
        library = read_library(store, "bingo")
        assert merge in [edit.seq for edit in library.done]
        assert f"event {undone} " in store.aside[undone]


def test_an_answer_whose_details_are_damaged_still_counts(every_kind: Path) -> None:
    (seq, *_) = seqs(every_kind, "response")
    with Store.open(every_kind, write=False) as store:
        counts = store.responses()
        answer = next(e for e in store.events("response") if e.seq == seq)
    change(every_kind, "UPDATE event SET body = '{' WHERE seq = ?", seq)
    with Store.open(every_kind, write=False) as store:
        assert store.responses() == counts
        assert seq in [event.seq for event in store.answers(answer.person or "")]
        assert "left out, but for the answer" in store.aside[seq]


def test_the_last_event_of_a_kind_is_the_last_that_can_be_read(every_kind: Path) -> None:
    *_, before, last = seqs(every_kind, "game begun")
    drop(every_kind, last, "game")
    with Store.open(every_kind, write=False) as store:
        found = store.last("game begun")
        assert found is not None and found.seq == before


def test_a_row_with_a_huge_number_is_read_at_once(every_kind: Path) -> None:
    (seq,) = seqs(every_kind, "drill")
    change(every_kind, "UPDATE event SET seq = ? WHERE seq = ?", 2**62, seq)
    with Store.open(every_kind, write=False) as store:
        assert [event.seq for event in store.events()][-1] == 2**62


def test_an_invalid_event_is_not_written(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        with pytest.raises(ValueError, match="has no 'seed'"):
            append_body(
                store,
                "demonstration begun",
                {"demonstration": "a", "activity": "bingo", "teacher": "b"},
            )
        with pytest.raises(ValueError, match="whom it is about"):
            append_body(store, "renamed", {})
        assert list(store.events()) == []
