"""Messages and faults from before an interruption stay there for staff who resume the game."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from tangy_profiles.game_records import FaultDiagnosed, FaultMove, RecoveryEvent
from tangy_profiles.game_world import SIMULATED
from tangy_tui.app.game_commands import Pause, SetPace
from tangy_tui.app.interruption import find_interrupted
from tangy_tui.app.scripted_staff import scripted_controller
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.inquiries import Inquiries
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.earlier import read_earlier
from tangy_tui.text.messages import NONE_YET
from tangy_tui.ui.dialogs.fault import FaultDialog
from tangy_tui.ui.dialogs.messages import MessagesDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.widgets.fault_list import FaultList
from tests.pilot.conftest import Run, StillClock, TangyPilot
from tests.support.interrupted_games import broken_off
from tests.support.waiting import until_shown

STEPS = 6


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


@pytest.fixture
def interrupted(workspace: Workspace, learnt: Policy) -> Workspace:
    """A workspace with a game that was killed after a fault and some commands of staff."""
    control = broken_off(workspace, learnt, STEPS)
    game, store = control.supervision.game.game, workspace.store
    fault = FaultDiagnosed(
        game=game, fault="f1", code="VOICE", name="The voice is silent", criticality="non-critical",
        recovery="continue", step=STEPS, seconds=12.0, behaviour="", console="Nobody hears Tangy.",
        why="the voice sends nothing", evidence={}, mismatches=(), advice=("Look at it.",),
    )  # fmt: skip
    store.append(fault)
    store.append(FaultMove(game=game, fault="f1", move=RecoveryEvent("went on", 12.0)))
    control.apply(SetPace(20))
    control.apply(Pause())
    return workspace


@asynccontextmanager
async def resumed(run: Run, workspace: Workspace, policy: Policy) -> AsyncIterator[TangyPilot]:
    """Resume the interrupted game on the screen."""

    async def start(program: Program) -> None:
        past = find_interrupted(workspace, SIMULATED)
        supervision = workspace.supervision(policy, 5)
        await program.push_screen(PlayScreen(workspace, supervision, past=past, teacher="ann"))

    async with run((120, 40), app=Program(workspace, start, clock=StillClock())) as pilot:
        await until_shown(pilot, lambda: "earlier steps" in pilot.text())
        yield pilot


@pytest.mark.slow
async def test_messages_before_a_crash_can_be_read_in_the_resumed_game(
    interrupted: Workspace, learnt: Policy, run: Run
) -> None:
    async with resumed(run, interrupted, learnt) as pilot:
        await pilot.press("exclamation_mark")
        await until_shown(pilot, lambda: "Before the interruption" in pilot.text())
        text = pilot.text()
        heading = text.index("Before the interruption")
        assert heading < text.index("paused the game") < text.index("set the pace")
        assert text.index("set the pace") < text.index("The voice is silent. Nobody hears")
        assert "call number" not in text[heading : text.index("Nobody hears")]


@pytest.mark.slow
async def test_the_next_game_does_not_list_messages_before_the_interruption_of_another(
    interrupted: Workspace, learnt: Policy, run: Run
) -> None:
    async with resumed(run, interrupted, learnt) as pilot:
        game = interrupted.supervision(learnt, 6)
        await pilot.app.push_screen(PlayScreen(interrupted, game, teacher="ann"))
        await until_shown(pilot, lambda: game.games == 1)
        await pilot.press("exclamation_mark")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, MessagesDialog))
        assert "Before the interruption" not in pilot.text()


@pytest.mark.slow
async def test_faults_before_a_crash_are_listed_in_the_resumed_game(
    interrupted: Workspace, learnt: Policy, run: Run
) -> None:
    async with resumed(run, interrupted, learnt) as pilot:
        await pilot.press("6")
        faults = pilot.app.screen.query_one(FaultList)
        await until_shown(pilot, lambda: "The voice is silent" in pilot.text())
        text = pilot.text()
        assert text.index("No faults since") < text.index("Before the interruption")
        assert text.index("Before the interruption") < text.index("The voice is silent")
        faults.focus()
        await pilot.press("enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, FaultDialog))
        assert "Nobody hears Tangy." in pilot.text()


def test_the_lines_tell_what_was_before_a_crash(interrupted: Workspace, learnt: Policy) -> None:
    past = find_interrupted(interrupted, SIMULATED)
    assert past is not None
    activity, names = interrupted.activity, interrupted.names
    part = read_earlier(interrupted.store, past, activity, names)
    control = scripted_controller(interrupted.supervision(learnt, 5))
    inquiries = Inquiries(control, interrupted.name, None, str, part)
    messages, faults = inquiries.lines("messages"), inquiries.lines("faults")
    assert messages is not None and faults is not None
    assert messages[0].startswith("Before the interruption (")
    assert "paused the game." in messages[-1]
    fresh = Inquiries(control, interrupted.name, None, str)
    assert fresh.lines("messages") == [NONE_YET]
    assert faults[0] == messages[0] and "The voice is silent" in faults[1]
    assert faults[-1].startswith("No faults since")
