"""Tangy asks once where old games were played if the log does not say it."""

from __future__ import annotations

from tangy_profiles.game_world import LIVE, UNKNOWN
from tangy_tui.app.teacher_profile import TeacherProfile, save_profile
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_worlds import GameWorlds
from tangy_tui.ui.dialogs.choose import ChooseDialog
from tangy_tui.ui.program import Program
from tests.pilot.conftest import Run, StillClock
from tests.support.append_body import append_body
from tests.support.waiting import until

BODY = {"game": "old", "number": 1, "activity": "a", "policy": "", "seed": 1, "people": ["p"]}


def old(workspace: Workspace) -> None:
    append_body(workspace.store, "game begun", BODY)
    save_profile(workspace.store.folder, TeacherProfile("Ada"))


async def test_one_answer_settles_all_old_games(workspace: Workspace, run: Run) -> None:
    old(workspace)
    async with run(app=Program(workspace, clock=StillClock(), asks_name=True)) as pilot:
        await until(lambda: isinstance(pilot.app.screen, ChooseDialog))
        await pilot.press("down", "down", "enter")
        await until(lambda: GameWorlds(workspace.store).all == {"old": LIVE})


async def test_an_unknown_place_is_not_asked_again(workspace: Workspace, run: Run) -> None:
    old(workspace)
    GameWorlds(workspace.store).settle(["old"], UNKNOWN, "Ada")
    async with run(app=Program(workspace, clock=StillClock(), asks_name=True)) as pilot:
        await pilot.pause()
        assert not isinstance(pilot.app.screen, ChooseDialog)
