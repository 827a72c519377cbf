"""The planned time of a session on the screen of a live game."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING

import pytest

from tangy_tui.text.planned_time import HOW_LONG
from tangy_tui.ui.program import Program
from tests.pilot.conftest import screen_text
from tests.pilot.live_games import HeldLink, live, paused_after
from tests.support.waiting import until_shown

if TYPE_CHECKING:
    from tests.pilot.conftest import Run


@pytest.mark.slow
async def test_a_game_after_the_planned_time_says_so_and_how_to_plan_more(
    run: Run, program: Program, link: HeldLink
) -> None:
    async with run(app=program, size=(120, 40)) as pilot:
        await paused_after(pilot, link, 2)
        control = live(pilot).control
        control.time.end_at(datetime.now(UTC) - timedelta(minutes=3))
        await until_shown(pilot, lambda: "time is up since" in screen_text(pilot.app))
        await pilot.press("f7")
        more = "press : and type: plan 20 minutes"
        told = " ".join(screen_text(pilot.app).replace("│", " ").split())
        assert "The planned time has been over since" in told and more in told
        await pilot.press("n")
        pilot.type(":", *"plan 20 minutes", "enter")
        await until_shown(pilot, lambda: "20 minutes from now" in screen_text(pilot.app))
        left = control.time.left
        assert left is not None and 19 * 60 < left <= 20 * 60
        pilot.type(":", *"how long", "enter")
        await until_shown(pilot, lambda: HOW_LONG in screen_text(pilot.app))
        assert "minutes left" in screen_text(pilot.app)
