"""A guided game is taught with few keys: some letters, Tab or not, Enter, and the yes."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.library import read_demonstrations
from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import Say
from tangy_tui.ui.dialogs.question import QuestionDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.teach import TeachScreen
from tests.pilot.conftest import Run, StillClock

MOST_KEYS = 350


def tabbed(teaching: TeachingSession, phrase: str) -> list[str]:
    """Return the keys of people who complete a command with Tab."""
    for letters in range(1, len(phrase)):
        if next(iter(teaching.phrasebook.complete(phrase[:letters])), "") == phrase:
            return [*phrase[:letters], "tab"]
    return list(phrase)


def begun(teaching: TeachingSession, phrase: str) -> list[str]:
    """Return the keys of people who type whole words, until no other command begins with them."""
    meant = teaching.phrasebook.phrases[phrase]
    words = phrase.split()
    for count in range(1, len(words)):
        typed = " ".join(words[:count])
        fitting = teaching.phrasebook.complete(typed)
        if {teaching.phrasebook.phrases[one] for one in fitting} == {meant}:
            return list(typed)
    return list(phrase)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("typed", [tabbed, begun])
async def test_a_guided_game_takes_few_keys(
    run: Run, workspace: Workspace, seed: int, typed: Callable[[TeachingSession, str], list[str]]
) -> None:
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
            pressed = typed(screen.teaching, command.text)
            await pilot.press(*("space" if key == " " else key for key in pressed), "enter")
            keys += len(pressed) + 1
            await pilot.pause()
            assert isinstance(pilot.app.screen, QuestionDialog)
            await pilot.press("y")
            keys += 1
            await pilot.pause()
            # a game that is played well gets no remark
            assert isinstance(pilot.app.screen_stack[-1], TeachScreen)
    (shown,) = read_demonstrations(workspace.store, workspace.activity.name)
    seen = {step.state.situation for step in shown.steps}
    assert seen == set(workspace.activity.situations)
    print(f"{keys} keys for {len(shown.steps)} steps")
    assert keys <= MOST_KEYS, f"{keys} keys for {len(shown.steps)} steps"
