"""Questions in a game: it waits for an answer, learns it, and continues; driven with keys."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest
from textual.app import App

from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import TangyError
from tangy_profiles.events import EventRecord
from tangy_profiles.game_records import GameEnding
from tangy_profiles.past_game import interrupted_game
from tangy_profiles.staff_records import StaffAction
from tangy_profiles.state import Situation
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policy import ForestSettings, Policy
from tangy_tui.text.keys import EMPTIES
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.dialogs.question import QuestionDialog
from tangy_tui.ui.dialogs.why import WhyDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.screens.question_panel import AskingPanel
from tangy_tui.ui.type_ahead_guard import Clock
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.policy_table import PolicyTable
from tangy_tui.ui.widgets.status_line import StatusLine
from tangy_tui.ui.widgets.transcript import Transcript
from tests.interaction.gaps import learnt, otherwise, without
from tests.pilot.conftest import LARGE, SMALL, Run, StillClock, TangyPilot, screen_text
from tests.pilot.faults import sure
from tests.support.waiting import until_shown

Cover = Callable[[str, int, int], tuple[Demonstration, ...]]

FEW = ForestSettings(trees=5)
TINY = (60, 18)


def gap(workspace: Workspace) -> Situation:
    """Return the missing situation: the first one after which a number is called."""
    expected = workspace.activity.expected
    return next(s for s in workspace.activity.situations if expected[s] == "call number")


@pytest.fixture
def gappy(workspace: Workspace, cover: Cover) -> Policy:
    """A policy that was never shown one situation."""
    shown = [without(d, gap(workspace)) for d in cover("bingo", 1, 4)]
    return learnt(workspace.store, workspace.activity, shown, FEW)


def playing(
    workspace: Workspace, policy: Policy, *, speed: float = 1000, clock: Clock | None = None
) -> Program:
    """Make the program with the playing screen open."""

    async def start(program: Program) -> None:
        supervision = workspace.supervision(policy, 5, asks=True)
        await program.push_screen(PlayScreen(workspace, supervision, speed=speed, teacher="ann"))

    return Program(workspace, start, clock=clock or StillClock())


async def asked(pilot: TangyPilot) -> PlayScreen:
    """Wait until Tangy asks and accepts a command."""
    while not (isinstance(pilot.app.screen, PlayScreen) and pilot.app.screen.query(AskingPanel)):
        await pilot.pause(0.02)
    while all(bar.closed for bar in pilot.app.screen.query(CommandBar)):
        await pilot.pause(0.02)
    return pilot.app.screen


async def questioned(pilot: TangyPilot) -> None:
    """Wait until the question that verifies an answer takes keys."""
    while not isinstance(pilot.app.screen, QuestionDialog):
        await pilot.pause(0.02)
    while not pilot.app.screen.painted:
        await pilot.pause(0.02)


async def answer(pilot: TangyPilot, words: str = "call number") -> None:
    """Type an answer and verify it."""
    pilot.type(*words, "enter")
    await questioned(pilot)
    await pilot.press("y")


async def over(pilot: TangyPilot, screen: PlayScreen) -> None:
    """Wait until the game is over."""
    while not screen.control.supervision.over:
        await pilot.pause(0.02)
    await pilot.pause()


@pytest.mark.slow
@pytest.mark.parametrize("size", [TINY, SMALL, LARGE], ids=["tiny", "small", "large"])
async def test_a_question_is_answered_in_place_and_the_game_plays_to_its_end(
    run: Run, workspace: Workspace, gappy: Policy, size: tuple[int, int]
) -> None:
    async with run(app=playing(workspace, gappy), size=size) as pilot:
        screen = await asked(pilot)
        count = screen.query_one(Transcript).count
        seen = " ".join(screen_text(pilot.app).split())
        assert "robot ASKS" in seen
        assert "Nobody has shown Tangy what to do here yet" in seen
        await answer(pilot)
        while screen.query_one(Transcript).count == count:
            await pilot.pause(0.02)
        await sure(pilot, "E")
        await over(pilot, screen)
        said = " ".join(screen.query_one(LogView).sentences)
        assert "Learnt from ann: " in said
        assert "as a demonstration" in said
        assert repr(screen.control.supervision.policy.name) in said
        assert "earlier steps were gone through: nothing else changed." in said
        assert "The game is over" in said
        words = workspace.activity.in_words(gap(workspace))
        row = next(r for r in screen.query_one(PolicyTable).rows if r.situation == words)
        assert (row.behaviour, row.seen) == ("call number", 1)
        assert screen.tally.answers == 1
    made = read_library(workspace.store, workspace.activity.name).finished[-1]
    assert (made.origin, made.teacher) == ("asked", "ann")


@pytest.mark.slow
async def test_a_message_names_the_learnt_answer(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    async with run(app=playing(workspace, gappy, speed=1), notifications=True) as pilot:
        await sure(pilot, "E")
        screen = await asked(pilot)
        screen.skipping = False
        await answer(pilot)
        while "gone through" not in screen_text(pilot.app):
            await pilot.pause(0.02)
        assert "earlier" in screen_text(pilot.app)
        assert "changed." in screen_text(pilot.app)


@pytest.mark.slow
async def test_commands_still_work_while_tangy_asks(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    async with run(app=playing(workspace, gappy)) as pilot:
        screen = await asked(pilot)
        pilot.type(*"autonomy each", "enter")
        while screen.control.autonomy.level != "each":
            await pilot.pause(0.02)
        pilot.type(*"drive left 2", "enter")
        while "this game is simulated" not in " ".join(screen_text(pilot.app).split()):
            await pilot.pause(0.02)
        assert screen.query(AskingPanel), "it still asks"


@pytest.mark.slow
async def test_while_tangy_asks_a_person_called_like_a_verb_can_leave(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    workspace.rename(workspace.find_person("user2"), "Will")
    async with run(app=playing(workspace, gappy)) as pilot:
        screen = await asked(pilot)
        pilot.type(*"Will is away", "enter")
        await until_shown(pilot, lambda: "user2" in screen.control.plan.away)
        assert screen.query(AskingPanel), "it still asks"


@pytest.mark.slow
async def test_nothing_is_executed_before_a_yes(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    async with run(app=playing(workspace, gappy)) as pilot:
        screen = await asked(pilot)
        before = list(workspace.store.events())
        pilot.type(*"call number", "enter")
        await questioned(pilot)
        assert "Did you say: call number?" in screen_text(pilot.app)
        await pilot.press("enter", "space", "n")
        await pilot.pause()
        assert screen.query_one(CommandBar).text == "call number"
        assert "Give a new command" in screen_text(pilot.app)
        await pilot.press("enter")
        await questioned(pilot)
        await pilot.press("escape")
        await pilot.pause()
        assert list(workspace.store.events()) == before
        assert screen.control.supervision.question is not None


@pytest.mark.slow
async def test_keys_typed_ahead_do_not_answer_the_question(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    async with run(app=playing(workspace, gappy, speed=1)) as pilot:
        await pilot.press("p")
        screen: Any = pilot.app.screen
        while screen.query_one(Transcript).count < 1:
            await pilot.press("full_stop")
            await pilot.pause()
        pilot.type("full_stop", *"xxx", "enter", "y")
        screen = await asked(pilot)
        await pilot.pause()
        assert screen.query_one(CommandBar).text == ""
        assert screen.control.supervision.question is not None
        assert isinstance(pilot.app.screen, PlayScreen)


@pytest.mark.slow
async def test_unknown_words_stay_in_the_line(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    async with run(app=playing(workspace, gappy)) as pilot:
        screen = await asked(pilot)
        pilot.type(*"make some tea", "enter")
        await pilot.pause()
        assert "I do not know what 'make some tea' means" in screen_text(pilot.app)
        assert screen.query_one(CommandBar).text == "make some tea"


@pytest.mark.slow
async def test_the_reason_for_a_question_opens_by_word_and_by_key(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    async with run(app=playing(workspace, gappy)) as pilot:
        await asked(pilot)
        pilot.type(*"why", "enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, WhyDialog)
        assert "Nobody has shown Tangy what to do here" in screen_text(pilot.app)
        await pilot.press("escape")
        await pilot.pause()
        await pilot.press("escape", "w")
        await pilot.pause()
        assert isinstance(pilot.app.screen, WhyDialog)


@pytest.mark.slow
@pytest.mark.parametrize("way", ["word", "key"])
async def test_a_game_can_be_abandoned_at_a_question(
    run: Run, workspace: Workspace, gappy: Policy, way: str
) -> None:
    async with run(app=playing(workspace, gappy)) as pilot:
        screen = await asked(pilot)
        if way == "word":
            pilot.type(*"quit", "enter")
        else:
            await pilot.press("escape", "escape")
        await pilot.pause()
        assert isinstance(pilot.app.screen, ConfirmDialog)
        await pilot.press("n")
        await pilot.pause()
        assert not any(isinstance(s, ConfirmDialog) for s in pilot.app.screen_stack)
        assert screen.control.supervision.question is not None
        if way == "word":
            pilot.type(*"quit", "enter")
        else:
            await pilot.press("escape")
        await pilot.pause()
        await pilot.press("y")
        await over(pilot, screen)
        assert not screen.query(AskingPanel)
        ended = workspace.store.last(GameEnding)
        assert ended is not None
        assert "Nobody has shown Tangy" in str(ended.body["stopped"])
        await pilot.press("escape")
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)


@pytest.mark.slow
async def test_a_stop_holds_the_answer_until_the_release(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    async with run(app=playing(workspace, gappy)) as pilot:
        screen = await asked(pilot)
        pilot.type(*"call number", "enter")
        await questioned(pilot)
        await pilot.press("ctrl+x")
        await pilot.pause()
        before = list(workspace.store.events())
        assert before[-1].body["did"] == "stopped"
        assert isinstance(pilot.app.screen, PlayScreen)
        assert "STOPPED" in screen_text(pilot.app)
        assert "press p to go on first" in screen_text(pilot.app)
        await pilot.press("full_stop", "E")
        await pilot.press("colon", "enter")
        await pilot.pause()
        assert list(workspace.store.events()) == before
        assert screen.control.supervision.question is not None
        await pilot.pause()
        assert f"esc {EMPTIES}" in screen_text(pilot.app)
        await pilot.press("escape")
        await pilot.pause()
        assert f"esc {EMPTIES}" not in screen_text(pilot.app)
        await pilot.press("escape", "p")  # out of the empty line
        await pilot.pause()
        assert "STOPPED" not in screen_text(pilot.app)
        await answer(pilot)
        while screen.control.supervision.question is not None:
            await pilot.pause(0.02)


@pytest.mark.slow
@pytest.mark.parametrize("words", ["stop the robot", "Please stop the bingo game!"])
async def test_a_stop_typed_as_an_answer_stops(
    run: Run, workspace: Workspace, gappy: Policy, words: str
) -> None:
    async with run(app=playing(workspace, gappy)) as pilot:
        screen = await asked(pilot)
        pilot.type(*words, "enter")
        await pilot.pause()
        assert "STOPPED" in screen_text(pilot.app)
        assert pilot.app.screen is screen and screen.control.supervision.question is not None


@pytest.mark.slow
async def test_pausing_while_tangy_asks_pauses_after_the_answer(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    async with run(app=playing(workspace, gappy)) as pilot:
        screen = await asked(pilot)
        await pilot.press("escape", "p", "E", "colon")
        assert "answer first" in screen.query_one(LogView).sentences[-1]
        count = screen.query_one(Transcript).count
        await answer(pilot)
        while screen.query_one(Transcript).count == count:
            await pilot.pause(0.02)
        for _ in range(5):
            await pilot.pause(0.02)
        assert screen.query_one(Transcript).count == count + 1
        assert screen.query_one(StatusLine).status.note == "paused"


@pytest.mark.slow
async def test_a_question_lists_contradicting_demonstrations(
    run: Run, workspace: Workspace, cover: Cover
) -> None:
    shown = cover("bingo", 1, 4)
    other = otherwise(shown[0], gap(workspace), "joke", "ben")
    contested = learnt(workspace.store, workspace.activity, [*shown, other], FEW)
    async with run(app=playing(workspace, contested), size=LARGE) as pilot:
        screen = await asked(pilot)
        seen = " ".join(screen_text(pilot.app).split())
        assert "Demonstrations disagree" in seen
        assert "by ben)" in seen
        assert "contested" in seen
        await answer(pilot)
        async with asyncio.timeout(20):  # it learns from the answer, in a thread
            while "set aside" not in " ".join(screen.query_one(LogView).sentences):
                await pilot.pause(0.02)


@pytest.mark.slow
async def test_an_answered_step_names_who_answered(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    async with run(app=playing(workspace, gappy), size=LARGE) as pilot:
        screen = await asked(pilot)
        count = screen.query_one(Transcript).count
        await pilot.press("escape", "p", "colon")
        await answer(pilot)
        while screen.query_one(Transcript).count == count:
            await pilot.pause(0.02)
        await pilot.pause()
        await pilot.press("w")
        await pilot.pause()
        assert isinstance(pilot.app.screen, WhyDialog)
        assert "Tangy asked, and ann answered: call number." in screen_text(pilot.app)


@pytest.mark.slow
async def test_a_failed_write_to_the_log_pauses_the_game_until_a_retry(
    run: Run, workspace: Workspace, gappy: Policy, monkeypatch: pytest.MonkeyPatch
) -> None:
    append = workspace.store.append

    def refuse(record: EventRecord, **more: Any) -> int:
        if record.KIND == "policy learnt":
            raise TangyError("The log cannot be written: the disk is full.")
        return append(record, **more)

    async with run(app=playing(workspace, gappy)) as pilot:
        screen = await asked(pilot)
        policy = screen.control.supervision.policy
        with monkeypatch.context() as broken:
            broken.setattr(workspace.store, "append", refuse)
            await answer(pilot)
            while not isinstance(pilot.app.screen, MessageDialog):
                await pilot.pause(0.02)
        await pilot.pause()
        assert "the disk is full" in screen_text(pilot.app)
        assert screen.control.supervision.policy is policy
        await pilot.press("enter")
        await pilot.pause()
        await pilot.press("p")
        await asked(pilot)
        await answer(pilot)
        while screen.control.supervision.policy is policy:  # until it has learnt from the answer
            await pilot.pause(0.02)
        assert screen.control.supervision.question is None


@pytest.mark.slow
async def test_a_game_can_be_resumed_after_quitting_at_a_question(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    async with run(app=playing(workspace, gappy)) as pilot:
        await asked(pilot)
        await pilot.press("ctrl+q")
    assert workspace.store.last(GameEnding) is None
    assert interrupted_game(workspace.store, workspace.activity.name) is not None
    assert not [act for act in workspace.store.events(StaffAction) if act.record.did == "stopped"]


@pytest.mark.slow
@pytest.mark.parametrize("size", [SMALL, LARGE], ids=["small", "large"])
async def test_the_question_panel_matches_its_snapshot(
    run: Run,
    workspace: Workspace,
    gappy: Policy,
    size: tuple[int, int],
    looks: Callable[[App[None]], None],
) -> None:
    async with run(app=playing(workspace, gappy), size=size) as pilot:
        await asked(pilot)
        await pilot.pause()
        looks(pilot.app)
