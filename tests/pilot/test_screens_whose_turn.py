"""Staff ask why, and when Tangy goes to a person: the screen answers in plain words first."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import pytest
from textual.widgets import Input

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_tui.app.game_commands import StopRobot
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.text.cards import WHOSE
from tangy_tui.text.typed_commands import WHO_IS_HERE
from tangy_tui.text.whose_turn import IN_DETAIL, WHO_WAITS, WHOSE_TURN
from tangy_tui.ui.dialogs.choose import ChooseDialog
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.dialogs.why import WhyDialog
from tangy_tui.ui.program import Program
from tests.interaction.gaps import learnt, without
from tests.pilot.conftest import LARGE, SMALL, TangyPilot, screen_text
from tests.pilot.live_games import HeldLink, live, paused_after
from tests.pilot.test_screens_asking import FEW, Cover, asked, gap, playing
from tests.support.live_worlds import live_world
from tests.support.waiting import until_shown

if TYPE_CHECKING:
    from tests.pilot.conftest import Run


@pytest.fixture
def gappy(workspace: Workspace, cover: Cover) -> Policy:
    """A policy that was never shown one situation."""
    shown = [without(one, gap(workspace)) for one in cover("bingo", 1, 4)]
    return learnt(workspace.store, workspace.activity, shown, FEW)


@pytest.fixture
def world(workspace: Workspace, link: HeldLink) -> LiveWorld:
    return live_world(workspace, link)


def shown(pilot: TangyPilot) -> str:
    """Return the text of the screen without frames, in one line."""
    return " ".join(screen_text(pilot.app).replace("│", " ").split())


def plain_lines(pilot: TangyPilot) -> list[str]:
    dialog = pilot.app.screen
    assert isinstance(dialog, WhyDialog)
    return [*dialog.plain]


async def typed(pilot: TangyPilot, words: str) -> None:
    """Type a command into the line of the screen."""
    await pilot.press("colon")
    await until_shown(pilot, lambda: bool(pilot.app.screen.query(Input)))
    pilot.app.screen.query_one(Input).value = words
    await pilot.press("enter")


@pytest.mark.slow
@pytest.mark.parametrize("size", [SMALL, LARGE], ids=["small", "large"])
async def test_why_tells_first_in_plain_words_what_tangy_does_and_who_waits(
    run: Run, program: Program, link: HeldLink, workspace: Workspace, size: tuple[int, int]
) -> None:
    async with run(app=program, size=size) as pilot:
        await paused_after(pilot, link, 2)
        paused = "The game is paused. Tangy does nothing until you let it go on."
        await pilot.press("w")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, WhyDialog))
        calls = "Tangy calls the next number, because nobody asks for help."
        told, step = plain_lines(pilot)
        assert told == paused and step.startswith(calls)
        assert paused in shown(pilot) and calls in shown(pilot) and IN_DETAIL in shown(pilot)
        await pilot.press("enter")  # opens no demonstration
        await until_shown(pilot, lambda: pilot.app.screen is live(pilot))
        await typed(pilot, f"help {workspace.name('user2')}")
        await until_shown(pilot, lambda: "user2" in live(pilot).world.queue)
        await typed(pilot, f"go to {workspace.name('user3')}")
        await until_shown(pilot, lambda: "user3" in live(pilot).world.queue)
        live(pilot).world.observe()
        await pilot.press("w")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, WhyDialog))
        first, second = workspace.name("user2"), workspace.name("user3")
        goes = f"Tangy goes to {first} next, because {first} has waited longest."
        assert plain_lines(pilot) == [paused, goes, f"{second} waits, too."]
        assert re.search(r"why, at \d\d:\d\d:\d\d", shown(pilot))
        await pilot.press("escape")
        await typed(pilot, "who has asked for help?")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, MessageDialog))
        assert WHO_WAITS in shown(pilot)
        assert f"1. {first} " in shown(pilot) and f"2. {second} " in shown(pilot)


@pytest.mark.slow
@pytest.mark.parametrize("size", [SMALL, LARGE], ids=["small", "large"])
async def test_a_typed_question_about_a_person_is_answered(
    run: Run, program: Program, link: HeldLink, workspace: Workspace, size: tuple[int, int]
) -> None:
    async with run(app=program, size=size) as pilot:
        await paused_after(pilot, link, 2)
        name = workspace.name("user2")
        await typed(pilot, f"why does nobody go to {name}?")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, MessageDialog))
        assert WHOSE_TURN in shown(pilot)
        assert f"{name} has not asked for help." in shown(pilot)
        await pilot.press("enter")
        await until_shown(pilot, lambda: pilot.app.screen is live(pilot))
        live(pilot).control.apply(StopRobot())
        await typed(pilot, f"when is it {name}'s turn")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, MessageDialog))
        assert "Tangy was stopped. It stands still until you let it go on." in shown(pilot)
        await pilot.press("enter")
        await typed(pilot, "why not Xaver")
        await until_shown(pilot, lambda: "There is nobody called 'Xaver'" in shown(pilot))


@pytest.mark.slow
async def test_a_question_about_a_person_is_no_answer_to_tangy(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    async with run(app=playing(workspace, gappy)) as pilot:
        screen: Any = await asked(pilot)
        name = workspace.name("user2")
        pilot.type(*f"why not {name}", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, MessageDialog))
        assert "Tangy waits for your answer. Nobody has shown Tangy" in shown(pilot)
        assert f"{name} has not asked for help." in shown(pilot)
        await pilot.press("enter")
        assert screen.control.supervision.question is not None
        pilot.type(*"why", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, WhyDialog))
        assert "Tangy waits for your answer. Nobody has shown Tangy" in shown(pilot)


@pytest.mark.slow
async def test_cards_and_people_can_be_asked_for_in_words(
    run: Run, program: Program, link: HeldLink, workspace: Workspace
) -> None:
    async with run(app=program, size=SMALL) as pilot:
        await paused_after(pilot, link, 2)
        for words, question in (("cards", WHOSE), ("who is here", WHO_IS_HERE)):
            await typed(pilot, words)
            await until_shown(pilot, lambda: isinstance(pilot.app.screen, ChooseDialog))
            assert question in shown(pilot)
            await pilot.press("escape")
            await until_shown(pilot, lambda: pilot.app.screen is live(pilot))
        one, another = workspace.name("user2"), workspace.name("user4")
        await typed(pilot, f"left {one} and {another}")
        plan = live(pilot).control.plan
        await until_shown(pilot, lambda: set(plan.away) == {"user2", "user4"})
