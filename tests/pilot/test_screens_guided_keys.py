"""A guided game is taught with few keys: a letter or two, Tab, Enter, and the yes."""

from __future__ import annotations

import pytest

from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.library import read_demonstrations
from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.learning.verification import Say
from tangy_tui.ui.dialogs.question import QuestionDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.teach import TeachScreen
from tangy_tui.ui.widgets.command_bar import CommandBar
from tests.pilot.conftest import Run, StillClock, TangyPilot

MOST_KEYS = 350


async def typed(pilot: TangyPilot, screen: TeachScreen, phrase: str) -> int:
    """Type a command as people do who complete it, and return how many keys that took."""
    keys = 0
    for letter in phrase:
        await pilot.press("space" if letter == " " else letter)
        keys += 1
        if next(iter(screen.teaching.phrasebook.complete(phrase[:keys])), "") == phrase:
            await pilot.press("tab")
            keys += 1
            break
    assert screen.query_one(CommandBar).text == phrase
    await pilot.press("enter")
    return keys + 1


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2])
async def test_a_guided_game_takes_few_keys(run: Run, workspace: Workspace, seed: int) -> None:
    async def start(program: Program) -> None:
        teaching = workspace.teaching("ann", seed, guided=True)
        await program.push_screen(TeachScreen(workspace, teaching))

    async with run(app=Program(workspace, start, clock=StillClock())) as pilot:
        await pilot.pause()
        screen = pilot.app.screen
        assert isinstance(screen, TeachScreen)
        script = ScriptedTeacher(screen.teaching)
        keys = 0
        while not screen.teaching.demonstration.finished:
            command = script.command()
            assert isinstance(command, Say)
            keys += await typed(pilot, screen, command.text)
            await pilot.pause()
            assert isinstance(pilot.app.screen, QuestionDialog)
            await pilot.press("y")
            keys += 1
            await pilot.pause()
            # nothing is remarked on a game that is played well
            assert isinstance(pilot.app.screen_stack[-1], TeachScreen)
    (shown,) = read_demonstrations(workspace.store, workspace.activity.name)
    seen = {step.state.situation for step in shown.steps}
    assert seen == set(workspace.activity.situations)
    assert keys <= MOST_KEYS, f"{keys} keys for {len(shown.steps)} steps"
