"""Choosing another activity at home for teaching and playing."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tangy_tui.app.chosen_activity import chosen_activity
from tangy_tui.app.workspace import Workspace
from tangy_tui.text.activities import activity_note
from tangy_tui.ui.activity_choice import choices
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.teach import TeachScreen
from tests.pilot.conftest import Run, StillClock, screen_text
from tests.support.declared import DECLARED, declared
from tests.support.waiting import until_shown


@pytest.mark.slow
async def test_a_chooses_the_activity_for_teaching(run: Run, workspace: Workspace) -> None:
    title = declared("trivia").title
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.press("a", "enter")
        await until_shown(pilot, lambda: title in screen_text(pilot.app))
        places = list(range(20))
        for _ in places:
            lines = screen_text(pilot.app).splitlines()
            if any("▸" in line and f" {title} " in line for line in lines):
                break
            await pilot.press("down")
        await pilot.press("enter")
        await until_shown(pilot, lambda: workspace.activity.name == "trivia")
        assert chosen_activity(workspace.store.folder) == "trivia"
        await until_shown(pilot, lambda: f"home │ {title}" in screen_text(pilot.app))
        await pilot.press("t", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, TeachScreen))
        await until_shown(pilot, lambda: f"teach: {title}" in screen_text(pilot.app))


async def test_esc_keeps_the_activity(run: Run, workspace: Workspace) -> None:
    before = workspace.activity.name
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.press("a", "enter")
        await until_shown(pilot, lambda: declared("memory").title in screen_text(pilot.app))
        await pilot.press("escape")
        await pilot.pause()
        assert workspace.activity.name == before


def test_the_choice_lists_group_size_duration_and_needs_of_an_activity(
    workspace: Workspace,
) -> None:
    notes = {word: note for word, _, note in choices(workspace)}
    assert set(notes) >= {*DECLARED, workspace.activity.name}
    assert all("minutes" in note and ";" in note for note in notes.values())
    bare = replace(declared("trivia"), summary="")
    assert activity_note(bare) == "people take turns, 6 rounds"
    assert activity_note(replace(declared("team-trivia"), summary="")) == "2 teams, 6 rounds"
    assert activity_note(replace(declared("exercises"), summary="")).startswith("for everybody")
