"""At most one question about a fault is open, and an answered fault leaves the screen at once."""

from __future__ import annotations

import pytest

from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.fault import BORNE, OVER
from tangy_tui.text.faults import told_in_banner
from tangy_tui.text.games import ANSWER_FIRST
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.question import QuestionDialog
from tangy_tui.ui.screens.question_panel import AskingPanel
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.fault_banner import FaultBanner
from tangy_tui.ui.widgets.status_line import StatusLine
from tests.pilot.conftest import Run
from tests.pilot.faults import asked, game_of, kinds_of, playing, sentences
from tests.pilot.live_games import HeldLink, held_world, live, live_program
from tests.support.waiting import until_shown


@pytest.mark.slow
async def test_the_question_whether_a_fault_was_seen_closes_once_the_fault_is_over(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy, speed=1000)) as pilot:
        screen, game, world = game_of(pilot)
        for kind in ("arm-failed", "requests-silent"):
            world.inject(kind)
        await until_shown(pilot, lambda: [f.status for f in game.faults] == [BORNE, BORNE])
        await pilot.press("p", "a")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
        first = told_in_banner(game)[0]
        for kind in ("arm-failed", "requests-silent"):
            if first.code == kind:
                world.lift(kind)
        await until_shown(pilot, lambda: pilot.app.screen is screen)
        over, other = sorted(game.faults, key=lambda fault: fault.status != OVER)
        assert (over.id, over.status) == (first.id, OVER)
        assert (other.status, other.acknowledged) == (BORNE, False)


@pytest.mark.slow
async def test_a_fault_that_tangy_asks_about_has_no_second_question(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy, "no-effect", speed=1000)) as pilot:
        screen, game, _ = game_of(pilot)
        await asked(pilot)
        banner = pilot.lines()[1]
        assert game.faults[0].name in banner and "seen" not in banner
        await pilot.press("escape", "a")
        await until_shown(pilot, lambda: sentences(screen)[-1] == ANSWER_FIRST)
        assert pilot.app.screen is screen
        assert "acknowledged" not in kinds_of(game.faults[0])


@pytest.mark.slow
async def test_an_answered_fault_leaves_the_screen_while_tangy_carries_the_answer_out(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    link = HeldLink()
    link.missed.add("user2")
    async with run(app=live_program(workspace, held_world(workspace, link), policy)) as pilot:
        screen, game = live(pilot), live(pilot).control.supervision
        await until_shown(pilot, lambda: game.steps >= 2)
        link.sign(2)
        await until_shown(pilot, lambda: screen.query(AskingPanel))
        await until_shown(pilot, lambda: any(not bar.closed for bar in screen.query(CommandBar)))
        assert screen.query_one(StatusLine).status.robot.startswith("ASKS")
        link.free = False
        pilot.type(*"go to user two", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, QuestionDialog))
        await pilot.press("y")
        await until_shown(pilot, lambda: game.faults[0].status == OVER)
        await until_shown(pilot, lambda: screen.query_one(StatusLine).status.robot == "OK")
        assert not screen.query_one(FaultBanner).display
        assert screen.working  # it still carries the answer out
        link.free = True
