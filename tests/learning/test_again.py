"""Redo after undo, new versions of a game from a step on, and guided games that cover all."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import StoreError, TangyError
from tangy_profiles.store import Store
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policy import learn_policy
from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.learning.teaching_events import Again, Begun, Executed, Redo, StepUndone, Undo
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import Refused, Reply, Say

YES = Reply(yes=True)


@contextmanager
def opened(folder: Path, users: int = 4) -> Iterator[Workspace]:
    workspace = Workspace(folder, users=users)
    try:
        with workspace.store.transaction():  # wait for the disk only once
            yield workspace
    finally:
        workspace.close()


def begun(
    workspace: Workspace, teacher: str = "Ada", again: Again | None = None
) -> TeachingSession:
    teaching = workspace.teaching(teacher, None, again=again)
    teaching.begin()
    return teaching


def steps(teaching: TeachingSession, count: int) -> None:
    teacher = ScriptedTeacher(teaching)
    while len(teaching.demonstration.steps) < count:
        teaching.apply(teacher.command())


def kept(workspace: Workspace, id: str) -> Demonstration:
    return read_library(workspace.store, workspace.activity.name).entries[id].demonstration


def test_redo_restores_an_undone_step_exactly(workspace: Workspace) -> None:
    teaching = begun(workspace)
    steps(teaching, 5)
    before = teaching.demonstration
    teaching.apply(Undo())
    teaching.apply(Undo())
    (done,) = teaching.apply(Redo())
    assert isinstance(done, Executed)
    assert done.step == before.steps[3]
    teaching.apply(Redo())
    assert teaching.demonstration == before == kept(workspace, before.id)
    assert [s.id for s in teaching.demonstration.steps] == [s.id for s in before.steps]
    assert isinstance(teaching.apply(Redo())[0], Refused)


def test_a_new_step_clears_redo(workspace: Workspace) -> None:
    teaching = begun(workspace)
    steps(teaching, 3)
    teaching.apply(Undo())
    steps(teaching, 3)
    assert isinstance(teaching.apply(Redo())[0], Refused)


def test_redo_finishes_an_undone_game_again(workspace: Workspace) -> None:
    teaching = begun(workspace)
    list(ScriptedTeacher(teaching).demonstrate())
    whole = teaching.demonstration
    teaching.apply(Undo())
    assert not kept(workspace, whole.id).finished
    teaching.apply(Redo())
    assert teaching.demonstration == whole == kept(workspace, whole.id)


def test_redo_works_after_a_restart(tmp_path: Path) -> None:
    with opened(tmp_path / "data") as workspace:
        teaching = begun(workspace)
        steps(teaching, 4)
        whole = teaching.demonstration
        teaching.apply(Undo())
        teaching.apply(Undo())
    with opened(tmp_path / "data") as workspace:
        teaching = begun(workspace)
        teaching.apply(Redo())
        teaching.apply(Redo())
        assert teaching.demonstration == whole


def test_redo_waits_for_an_open_question(workspace: Workspace) -> None:
    teaching = begun(workspace)
    steps(teaching, 1)
    teaching.apply(Undo())
    teaching.apply(Say("greet everyone"))
    assert isinstance(teaching.apply(Redo())[0], Refused)
    teaching.apply(YES)
    assert len(teaching.demonstration.steps) == 1


def test_going_back_in_the_current_game_can_be_redone(workspace: Workspace) -> None:
    teaching = begun(workspace)
    steps(teaching, 6)
    whole = teaching.demonstration
    events = teaching.apply(Again(whole.id, 2))
    assert [type(e) for e in events] == [StepUndone] * 4
    assert teaching.demonstration.steps == whole.steps[:2]
    for _ in range(4):
        teaching.apply(Redo())
    assert teaching.demonstration == whole
    assert isinstance(teaching.apply(Again(whole.id, 6))[0], Refused)


def test_a_complete_new_version_replaces_the_old_game(
    workspace: Workspace,
) -> None:
    first = begun(workspace)
    list(ScriptedTeacher(first).demonstrate())
    old = first.demonstration
    again = begun(workspace, "Bea", Again("1", 10))
    assert again.demonstration.steps == old.steps[:10]
    assert len(read_library(workspace.store, "bingo").entries) == 1  # looking in leaves nothing
    list(ScriptedTeacher(again).demonstrate())
    new = again.demonstration
    assert (new.origin, new.of, new.teacher, new.seed) == ("again", (old.id,), "Bea", old.seed)
    library = read_library(workspace.store, "bingo")
    assert library.finished == [new]
    assert library.entries[old.id].hidden == "shown again"
    again.apply(Undo())  # no longer complete
    assert read_library(workspace.store, "bingo").finished == [old]


def test_copied_steps_can_be_undone_in_the_new_version(workspace: Workspace) -> None:
    first = begun(workspace)
    steps(first, 5)
    again = begun(workspace, "Bea", Again("1", 3))
    again.apply(Undo())
    assert kept(workspace, again.demonstration.id).steps == first.demonstration.steps[:2]
    assert kept(workspace, first.demonstration.id) == first.demonstration
    resumed = workspace.teaching("Bea", None)
    (event,) = resumed.begin()
    assert isinstance(event, Begun)
    assert event.resumed
    assert resumed.demonstration == again.demonstration


@pytest.mark.parametrize("again", [Again("7", 1), Again("1", 99), Again("1", -1)])
def test_an_invalid_request_to_show_again_is_refused(again: Again, workspace: Workspace) -> None:
    steps(begun(workspace), 2)
    with pytest.raises(TangyError, match=r"demonstration|step"):
        begun(workspace, "Bea", again)


def test_a_failed_undo_of_several_steps_changes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace = Workspace(tmp_path / "data")
    teaching = begun(workspace)
    steps(teaching, 4)
    before, state = teaching.demonstration, teaching.world.observe()
    append, calls = Store.append, iter(range(3))

    def failing(self: Store, *arguments: object, **options: object) -> int:
        if next(calls) == 1:
            raise StoreError("the disk is full")
        return append(self, *arguments, **options)  # type: ignore[arg-type]

    with monkeypatch.context() as patch, pytest.raises(StoreError):
        patch.setattr(Store, "append", failing)
        teaching.apply(Again(before.id, 1))
    assert teaching.demonstration == before == kept(workspace, before.id)
    assert teaching.world.observe() == state
    workspace.close()


@pytest.mark.slow
@given(st.lists(st.sampled_from(("step", "undo", "redo", "back")), max_size=14), st.integers(1, 9))
@settings(max_examples=25)
def test_the_log_agrees_with_the_session_after_any_steps_undos_and_redos(
    commands: list[str], seed: int
) -> None:
    with TemporaryDirectory() as folder, opened(Path(folder)) as workspace:
        teaching = workspace.teaching("Ada", seed)
        teaching.begin()
        trail: list[Demonstration] = []  # the states that redo must lead to
        for command in commands:
            before = teaching.demonstration
            match command:
                case "step":
                    steps(teaching, len(before.steps) + 1)
                    trail.clear()
                case "undo" if before.steps:
                    teaching.apply(Undo())
                    trail.append(before)
                case "redo" if trail:
                    teaching.apply(Redo())
                    assert teaching.demonstration == trail.pop()
                case "back" if len(before.steps) > 1:
                    shorter = [replace(before, steps=before.steps[:n]) for n in (1, 2)]
                    teaching.apply(Again(before.id, 1))
                    trail += [
                        replace(before, steps=before.steps[:n])
                        for n in range(len(before.steps), 1, -1)
                    ]
                    assert teaching.demonstration == shorter[0]
            if before.steps or teaching.demonstration.steps:
                assert kept(workspace, teaching.demonstration.id) == teaching.demonstration
            if teaching.demonstration.steps:
                assert teaching.world.observe() == teaching.demonstration.steps[-1].after


@pytest.mark.parametrize("users", [1, 4, 8])
def test_one_guided_game_teaches_the_whole_policy(users: int, tmp_path: Path) -> None:
    with opened(tmp_path / "data", users) as workspace:
        teaching = workspace.teaching("Ada", 5, guided=True)
        teaching.begin()
        list(ScriptedTeacher(teaching).demonstrate())
        (shown,) = read_library(workspace.store, "bingo").finished
        assert shown.guided
        policy = learn_policy(workspace.activity, [shown])
        assert policy.exact(workspace.activity)
        assert all(policy.decide(s).sure for s in workspace.activity.situations)


def test_a_guided_game_supports_undo_resume_and_redo(tmp_path: Path) -> None:
    with opened(tmp_path / "data") as workspace:
        teaching = workspace.teaching("Ada", 5, guided=True)
        teaching.begin()
        steps(teaching, 20)
        whole = teaching.demonstration
        teaching.apply(Undo())
    with opened(tmp_path / "data") as workspace:
        resumed = workspace.teaching("Ada", None)
        (event,) = resumed.begin()
        assert isinstance(event, Begun)
        assert event.resumed
        resumed.apply(Redo())
        assert resumed.demonstration == whole


def test_a_guided_game_is_resumed_before_an_unguided_one(
    workspace: Workspace,
) -> None:
    steps(begun(workspace), 2)
    guided = workspace.teaching("Ada", None, guided=True)
    guided.begin()
    assert guided.demonstration.guided
    steps(guided, 2)
    assert begun(workspace).demonstration == guided.demonstration


def test_a_replaced_game_cannot_be_shown_again(workspace: Workspace) -> None:
    first = begun(workspace)
    list(ScriptedTeacher(first).demonstrate())
    list(ScriptedTeacher(begun(workspace, "Bea", Again("1", 10))).demonstrate())
    with pytest.raises(TangyError, match=r"not in use \(shown again\)"):
        begun(workspace, "Cleo", Again("1", 5))
    begun(workspace, "Cleo", Again("2", 5))


def test_a_new_version_survives_a_failed_first_undo(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace = Workspace(tmp_path / "data")
    with workspace.store.transaction():
        list(ScriptedTeacher(begun(workspace)).demonstrate())
    again = begun(workspace, "Bea", Again("1", 10))
    append, calls = Store.append, iter(range(9))

    def failing(self: Store, *arguments: object, **options: object) -> int:
        if next(calls) == 2:
            raise StoreError("the disk is full")
        return append(self, *arguments, **options)  # type: ignore[arg-type]

    with monkeypatch.context() as patch, pytest.raises(StoreError):
        patch.setattr(Store, "append", failing)
        again.apply(Again(again.demonstration.id, 5))
    with workspace.store.transaction():
        list(ScriptedTeacher(again).demonstrate())
    assert kept(workspace, again.demonstration.id) == again.demonstration
    workspace.close()
