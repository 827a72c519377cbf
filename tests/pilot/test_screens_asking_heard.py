"""Tangy asks in a game and hears the answer; stop is heard at any time."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from textual.app import App

from tangy_profiles.demonstration import Demonstration
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import ForestSettings, Policy
from tangy_tui.learning.verification import Reply, Say, StopCommand
from tangy_tui.ui.dialogs.question import ChoicesDialog, QuestionDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.phrases import PhrasesScreen
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.screens.question_panel import AskingPanel
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.microphone_line import MicrophoneLine
from tests.interaction.gaps import learnt, without
from tests.pilot.conftest import Run, StillClock, TangyPilot, screen_text
from tests.pilot.ears import FakeEars

UNSURE = "call a joke number"


@pytest.fixture
def gappy(
    workspace: Workspace, cover: Callable[[str, int, int], tuple[Demonstration, ...]]
) -> Policy:
    """A policy that was never shown when to call a number."""
    expected = workspace.activity.expected
    gap = next(s for s in workspace.activity.situations if expected[s] == "call number")
    shown = [without(d, gap) for d in cover("bingo", 1, 4)]
    return learnt(workspace.store, workspace.activity, shown, ForestSettings(trees=5))


@pytest.fixture
def whole(
    workspace: Workspace, cover: Callable[[str, int, int], tuple[Demonstration, ...]]
) -> Policy:
    """A policy that was shown everything."""
    return learnt(workspace.store, workspace.activity, cover("bingo", 1, 4), ForestSettings(5))


def playing(
    workspace: Workspace, policy: Policy, ears: FakeEars, *, speed: float = 1000
) -> Program:
    """Make the program with ears and the playing screen open."""

    async def start(program: Program) -> None:
        supervision = workspace.supervision(policy, 5, asks=True)
        await program.push_screen(PlayScreen(workspace, supervision, speed=speed, teacher="ann"))

    return Program(workspace, start, clock=StillClock(), ears=ears.ears)


async def asked(pilot: TangyPilot) -> PlayScreen:
    """Wait until Tangy asks and accepts an answer."""
    while not (isinstance(pilot.app.screen, PlayScreen) and pilot.app.screen.query(AskingPanel)):
        await pilot.pause(0.02)
    while not pilot.app.screen.query_one(AskingPanel).listens:
        await pilot.pause(0.02)
    return pilot.app.screen


async def played(pilot: TangyPilot) -> PlayScreen:
    """Wait until a game is played."""
    while not (isinstance(pilot.app.screen, PlayScreen) and pilot.app.screen.control.going):
        await pilot.pause(0.02)
    return pilot.app.screen


@pytest.mark.slow
async def test_a_spoken_answer_is_verified_and_learnt(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    ears = FakeEars()
    async with run(app=playing(workspace, gappy, ears)) as pilot:
        screen = await asked(pilot)
        assert "t talk" in pilot.lines()[-2]
        await pilot.press("t")
        assert "listening ..." in screen.query_one(MicrophoneLine).text
        ears.hear(ears.say(UNSURE, sure=False))
        await pilot.pause()
        assert isinstance(pilot.app.screen, ChoicesDialog)
        await pilot.press("1")
        await pilot.pause()
        assert isinstance(pilot.app.screen, QuestionDialog)
        await pilot.press("y")
        while screen.control.supervision.question is not None:
            await pilot.pause(0.02)
        while "Learnt from ann" not in " ".join(screen.query_one(LogView).sentences):
            await pilot.pause(0.02)


@pytest.mark.slow
async def test_a_game_pauses_and_resumes_by_voice(
    run: Run, workspace: Workspace, whole: Policy
) -> None:
    ears = FakeEars(hands_free=True)
    async with run(app=playing(workspace, whole, ears, speed=1)) as pilot:
        screen = await played(pilot)
        ears.hear(Say("let's take a break", 1.0, None))
        while screen.control.going:
            await pilot.pause(0.02)
        ears.hear(Say("carry on", 1.0, None))
        while not screen.control.going:
            await pilot.pause(0.02)


@pytest.mark.slow
async def test_the_pace_changes_by_voice(run: Run, workspace: Workspace, whole: Policy) -> None:
    ears = FakeEars(hands_free=True)
    async with run(app=playing(workspace, whole, ears, speed=1)) as pilot:
        screen = await played(pilot)
        world = screen.control.plan.world
        assert world is not None
        before = world.pace
        ears.hear(Say("slow down", 1.0, None))
        while world.pace <= before:
            await pilot.pause(0.02)
        ears.hear(Say("that's too slow", 1.0, None))
        while world.pace > before:
            await pilot.pause(0.02)


async def test_no_voice_command_releases_a_stop(
    run: Run, workspace: Workspace, whole: Policy
) -> None:
    ears = FakeEars(hands_free=True)
    async with run(app=playing(workspace, whole, ears, speed=1)) as pilot:
        screen = await played(pilot)
        ears.hear(StopCommand("stop"))
        while not screen.control.stopped:
            await pilot.pause(0.02)
        ears.hear(Say("carry on", 1.0, None))
        for _ in range(3):
            await pilot.pause()
        assert screen.control.stopped
        assert not screen.control.going


@pytest.mark.slow
async def test_a_spoken_no_clears_the_line_and_listens_again(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    ears = FakeEars(hands_free=True, answers=True)
    async with run(app=playing(workspace, gappy, ears)) as pilot:
        screen = await asked(pilot)
        ears.hear(ears.say("call number"))
        await pilot.pause()
        assert isinstance(pilot.app.screen, QuestionDialog)
        ears.hear(Reply(False))
        await pilot.pause()
        assert "Give a new command" in screen_text(pilot.app)
        assert screen.query_one(CommandBar).text == ""
        assert screen.control.supervision.question is not None
        assert screen.query_one(AskingPanel).listens


async def test_only_stop_is_heard_without_a_question(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    ears = FakeEars(hands_free=True)
    async with run(app=playing(workspace, gappy, ears, speed=1)) as pilot:
        screen = pilot.app.screen
        assert isinstance(screen, PlayScreen)
        assert ears.asks
        assert "listening for stop" in screen.query_one(MicrophoneLine).text
        ears.hear(StopCommand("stop"))
        await pilot.pause()
        assert "STOPPED" in screen_text(pilot.app)


@pytest.mark.slow
async def test_speech_after_a_stop_is_refused_and_leaves_the_line_empty(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    ears = FakeEars(hands_free=True)
    async with run(app=playing(workspace, gappy, ears)) as pilot:
        screen = await asked(pilot)
        ears.hear(StopCommand("stop"))
        await pilot.pause()
        ears.hear(ears.say("call number"))
        await pilot.pause()
        assert pilot.app.screen is screen
        assert "press p to go on first" in screen_text(pilot.app)
        assert screen.query_one(CommandBar).text == ""
        assert screen.control.supervision.question is not None


@pytest.mark.slow
async def test_the_phrases_open_at_a_question(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    async with run(app=playing(workspace, gappy, FakeEars())) as pilot:
        await asked(pilot)
        await pilot.press("colon", *"phrases", "enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, PhrasesScreen)


@pytest.mark.slow
@pytest.mark.parametrize("size", [(60, 18), (80, 24)], ids=["tiny", "small"])
async def test_the_question_panel_with_a_microphone_matches_its_snapshot(
    run: Run,
    workspace: Workspace,
    gappy: Policy,
    size: tuple[int, int],
    looks: Callable[[App[None]], None],
) -> None:
    ears = FakeEars()
    async with run(app=playing(workspace, gappy, ears), size=size) as pilot:
        await asked(pilot)
        ears.be("speaking", "call the", 0.4)
        await pilot.pause()
        looks(pilot.app)
