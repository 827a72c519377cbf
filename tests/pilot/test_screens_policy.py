"""The policy screen leads to a game that is played by the shown policy."""

from __future__ import annotations

import pytest

from tangy_tui.app.training import learn
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.scripted_teacher import SCRIPTED, ScriptedTeacher
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.screens.policy import PolicyScreen
from tangy_tui.ui.screens.teach import TeachScreen
from tests.pilot.conftest import Run, StillClock
from tests.support.waiting import until_shown


@pytest.fixture
def taught(workspace: Workspace) -> Workspace:
    """A workspace with a demonstration, and no policy yet."""
    teaching = workspace.teaching(SCRIPTED, 1)
    teaching.begin()
    for _ in ScriptedTeacher(teaching).demonstrate():
        pass
    return workspace


async def test_quick_work_leaves_no_progress_notice(run: Run, workspace: Workspace) -> None:
    program = Program(workspace, clock=StillClock())
    async with run(app=program) as pilot:
        program.call_next(program.in_thread, "Tangy is working ...", int)  # before it is drawn
        await pilot.pause()
        await pilot.pause()
        assert not [told.message for told in program._notifications]


@pytest.mark.slow
async def test_after_learning_the_screen_names_the_key_that_plays(
    run: Run, taught: Workspace
) -> None:
    async with run(app=Program(taught, clock=StillClock())) as pilot:
        await pilot.press("f5")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, PolicyScreen))
        assert any("B" in line and "run a game" in line for line in pilot.lines())
        await pilot.press("B")
        await until_shown(pilot, lambda: not isinstance(pilot.app.screen, PolicyScreen))
        assert not isinstance(pilot.app.screen, PlayScreen), "it asks first"
        await pilot.press("y")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, PlayScreen))


@pytest.mark.slow
async def test_the_word_play_opens_a_game_from_teaching(run: Run, taught: Workspace) -> None:
    learn(taught)
    async with run(app=Program(taught, clock=StillClock())) as pilot:
        await pilot.press("t", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, TeachScreen))
        pilot.type(*"play", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, PlayScreen))
