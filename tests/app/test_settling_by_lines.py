"""Conflicts between demonstrations are settled by lines when Tangy learns."""

from __future__ import annotations

import pytest

from tangy_tui.app.workspace import Workspace
from tangy_tui.console.conflicts import settle_conflicts
from tangy_tui.learning.library import read_library
from tangy_tui.learning.teaching_events import Finish
from tangy_tui.learning.verification import Reply, Say
from tangy_tui.text.conflicts import LEFT_OPEN, WHICH_IS_RIGHT


@pytest.fixture
def disagreeing(workspace: Workspace) -> Workspace:
    """A workspace whose teachers began a game differently."""
    for teacher, second in (("Ada", "call number"), ("Bea", "tell a joke")):
        teaching = workspace.teaching(teacher, 1)
        teaching.begin()
        for phrase in ("greet everyone", second):
            teaching.apply(Say(phrase))
            teaching.apply(Reply(yes=True))
        teaching.apply(Finish())
    return workspace


def settled(workspace: Workspace, *lines: str) -> list[str]:
    """Settle conflicts with these lines; return the output."""
    typed, written = iter(lines), list[str]()
    settle_conflicts(workspace, lambda: next(typed, None), written.append)
    return written


def conflicts(workspace: Workspace) -> int:
    return len(read_library(workspace.store, workspace.activity.name).conflicts)


def test_a_number_settles_a_conflict(disagreeing: Workspace) -> None:
    assert conflicts(disagreeing) == 1
    assert WHICH_IS_RIGHT in settled(disagreeing, "7", "1")
    assert conflicts(disagreeing) == 0


def test_an_empty_line_leaves_a_conflict_open(disagreeing: Workspace) -> None:
    assert LEFT_OPEN in settled(disagreeing, "")
    assert conflicts(disagreeing) == 1


def test_the_end_of_the_input_leaves_a_conflict_open(disagreeing: Workspace) -> None:
    settled(disagreeing)
    assert conflicts(disagreeing) == 1


def test_without_a_conflict_nothing_is_asked(workspace: Workspace) -> None:
    assert settled(workspace) == []
