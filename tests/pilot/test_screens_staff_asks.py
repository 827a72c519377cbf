"""What staff ask of a live game by keys and words, and what the screen answers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from textual.widgets import Input

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_tui.app.command_grammar import command_reader
from tangy_tui.app.game_commands import AskFor
from tangy_tui.app.similar_commands import nearest_commands
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.text.confirmations import called_meanwhile
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.staff_line import CommandDialog
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


async def test_a_refused_command_is_typed_over_or_replaced_by_a_similar_one(
    run: Run, workspace: Workspace
) -> None:
    reader = command_reader(workspace.activity, lambda who: workspace.find_person(who).id)
    name = workspace.name("user2")

    def similar(typed: str) -> tuple[str, ...]:
        return nearest_commands(typed, [*workspace.names.values()], workspace.activity.rules)

    async with run() as pilot:
        answers: list[object] = []
        dialog = CommandDialog(reader, "", "", similar)
        await pilot.app.push_screen(dialog, answers.append)
        line = dialog.query_one(Input)
        await pilot.press(*"qwertz", "enter")
        await pilot.press(*"zz")
        assert line.value == "zz"  # the next letter replaced the line
        line.value = f"help {name}"
        await pilot.press("enter", "end", "x")
        assert line.value == f"help {name}x"  # it can be corrected, too
        await pilot.press("backspace", "enter", "tab", "enter")
        assert answers == [AskFor("user2")]
