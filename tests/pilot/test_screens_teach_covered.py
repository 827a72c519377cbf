"""The teaching screen under dialogs: a scripted game waits, and the focus is kept."""

from __future__ import annotations

from threading import Event

import pytest

from tangy_profiles.demonstration import Demonstration
from tangy_profiles.state import Situation
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.explanation import DecisionReasons
from tangy_tui.learning.teaching_events import TeacherCommand, TeachingEvent
from tangy_tui.ui import policy_preview
from tangy_tui.ui.dialogs.why import WhyDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.help import Help, HelpScreen
from tangy_tui.ui.screens.teach import TeachScreen
from tangy_tui.ui.widgets.command_bar import CommandBar
from tests.pilot.conftest import Run, StillClock, screen_text

FAST = 1000.0
NO_HELP = Help("nothing", (), (), ())


def program(
    workspace: Workspace,
    ended: list[bool | None],
    *,
    scripted: float | None = None,
    covered: str = "",
) -> Program:
    """Make the program with the teaching screen open; its result is recorded.

    `covered` says when the help covers it: at the start, or after the last step.
    """

    async def start(started: Program) -> None:
        teaching = workspace.teaching("ann", 1)
        apply = teaching.apply

        def cover_at_the_end(command: TeacherCommand) -> list[TeachingEvent]:
            events = apply(command)
            if teaching.demonstration.finished:
                started.push_screen(HelpScreen(NO_HELP))
            return events

        if covered == "at the end":
            teaching.apply = cover_at_the_end  # type: ignore[method-assign]
        screen = TeachScreen(workspace, teaching, scripted=scripted)
        await started.push_screen(screen, ended.append)
        if covered == "at the start":
            await started.push_screen(HelpScreen(NO_HELP))

    return Program(workspace, start, clock=StillClock())


@pytest.mark.slow
@pytest.mark.parametrize("covered", ["at the start", "at the end"])
async def test_a_scripted_game_waits_while_the_help_is_open(
    run: Run, workspace: Workspace, covered: str
) -> None:
    ended: list[bool | None] = []
    app = program(workspace, ended, scripted=FAST, covered=covered)
    async with run(app=app) as pilot:
        for _ in range(500):
            if isinstance(app.screen, HelpScreen):
                break
            await pilot.pause(0.05)
        await pilot.pause(0.3)
        screen = app.screen_stack[-2]
        assert isinstance(screen, TeachScreen)
        assert screen.teaching.demonstration.finished is (covered == "at the end")
        assert ended == []
        await pilot.press("escape")
        for _ in range(500):
            if ended:
                break
            await pilot.pause(0.05)
        await pilot.pause()
        assert ended == [True]
        assert screen not in app.screen_stack
        screen.action_leave()  # a key that was on its way
        await pilot.pause()
        assert ended == [True]


@pytest.mark.slow
async def test_closing_the_help_restores_the_focus(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace, [])) as pilot:
        bar = pilot.app.screen.query_one(CommandBar)
        await pilot.press("escape", "question_mark")
        await pilot.pause()
        assert isinstance(pilot.app.screen, HelpScreen)
        await pilot.press("escape")
        await pilot.pause()
        await pilot.press("colon", "question_mark")
        await pilot.pause()
        await pilot.press("escape")
        await pilot.pause()
        await pilot.press("u")
        assert bar.text == "u"


async def test_a_scripted_game_lists_only_working_keys(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace, [], scripted=1.0)) as pilot:
        watched = screen_text(pilot.app)
        assert "w why" in watched
        assert "f2 undo" not in watched


@pytest.mark.slow
@pytest.mark.parametrize("typed", [True, False], ids=["typed", "by key"])
async def test_escape_during_a_computation_cancels_only_that(
    run: Run, workspace: Workspace, typed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    let_go = Event()
    grounds = policy_preview.grounds

    def slow(workspace: Workspace, present: Demonstration, situation: Situation) -> DecisionReasons:
        let_go.wait(20)
        return grounds(workspace, present, situation)

    monkeypatch.setattr(policy_preview, "grounds", slow)
    ended: list[bool | None] = []
    why = [*"why", "enter"] if typed else ["f4"]
    async with run(app=program(workspace, ended), notifications=True) as pilot:
        await pilot.press(*"greet everyone", "enter")
        await pilot.pause()
        await pilot.press("y")
        await pilot.pause()
        await pilot.press(*why)
        await pilot.pause()
        assert "is working out" in screen_text(pilot.app)
        await pilot.press("escape")
        await pilot.pause()
        assert ended == []
        assert "Cancelled." in screen_text(pilot.app)
        let_go.set()
        await pilot.pause(0.5)
        assert isinstance(pilot.app.screen, TeachScreen)
        await pilot.press(*(why if typed else ["f4"]))
        for _ in range(200):
            if isinstance(pilot.app.screen, WhyDialog):
                break
            await pilot.pause(0.05)
        assert isinstance(pilot.app.screen, WhyDialog)
