"""A key makes the last step a rule; undo removes the rule before the step."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_profiles.declared.activity import DeclaredActivity
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.library import read_library
from tangy_tui.ui.dialogs.choose import ChooseDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.teach import TeachScreen
from tangy_tui.ui.widgets.transcript import Transcript
from tests.pilot.conftest import Run, StillClock, screen_text
from tests.support.teaching import taught_until
from tests.support.waiting import until_shown

STAGE = "listen"


def rules(workspace: Workspace) -> int:
    library = read_library(workspace.store, workspace.activity.name)
    return sum(bool(one.whatever) for one in library.resolutions)


@pytest.mark.slow
async def test_a_key_makes_the_last_step_a_rule_and_undo_removes_it(
    run: Run, tmp_path: Path
) -> None:
    workspace = Workspace(tmp_path, activity="trivia")
    taught_until(workspace, STAGE)
    session = workspace.teaching("Mary", 1)
    screen = TeachScreen(workspace, session)
    async with run(app=Program(workspace, clock=StillClock()), size=(80, 24)) as pilot:
        await pilot.app.push_screen(screen)
        await until_shown(pilot, lambda: bool(screen.query_one(Transcript).steps))
        steps = list(screen.query_one(Transcript).steps)
        assert "f10 rule" in screen_text(pilot.app)
        await pilot.press("f10")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ChooseDialog))
        await pilot.press("enter")
        await until_shown(pilot, lambda: rules(workspace) > 0)
        await until_shown(pilot, lambda: screen.query_one(Transcript).steps[-1] != steps[-1])
        assert " · rule" in screen.query_one(Transcript).steps[-1]
        await pilot.press("f2")
        await until_shown(pilot, lambda: rules(workspace) == 0)
        await until_shown(pilot, lambda: list(screen.query_one(Transcript).steps) == steps)


@pytest.mark.slow
async def test_esc_makes_no_rule_and_a_word_makes_one(run: Run, tmp_path: Path) -> None:
    workspace = Workspace(tmp_path, activity="trivia")
    taught_until(workspace, STAGE)
    screen = TeachScreen(workspace, workspace.teaching("Mary", 1))
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.app.push_screen(screen)
        await until_shown(pilot, lambda: bool(screen.query_one(Transcript).steps))
        await pilot.press(*"rule", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ChooseDialog))
        await pilot.press("escape")
        await until_shown(pilot, lambda: pilot.app.screen is screen)
        assert rules(workspace) == 0


async def test_a_game_with_cards_offers_no_rule(run: Run, workspace: Workspace) -> None:
    screen = TeachScreen(workspace, workspace.teaching("Mary", 1))
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.app.push_screen(screen)
        await until_shown(pilot, lambda: "undo" in screen_text(pilot.app))
        assert "f10" not in screen_text(pilot.app)
        await pilot.press("f10")
        await until_shown(pilot, lambda: "Show a step first" in screen_text(pilot.app))


async def test_a_small_screen_names_every_missing_stage(run: Run, tmp_path: Path) -> None:
    workspace = Workspace(tmp_path, activity="trivia")
    taught_until(workspace, STAGE)
    screen = TeachScreen(workspace, workspace.teaching("Mary", 1))
    async with run(app=Program(workspace, clock=StillClock()), size=(80, 24)) as pilot:
        await pilot.app.push_screen(screen)
        await until_shown(pilot, lambda: "still to show" in screen_text(pilot.app))
        unseen = screen_text(pilot.app).partition("still to show")[2].partition("\n>")[0]
        seen = {step.state.stage for step in screen.teaching.demonstration.steps}
        left = {one.stage for one in workspace.activity.situations} - seen
        assert left
        said = " ".join(unseen.split())
        activity = workspace.activity
        assert isinstance(activity, DeclaredActivity)
        assert all(activity.stage_words(stage) in said for stage in left)
        assert "more" not in unseen
