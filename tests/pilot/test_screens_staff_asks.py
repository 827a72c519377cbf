"""What staff ask of a live game by keys and words, and what the screen answers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.text.confirmations import called_meanwhile
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.program import Program
from tests.pilot.conftest import screen_text
from tests.pilot.live_games import HeldLink, live_program, live_world, paused_after
from tests.support.waiting import until_shown

if TYPE_CHECKING:
    from tests.pilot.conftest import Run


@pytest.fixture
def link() -> HeldLink:
    return HeldLink()


@pytest.fixture
def world(workspace: Workspace, link: HeldLink) -> LiveWorld:
    return live_world(workspace, link)


@pytest.fixture
def program(workspace: Workspace, world: LiveWorld, policy: Policy) -> Program:
    return live_program(workspace, world, policy)


@pytest.mark.slow
async def test_the_question_about_a_call_tells_of_a_call_that_came_meanwhile(
    run: Run, program: Program, link: HeldLink, world: LiveWorld, workspace: Workspace
) -> None:
    label = workspace.activity.deck.label
    async with run(app=program) as pilot:
        await paused_after(pilot, link, 2)
        asked, meanwhile = world.called_now[-1], world.called_now[-1] % 75 + 1
        await pilot.press("f2")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
        world.calls.called.append(meanwhile)
        await until_shown(
            pilot, lambda: called_meanwhile(label(meanwhile)) in screen_text(pilot.app)
        )
        await pilot.press("y")
        await until_shown(pilot, lambda: asked not in world.called_now)
        assert meanwhile in world.called_now
