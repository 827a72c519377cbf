"""The tour for a new teacher: shown once, in its own game, and skippable at any time."""

from __future__ import annotations

from typing import Any
from unittest.mock import patch

import pytest
from textual.pilot import Pilot

from tangy_tui.app.teacher_profile import TeacherProfile, save_profile
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.library import read_demonstrations
from tangy_tui.ui.program import Program
from tangy_tui.ui.run import run_teaching
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.screens.teach import TeachScreen
from tangy_tui.ui.widgets.command_bar import CommandBar
from tests.pilot.conftest import LARGE, SMALL, Run, StillClock, screen_text
from tests.support.waiting import until_shown


def program(workspace: Workspace) -> Program:
    return Program(workspace, asks_name=True, clock=StillClock())


async def shows(pilot: Pilot[Any], words: str) -> None:
    """Wait until words are on the screen."""
    await until_shown(pilot, lambda: words in screen_text(pilot.app))


@pytest.mark.slow
@pytest.mark.parametrize("size", [SMALL, LARGE])
async def test_a_new_teacher_gives_one_real_command_and_answers_its_question(
    run: Run, workspace: Workspace, size: tuple[int, int]
) -> None:
    async with run(app=program(workspace), size=size) as pilot:
        await pilot.pause()
        await pilot.press(*"Ada", "enter")
        await shows(pilot, "Welcome, Ada.")
        await pilot.press("enter")
        await shows(pilot, "Try it: type greet everyone")
        await pilot.press(*"greet everyone", "enter")
        await pilot.pause()
        await shows(pilot, "Tangy does nothing before you say yes.")
        await pilot.press("y")
        await pilot.pause()
        await shows(pilot, "That is your first step")
        await pilot.press("enter", "enter", "enter")
        await pilot.pause()
        await shows(pilot, "Now: ")
        shown = read_demonstrations(workspace.store, workspace.activity.name)[-1]
        assert shown.teacher == "Ada"
        assert shown.guided
        assert [step.behaviour for step in shown.steps] == ["greeting"]


@pytest.mark.slow
async def test_escape_skips_the_tour_and_stays_on_the_teaching_screen(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace)) as pilot:
        await pilot.pause()
        await pilot.press(*"Ada", "enter")
        await shows(pilot, "Welcome, Ada.")
        await pilot.press("escape")
        await pilot.pause()
        assert isinstance(pilot.app.screen, TeachScreen)
        await shows(pilot, "Now: ")
        assert "Welcome" not in screen_text(pilot.app)


async def test_the_tour_is_shown_once(run: Run, workspace: Workspace) -> None:
    save_profile(workspace.store.folder, TeacherProfile("Ada"))
    async with run(app=program(workspace)) as pilot:
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)
        await pilot.press("t", "enter")
        await pilot.pause()
        assert "Welcome" not in screen_text(pilot.app)


async def test_the_tour_does_not_come_back_in_the_next_game(run: Run, workspace: Workspace) -> None:
    started: list[Any] = []
    with patch("tangy_tui.ui.run._run", lambda _, start, *more, **named: started.append(start)):
        run_teaching(
            workspace,
            workspace.teaching("", 1),
            ears=None,
            resume=False,
            games=1,
            speed=None,
            ascii_only=False,
            asks_name=True,
        )
    app = Program(workspace, started[0], asks_name=True, clock=StillClock())
    async with run(app=app) as pilot:
        await pilot.pause()
        await pilot.press(*"Ada", "enter")
        await shows(pilot, "Welcome, Ada.")
        assert not app.take_tour()


async def teach_one_step(workspace: Workspace, run: Run, *renames: str) -> list[str]:
    """Teach a step, answer the question for the name, and return the stored games' teachers."""
    save_profile(workspace.store.folder, TeacherProfile("Ada"))
    async with run(app=program(workspace)) as pilot:
        await pilot.pause()
        await pilot.press("t", "enter")
        await pilot.pause()
        await pilot.press(*renames)
        await pilot.pause()
        await pilot.press(*"greet everyone", "enter")
        await pilot.pause()
        await pilot.press("y")
        await pilot.pause()
    return [shown.teacher for shown in read_demonstrations(workspace.store, "bingo")]


@pytest.mark.slow
@pytest.mark.parametrize(
    "renames", [("ctrl+n", *"Bea", "enter"), (*"my name is Bea", "enter")], ids=["key", "words"]
)
async def test_the_name_can_be_changed_while_teaching(
    run: Run, workspace: Workspace, renames: tuple[str, ...]
) -> None:
    assert await teach_one_step(workspace, run, *renames) == ["Bea"]
    assert workspace.teacher == "Bea"


@pytest.mark.slow
async def test_a_game_keeps_the_teacher_who_began_it(run: Run, workspace: Workspace) -> None:
    assert await teach_one_step(workspace, run) == ["Ada"]
    async with run(app=program(workspace)) as pilot:
        await pilot.pause()
        await pilot.press("t", "enter")
        await pilot.pause()
        await pilot.press(*"my name is Bea", "enter")
        await pilot.pause()
        await shows(pilot, "This game stays Ada's")
        assert read_demonstrations(workspace.store, "bingo")[-1].teacher == "Ada"


@pytest.mark.slow
async def test_escape_cancels_a_command_before_it_skips_the_tour(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace), size=SMALL) as pilot:
        await pilot.pause()
        await pilot.press(*"Ada", "enter")
        await shows(pilot, "Welcome, Ada.")
        await pilot.press("enter")
        # Enter now belongs to the command, no longer to the tour.
        await until_shown(pilot, lambda: "go on" not in screen_text(pilot.app).splitlines()[-1])
        for begun in (("tab",), tuple("greet")):
            await pilot.press(*begun, "escape")
            await pilot.pause()
            await shows(pilot, "Try it: type greet everyone")
            assert not pilot.app.screen.query_one(CommandBar).text
        await pilot.press("escape")
        await pilot.pause()
        assert "Try it" not in screen_text(pilot.app)
