"""Ending a game by words: discarded, finished early, or started over."""

from __future__ import annotations

import pytest
from textual.pilot import Pilot
from textual.widgets import Static

from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.library import read_library
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.teach import TeachScreen
from tests.pilot.conftest import Run, StillClock, screen_text
from tests.pilot.test_screens_teach import say


def program(workspace: Workspace) -> Program:
    """Make the program with a new game of Ann's."""

    async def start(started: Program) -> None:
        await started.push_screen(TeachScreen(workspace, workspace.teaching("ann", 1)))

    return Program(workspace, start, clock=StillClock())


async def type_words(pilot: Pilot[None], words: str) -> None:
    """Type a command without a question."""
    await pilot.press(*["space" if letter == " " else letter for letter in words], "enter")
    await pilot.pause()


def now(pilot: Pilot[None]) -> str:
    """Return the line with the current situation."""
    return str(pilot.app.screen.query_one("#now", Static).render())


@pytest.mark.slow
async def test_finishing_early_ends_the_game_with_a_message(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await say(pilot, "greet everyone")
        await type_words(pilot, "finish the demonstration")
        assert "The game ended early" in screen_text(pilot.app)
        assert "The game is over" in now(pilot)
        await type_words(pilot, "call number")
        assert len(pilot.app.screen_stack) == 2  # the game accepts no more commands
    (entry,) = read_library(workspace.store, workspace.activity.name).entries.values()
    assert entry.demonstration.finished and len(entry.demonstration.steps) == 1


@pytest.mark.slow
async def test_undo_reopens_a_finished_game(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await say(pilot, "greet everyone")
        await say(pilot, "call number")
        await type_words(pilot, "that is all")
        await pilot.press("f2")
        await pilot.pause()
        assert "The game is over" not in now(pilot)
        await say(pilot, "call number")
    (entry,) = read_library(workspace.store, workspace.activity.name).entries.values()
    assert [s.behaviour for s in entry.demonstration.steps] == ["greeting", "call number"]
    assert not entry.demonstration.finished


@pytest.mark.slow
async def test_discarding_asks_and_begins_a_new_game(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await say(pilot, "greet everyone")
        await type_words(pilot, "discard game")
        assert isinstance(pilot.app.screen, ConfirmDialog)
        await pilot.press("n")
        await pilot.pause()
        (kept,) = read_library(workspace.store, workspace.activity.name).entries.values()
        assert not kept.hidden
        await type_words(pilot, "discard game")
        await pilot.press("y")
        await pilot.pause()
        screen = pilot.app.screen
        assert isinstance(screen, TeachScreen) and not screen.teaching.demonstration.steps
    (entry,) = read_library(workspace.store, workspace.activity.name).entries.values()
    assert entry.hidden


@pytest.mark.slow
async def test_starting_over_goes_back_to_the_first_step(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await say(pilot, "greet everyone")
        await say(pilot, "call number")
        await type_words(pilot, "start over")
        assert isinstance(pilot.app.screen, ConfirmDialog)
        await pilot.press("y")
        await pilot.pause()
        screen = pilot.app.screen
        assert isinstance(screen, TeachScreen) and not screen.teaching.demonstration.steps
