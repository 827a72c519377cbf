"""A step that contradicts an earlier demonstration is reported at once, and only once."""

from __future__ import annotations

import pytest

from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.learning.teaching_events import Contradicted, TeachingEvent, Undo
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import Reply, Say
from tangy_tui.text.teaching import teaching_lines


def do(teaching: TeachingSession, *phrases: str) -> list[Contradicted]:
    """Give commands, say yes to each, and return the reported contradictions."""
    events: list[TeachingEvent] = []
    for phrase in phrases:
        teaching.apply(Say(phrase))
        events += teaching.apply(Reply(yes=True))
    return [event for event in events if isinstance(event, Contradicted)]


def session(workspace: Workspace, teacher: str, seed: int = 1) -> TeachingSession:
    teaching = workspace.teaching(teacher, seed)
    teaching.begin(resume=False)
    return teaching


def test_a_contradiction_to_another_teacher_is_reported(workspace: Workspace) -> None:
    do(session(workspace, "Ada"), "greet everyone", "call number")
    bea = session(workspace, "Bea")
    (told,) = do(bea, "tell a joke")
    assert not told.own
    assert (told.number, told.earlier.teacher, told.earlier.step.behaviour) == (
        1,
        "Ada",
        "greeting",
    )
    assert "Ada showed: greet everyone (step 1 of another game)" in teaching_lines(told, bea)[0]


def test_a_contradiction_to_an_own_step_is_reported(workspace: Workspace) -> None:
    teaching = session(workspace, "Ada")
    (told,) = do(teaching, "greet everyone", "call number", "tell a joke")
    assert told.own
    assert told.earlier.step.behaviour == "call number"
    assert "you showed: call number (step 2)" in teaching_lines(told, teaching)[0]


def test_a_contradiction_is_reported_once_until_an_undo(workspace: Workspace) -> None:
    teaching = session(workspace, "Ada")
    do(teaching, "greet everyone", "call number")
    assert len(do(teaching, "tell a joke")) == 1
    assert do(teaching, "call number", "tell a joke", "call number") == []
    again = session(workspace, "Bea")
    do(again, "greet everyone")
    assert len(do(again, "tell a joke")) == 1
    again.apply(Undo())
    assert len(do(again, "tell a joke")) == 1


def test_the_same_answer_contradicts_nothing(workspace: Workspace) -> None:
    do(session(workspace, "Ada"), "greet everyone", "call number", "call number")
    assert do(session(workspace, "Bea"), "greet everyone", "call number", "call number") == []


def test_an_undone_step_contradicts_nothing(workspace: Workspace) -> None:
    ada = session(workspace, "Ada")
    do(ada, "tell a joke")
    ada.apply(Undo())
    assert do(ada, "greet everyone") == []
    assert do(session(workspace, "Bea"), "greet everyone") == []


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_consistent_teacher_gets_no_report(workspace: Workspace, seed: int) -> None:
    teaching = session(workspace, "Ada", seed)
    told = list(ScriptedTeacher(teaching).demonstrate())
    assert teaching.demonstration.finished
    assert not any(isinstance(event, Contradicted) for event in told)
