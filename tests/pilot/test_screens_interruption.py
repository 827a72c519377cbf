"""Tangy asks about an interrupted game before another begins."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

import pytest

from tangy_profiles.game_records import GameBeginning, GameEnding
from tangy_profiles.game_world import LIVE
from tangy_tui.app.game_to_play import GameToPlay
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.ui.dialogs.choose import ChooseDialog
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.dialogs.name import NameDialog
from tangy_tui.ui.interruption import ask_about_interrupted
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.widgets.transcript import Transcript
from tests.pilot.conftest import Run, StillClock, TangyPilot
from tests.pilot.live_games import HeldLink, held_world
from tests.support.interrupted_games import broken_off
from tests.support.waiting import until, until_shown

STEPS = 9


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


@pytest.fixture
def interrupted(workspace: Workspace, learnt: Policy) -> Workspace:
    """A workspace in whose log the last game has no end."""
    broken_off(workspace, learnt, STEPS)
    return workspace


async def asked(pilot: TangyPilot) -> None:
    await pilot.press("p", "enter")
    await until(lambda: isinstance(pilot.app.screen, ChooseDialog))


@pytest.mark.slow
async def test_an_interrupted_game_resumes_paused_with_its_steps(
    interrupted: Workspace, run: Run
) -> None:
    async with run(app=Program(interrupted, clock=StillClock())) as pilot:
        await asked(pilot)
        await pilot.press("enter")
        await until(lambda: isinstance(pilot.app.screen, PlayScreen))
        screen = pilot.app.screen
        assert isinstance(screen, PlayScreen)
        await until(lambda: screen.query_one(Transcript).count == STEPS)
        assert str(screen.control.phase) == "paused"
        assert f"{STEPS} earlier steps" in pilot.text()
        await pilot.press("full_stop")
        await until(lambda: screen.query_one(Transcript).count == STEPS + 1)
        await pilot.press("full_stop")
        await until(lambda: screen.query_one(Transcript).count == STEPS + 2)
        await pilot.press("full_stop")
        await until(lambda: screen.query_one(Transcript).count == STEPS + 3)
        first, *_, last = (
            f"Situation: {interrupted.activity.in_words(ground.acted.state.situation)}."
            for ground in screen.picture.grounds
        )
        assert first != last
        await pilot.press("w")
        await until_shown(pilot, lambda: f"Step {STEPS + 3}, the last" in pilot.text())
        await until_shown(pilot, lambda: last in pilot.text())
        await pilot.press("escape")
        screen.query_one(Transcript).focus()
        await pilot.press("up", "up", "up", "enter")
        await until_shown(pilot, lambda: f"Step {STEPS + 1}: why this?" in pilot.text())
        assert first in pilot.text()

    assert len(list(interrupted.store.events(GameBeginning))) == 1


async def test_home_says_which_game_can_be_resumed(interrupted: Workspace, run: Run) -> None:
    async with run(app=Program(interrupted, clock=StillClock())) as pilot:
        await until_shown(pilot, lambda: "Play      interrupted after" in pilot.text())
        assert "Live      on the bench" in pilot.text()


async def test_an_interrupted_game_can_be_ended_with_a_report(
    interrupted: Workspace, run: Run
) -> None:
    async with run(app=Program(interrupted, clock=StillClock())) as pilot:
        await asked(pilot)
        await pilot.press("down", "enter")
        await until(lambda: isinstance(pilot.app.screen, MessageDialog))
        await until_shown(pilot, lambda: "Open it with a web browser" in pilot.text())

    (end,) = interrupted.store.events(GameEnding)
    (report,) = interrupted.store.folder.glob("report-*.html")
    (begun,) = interrupted.store.events(GameBeginning)
    at = datetime.fromisoformat(begun.at).astimezone()
    assert end.record.steps == STEPS and report.name == f"report-{at:%Y-%m-%d-%H%M}.html"


@pytest.mark.slow
async def test_an_interrupted_game_can_be_discarded_for_a_new_one(
    interrupted: Workspace, run: Run
) -> None:
    async with run(app=Program(interrupted, clock=StillClock())) as pilot:
        await asked(pilot)
        await pilot.press("down", "down", "enter")
        await until(lambda: len(list(interrupted.store.events(GameBeginning))) == 2)


@pytest.mark.slow
async def test_esc_keeps_the_interrupted_game(interrupted: Workspace, run: Run) -> None:
    async with run(app=Program(interrupted, clock=StillClock())) as pilot:
        await asked(pilot)
        await pilot.press("escape")
        await until(lambda: isinstance(pilot.app.screen, HomeScreen))

    assert not list(interrupted.store.events(GameEnding))


async def test_a_new_person_can_be_added_before_a_live_game_resumes(
    workspace: Workspace, learnt: Policy, run: Run
) -> None:
    world = held_world(workspace, HeldLink())
    supervision = workspace.supervision(learnt, 5, asks=True, world=world)
    supervision.begin()
    while supervision.steps < 2:
        supervision.step()
    chosen: list[GameToPlay | None] = []

    async def start(program: Program) -> None:
        chosen.append(await ask_about_interrupted(program, LIVE))

    async with run(app=Program(workspace, start, clock=StillClock())) as pilot:
        await until_shown(pilot, lambda: "somebody who has come" in pilot.text())
        await pilot.press("down", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, NameDialog))
        await pilot.press(*"Zelda", "enter")
        await until_shown(pilot, lambda: "is Zelda" in pilot.text().replace("Is", "is"))
        await pilot.press("enter")
        await until_shown(pilot, lambda: "Zelda joins" in pilot.text())
        await pilot.press("enter")
        await until(lambda: chosen)
    (to_play,) = chosen
    assert to_play is not None and to_play.past is not None
    assert to_play.past.newcomers == ("user5",)
    assert to_play.past.beginning.people == tuple(workspace.names)
