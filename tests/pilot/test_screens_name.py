"""The program asks for the teacher's name on the first start, and later only on request."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from textual.widgets import Input

from tangy_profiles.demonstration import Demonstration
from tangy_tui.app.on_duty import take_duty
from tangy_tui.app.teacher_profile import TeacherProfile, read_profile, save_profile
from tangy_tui.app.workspace import Workspace
from tangy_tui.ui.dialogs.name import NameDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.screens.people import PeopleScreen
from tangy_tui.ui.screens.teach import TeachScreen
from tangy_tui.ui.type_ahead_guard import SETTLE_SECONDS
from tests.pilot.conftest import Run, StillClock
from tests.shown import log_demonstration
from tests.support.waiting import until_shown


def program(workspace: Workspace) -> Program:
    return Program(workspace, asks_name=True, clock=StillClock())


@pytest.mark.slow
async def test_the_first_start_asks_for_the_name_and_stores_it(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace)) as pilot:
        await pilot.pause()
        assert isinstance(pilot.app.screen, NameDialog)
        await pilot.press("A", "d", "a", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, TeachScreen))
        assert read_profile(workspace.store.folder).name == "Ada"


async def test_home_opens_if_the_activity_was_already_taught(
    run: Run, workspace: Workspace, demonstrate: Callable[[str, int, int], Demonstration]
) -> None:
    log_demonstration(workspace.store, demonstrate("bingo", 1, 4))
    async with run(app=program(workspace)) as pilot:
        await pilot.press("A", "d", "a", "enter")
        await until_shown(pilot, lambda: read_profile(workspace.store.folder).name == "Ada")
        await until_shown(pilot, lambda: all(w.is_finished for w in pilot.app.workers))
        assert isinstance(pilot.app.screen, HomeScreen)


async def test_the_name_is_asked_once_and_can_be_changed_at_home(
    run: Run, workspace: Workspace
) -> None:
    save_profile(workspace.store.folder, TeacherProfile("Ada"))
    async with run(app=program(workspace)) as pilot:
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)
        await pilot.press("n", "enter")
        await pilot.pause()
        await pilot.pause()
        assert pilot.app.screen.query_one(Input).value == "Ada"
        await pilot.press(*"Bea", "enter")
        await pilot.pause()
        assert workspace.teacher == "Bea"


async def test_escape_defers_the_question_to_the_next_start(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await pilot.pause()
        await pilot.press("escape")
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)
        assert read_profile(workspace.store.folder) == TeacherProfile()


async def test_an_invalid_name_is_reported(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await pilot.pause()
        await pilot.press("backspace", "enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, NameDialog)
        assert pilot.app.screen.query_one(".wrong").has_class("-shown")


async def test_keys_typed_ahead_are_no_name(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, NameDialog))
        line = pilot.app.screen.query_one(Input)
        before = line.value
        pilot.type(*"greet", "enter", at=SETTLE_SECONDS / 2)
        await pilot.pause()
        assert isinstance(pilot.app.screen, NameDialog)
        assert line.value == before
        await pilot.press(*"Ada", "enter")
        await until_shown(pilot, lambda: read_profile(workspace.store.folder).name == "Ada")


async def test_the_question_blocks_the_verb_behind_it(run: Run, workspace: Workspace) -> None:
    began: list[str] = []

    async def start(program: Program) -> None:
        began.append(program.workspace.teacher)

    asking = Program(workspace, start, asks_name=True, clock=StillClock())
    async with run(app=asking) as pilot:
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, NameDialog))
        assert "Rehearse" not in pilot.text()
        await pilot.press(*"Ada", "enter")
        await until_shown(pilot, lambda: began == ["Ada"])
        await until_shown(pilot, lambda: "Rehearse" in pilot.text())


async def test_nobody_is_asked_who_they_are_while_somebody_is_on_duty(
    run: Run, workspace: Workspace, demonstrate: Callable[[str, int, int], Demonstration]
) -> None:
    log_demonstration(workspace.store, demonstrate("bingo", 1, 4))
    take_duty(workspace.store.folder, "Nina")
    async with run(app=program(workspace)) as pilot:
        await pilot.press("e", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, PeopleScreen))
