"""A live game without cards offers only what can be done in it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tangy_hw.robot_client.declared_live_world import DeclaredLiveWorld
from tangy_tui.app.robot_controls import PersonWait, RobotControls
from tangy_tui.app.workspace import Workspace
from tangy_tui.text.typed_commands import TITLE
from tangy_tui.ui.dialogs.staff_line import CommandDialog
from tangy_tui.ui.screens.help import help_for
from tangy_tui.ui.widgets.staff_panel import StaffPanel
from tests.pilot.live_games import HeldLink, held_world, live, live_program
from tests.support.teaching import taught_policy
from tests.support.waiting import until_shown

if TYPE_CHECKING:
    from tests.pilot.conftest import Run


@pytest.fixture
def workspace(tmp_path: Path) -> Iterator[Workspace]:
    with closing(Workspace(tmp_path, activity="trivia", users=2)) as opened:
        yield opened


@pytest.mark.slow
async def test_a_quiz_has_no_keys_and_no_examples_about_cards(
    run: Run, workspace: Workspace
) -> None:
    link = HeldLink(tuple(workspace.names))
    world = held_world(workspace, link, DeclaredLiveWorld)
    async with run(app=live_program(workspace, world, taught_policy(workspace))) as pilot:
        await until_shown(pilot, lambda: len(link.said) > 0)
        helped = help_for(live(pilot)).here
        assert [key for key, _ in helped if key in "KL<>bk+-l"] == ["L", "l"]
        await pilot.press("K", "colon")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, CommandDialog))
        assert TITLE in pilot.text() and "left Rosa" in pilot.text()
        assert "pace" not in pilot.text().partition(TITLE)[2].partition("enter does it")[0]


@pytest.mark.slow
async def test_the_question_stays_in_view_while_tangy_waits_for_the_answer(
    run: Run, workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    waits = PersonWait("act", "user1", 8)
    monkeypatch.setattr(RobotControls, "waits_for", property(lambda controls: waits))
    world = held_world(workspace, HeldLink(tuple(workspace.names)), DeclaredLiveWorld)
    async with run(app=live_program(workspace, world, taught_policy(workspace))) as pilot:
        panel = live(pilot).query_one(StaffPanel)
        await until_shown(pilot, lambda: "Tangy said:" in str(panel.border_title))
        assert "Tangy waits for User 1, up to 8 s." in pilot.text()
