"""Editing the library: every change is atomic, can be undone and redone, and loses nothing."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.codec import encode
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.errors import TangyError
from tangy_profiles.state import FRONT, ActivityState
from tangy_profiles.store import Store
from tangy_profiles.teaching_records import (
    DemonstrationBegun,
    DemonstrationFinished,
    DemonstrationStep,
    DemonstrationStepUndone,
)
from tangy_tui.learning.conflicts import shown_steps
from tangy_tui.learning.editing import Editor, NotPossible
from tangy_tui.learning.library import read_library
from tangy_tui.learning.library_entries import Library, NoDemonstration
from tests.support.append_body import append_body
from tests.support.laws import tried

BINGO = load_activity("bingo")


def logged(
    store: Store,
    id: str,
    behaviours: list[str],
    *,
    finished: bool = True,
    teacher: str = "Ada",
) -> None:
    """Log a demonstration in which each behaviour is the answer to the next situation."""
    append_body(
        store,
        DemonstrationBegun,
        {"demonstration": id, "activity": "bingo", "teacher": teacher, "seed": 1, "people": ["a"]},
    )
    for number, behaviour in enumerate(behaviours):
        situation = BINGO.situations[number % len(BINGO.situations)]
        state = ActivityState(number, situation, FRONT, None, ())
        step = Step(behaviour, None, state, state)
        append_body(store, DemonstrationStep, {"demonstration": id, **encode(step)})
    if finished:
        append_body(store, DemonstrationFinished, {"demonstration": id})


def editor_of(store: Store) -> Editor:
    names = (f"new{n}" for n in count(1))
    return Editor(store, BINGO, lambda: next(names))


@pytest.fixture
def editor(store: Store) -> Editor:
    """Three demonstrations of which two disagree about the first situation, and an editor."""
    logged(store, "aaa", ["greeting", "joke", "encourage"])
    logged(store, "bbb", ["joke", "joke"])
    logged(store, "ccc", ["greeting"])
    return editor_of(store)


def used(library: Library) -> dict[str, list[int]]:
    """Return the steps of every demonstration in use."""
    return {d.id: [step.id for step in d.steps] for d in library.finished}


def test_a_deleted_demonstration_is_unused_until_it_is_restored(editor: Editor) -> None:
    before = used(editor.library)
    editor.delete("2")
    assert set(used(editor.library)) == {"aaa", "ccc"}
    assert editor.library.find("bbb").hidden == "deleted"
    editor.restore("bbb")
    assert used(editor.library) == before


def test_merging_keeps_every_step_in_order_and_once(editor: Editor) -> None:
    steps = used(editor.library)
    editor.merge("ccc", "1")
    assert used(editor.library) == {"bbb": steps["bbb"], "new1": steps["ccc"] + steps["aaa"]}
    made = editor.library.entries["new1"].demonstration
    assert (made.origin, made.of, made.replayable) == ("merged", ("ccc", "aaa"), False)


def test_splitting_keeps_every_step_in_order_and_once(editor: Editor) -> None:
    steps = used(editor.library)
    editor.split("aaa", 1)
    now = used(editor.library)
    assert now == {
        "bbb": steps["bbb"],
        "ccc": steps["ccc"],
        "new1": steps["aaa"][:1],
        "new2": steps["aaa"][1:],
    }


def test_undo_reopens_a_resolved_conflict(editor: Editor) -> None:
    (conflict,) = editor.library.conflicts
    assert list(conflict.answers) == ["greeting", "joke"]
    editor.resolve(conflict, "greeting")
    assert editor.library.conflicts == []
    editor.undo()
    assert editor.library.conflicts == [conflict]
    editor.redo()
    assert editor.library.conflicts == []


def test_undo_starts_with_the_latest_edit(editor: Editor) -> None:
    before = used(editor.library)
    editor.merge("1", "2")
    editor.delete("new1")
    assert editor.undo().done.what == "delete"
    assert editor.undo().done.what == "merge"
    assert used(editor.library) == before
    assert editor.library.find("new1").hidden == "undone"  # policies may depend on it
    with pytest.raises(NotPossible, match="no change"):
        editor.undo()


def test_a_new_edit_clears_redo(editor: Editor) -> None:
    editor.delete("1")
    editor.undo()
    editor.delete("2")
    with pytest.raises(NotPossible, match="do again"):
        editor.redo()


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda e: e.delete("9"), "No demonstration is called '9'"),
        (lambda e: e.delete("zz"), "choose from 1 to 3"),
        (lambda e: e.delete(), "Name a demonstration"),
        (lambda e: e.delete("1", "aaa"), "named twice"),
        (lambda e: e.merge("1"), "needs two"),
        (lambda e: e.split("1", 3), "choose from 1 to 2"),
        (lambda e: e.split("ccc", 1), "too short"),
        (lambda e: e.restore("1"), "in use already"),
        (lambda e: e.resolve(e.library.conflicts[0]), "Say which"),
        (lambda e: e.resolve(e.library.conflicts[0], "greting"), "did you mean 'greeting'"),
    ],
)
def test_an_impossible_edit_is_refused_and_changes_nothing(
    change: Callable[[Editor], object], reason: str, editor: Editor, store: Store
) -> None:
    events = sum(1 for _ in store.events())
    with pytest.raises(TangyError, match=reason):
        change(editor)
    assert sum(1 for _ in store.events()) == events


def test_a_merged_demonstration_returns_only_by_undo(editor: Editor) -> None:
    editor.merge("1", "2")
    for wanted in ("1", "2"):
        with pytest.raises(NotPossible, match="was merged: undo"):
            editor.restore(wanted)
        with pytest.raises(NotPossible, match="not in use: merged"):
            editor.delete(wanted)


def test_parts_of_a_split_demonstration_ignore_its_later_changes(
    editor: Editor, store: Store
) -> None:
    steps = used(editor.library)
    editor.split("aaa", 2)
    append_body(store, DemonstrationStepUndone, {"demonstration": "aaa", "step": 3})
    now = used(editor.library)
    assert (now["new1"], now["new2"]) == (steps["aaa"][:2], steps["aaa"][2:])


def test_merged_steps_keep_their_teachers(editor: Editor, store: Store) -> None:
    logged(store, "ddd", ["joke"], teacher="Bea")
    editor.merge("aaa", "ddd")
    made = editor.library.entries["new1"].demonstration
    assert made.teacher == "Ada and Bea"
    told = [shown.teacher for shown in shown_steps([made])]
    assert told == ["Ada", "Ada", "Ada", "Bea"]


def test_only_one_of_two_versions_of_a_game_is_restored(editor: Editor, store: Store) -> None:
    editor.delete("aaa")
    body = {"activity": "bingo", "teacher": "Bea", "seed": 1, "people": ["a"]}
    again = {"demonstration": "bbb2", "origin": "again", "of": ["aaa"], "kept": 1, **body}
    append_body(store, DemonstrationBegun, again)
    append_body(store, DemonstrationFinished, {"demonstration": "bbb2"})
    with pytest.raises(NotPossible, match="was shown again: delete the new one"):
        editor.restore("aaa")


def test_an_undone_merge_returns_only_by_redo(editor: Editor) -> None:
    editor.merge("1", "2")
    editor.undo()
    with pytest.raises(NotPossible, match="demonstrations redo"):
        editor.restore("new1")


def test_an_unfinished_demonstration_is_not_merged(editor: Editor, store: Store) -> None:
    logged(store, "ddd", ["joke"], finished=False)
    with pytest.raises(NotPossible, match="not finished yet"):
        editor.merge("1", "ddd")


def test_demonstrations_are_found_by_number_id_or_prefix(editor: Editor) -> None:
    library = editor.library
    assert library.find("1") == library.find("aaa") == library.entries["aaa"]
    assert library.number("ccc") == 3
    with pytest.raises(NoDemonstration):
        library.find("aa")  # too short to be unique


def test_each_activity_has_its_own_edits(store: Store, lanterns: Activity, editor: Editor) -> None:
    editor.delete("1")
    other = Editor(store, lanterns)
    with pytest.raises(NotPossible):
        other.undo()


def test_a_complete_new_version_replaces_the_old_demonstration(store: Store) -> None:
    logged(store, "aaa", ["greeting", "joke", "encourage"])
    again = {
        "demonstration": "bbb",
        "activity": "bingo",
        "teacher": "Bea",
        "seed": 1,
        "people": ["a"],
        "origin": "again",
        "of": ["aaa"],
        "kept": 2,
    }
    append_body(store, DemonstrationBegun, again)
    library = read_library(store, "bingo")
    old, new = (library.entries[id].demonstration for id in ("aaa", "bbb"))
    assert new.steps == old.steps[:2]
    assert [s.id for s in new.steps] == [s.id for s in old.steps[:2]]
    assert used(library) == {"aaa": [s.id for s in old.steps]}
    append_body(store, DemonstrationStep, {"demonstration": "bbb", **encode(old.steps[2])})
    append_body(store, DemonstrationFinished, {"demonstration": "bbb"})
    library = read_library(store, "bingo")
    assert set(used(library)) == {"bbb"}
    assert library.entries["aaa"].hidden == "shown again"
    editor = editor_of(store)
    with pytest.raises(NotPossible, match="delete the new one"):
        editor.restore("aaa")
    editor.split("bbb", 1)
    assert "aaa" not in used(editor.library)
    editor.undo()
    editor.delete("bbb")
    assert set(used(editor.library)) == {"aaa"}


CHANGES = st.lists(
    st.tuples(
        st.sampled_from(("delete", "restore", "merge", "split", "resolve", "undo", "redo")),
        st.integers(1, 8),
        st.integers(1, 8),
    ),
    max_size=12,
)


@contextmanager
def empty_store() -> Iterator[Store]:
    with TemporaryDirectory() as folder, Store.open(Path(folder)) as opened, opened.transaction():
        yield opened


def change(editor: Editor, what: str, one: int, other: int) -> bool:
    """Try a change; return whether it was possible."""
    try:
        match what:
            case "delete" | "restore":
                getattr(editor, what)(str(one))
            case "merge":
                editor.merge(str(one), str(other))
            case "split":
                editor.split(str(one), other)
            case "resolve":
                conflicts = editor.library.conflicts
                if not conflicts:
                    return False
                editor.resolve(conflicts[0], *list(conflicts[0].answers)[: 1 + one % 2])
            case _:
                getattr(editor, what)()
    except TangyError:
        return False
    return True


def seen(editor: Editor) -> object:
    library = editor.library
    return used(library), library.resolutions, [c.situation for c in library.conflicts]


def editor_of_three(store: Store) -> Editor:
    """Log three demonstrations, two of which share steps."""
    logged(store, "aaa", ["greeting", "joke", "encourage"])
    logged(store, "bbb", ["joke", "joke"])
    logged(store, "ccc", ["greeting"])
    return editor_of(store)


@pytest.mark.slow
@given(CHANGES)
@tried(60)
def test_undo_and_redo_reverse_any_series_of_edits(
    changes: list[tuple[str, int, int]],
) -> None:
    with empty_store() as store:
        editor = editor_of_three(store)
        states = [seen(editor)]
        steps = {id for ids in used(editor.library).values() for id in ids}
        for what, one, other in changes:
            if what in ("undo", "redo"):
                continue
            if change(editor, what, one, other):
                states.append(seen(editor))
            else:
                assert seen(editor) == states[-1]
        everything = read_library(store, "bingo").entries.values()
        assert {s.id for e in everything for s in e.demonstration.steps} == steps
        for state in reversed(states[:-1]):
            editor.undo()
            assert seen(editor) == state
        for state in states[1:]:
            editor.redo()
            assert seen(editor) == state


@pytest.mark.slow
@given(CHANGES)
@tried(60)
def test_no_series_of_edits_uses_a_step_twice(
    changes: list[tuple[str, int, int]],
) -> None:
    with empty_store() as store:
        editor = editor_of_three(store)
        for what, one, other in changes:
            change(editor, what, one, other)
            ids = [id for steps in used(editor.library).values() for id in steps]
            assert len(ids) == len(set(ids))
            assert all(entry.demonstration.steps for entry in editor.library.entries.values())


def test_each_edit_is_one_event(editor: Editor, store: Store) -> None:
    for what in ("delete", "merge", "split", "resolve", "undo", "redo"):
        events = sum(1 for _ in store.events())
        assert change(editor, what, 1, 2 if what == "merge" else 1) or what in ("merge", "split")
        assert sum(1 for _ in store.events()) <= events + 1


def test_demonstrations_from_before_editing_are_read(store: Store) -> None:
    logged(store, "aaa", ["greeting"])
    (entry,) = read_library(store, "bingo").entries.values()
    old = entry.demonstration
    assert (old.origin, old.of, old.guided, old.steps[0].completed) == ("shown", (), False, True)
    assert replace(old, steps=()) == Demonstration("aaa", "bingo", "Ada", 1, ("a",), (), True)
