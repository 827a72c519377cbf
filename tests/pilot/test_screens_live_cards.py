"""Owners of cards on the live screen: doubts are reported at once, and staff assign cards."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.staff_records import StaffAction
from tangy_tui.app.game_commands import GoOn, Pause
from tangy_tui.app.workspace import Workspace
from tangy_tui.text.cards import NO_NUMBER, TYPE_NUMBER, in_sight_words
from tangy_tui.ui.dialogs.card_number import CardNumberDialog
from tangy_tui.ui.dialogs.choose import ChooseDialog
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.widgets.log_view import LogView
from tests.hw.links import LaidCard
from tests.pilot.conftest import screen_text
from tests.pilot.live_games import HeldLink, live, paused_after
from tests.support.waiting import until_shown

if TYPE_CHECKING:
    from tests.pilot.conftest import Run, TangyPilot


def told(pilot: TangyPilot) -> str:
    return " ".join(live(pilot).query_one(LogView).sentences)


def notes(workspace: Workspace) -> list[tuple[str, str, str]]:
    found = (event.record for event in workspace.store.events(StaffAction))
    return [(one.did, one.person, one.detail) for one in found]


async def answer_about_owner(pilot: TangyPilot, workspace: Workspace, key: str) -> None:
    """Answer the question about a card that user2 has; the question names them."""
    await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
    await shown(pilot, f"is {workspace.name('user2')}'s")
    await pilot.pause(0.6)  # keys typed ahead do not count
    await pilot.press(key)
    await until_shown(pilot, lambda: not isinstance(pilot.app.screen, ConfirmDialog))


async def shown(pilot: TangyPilot, text: str) -> None:
    await until_shown(pilot, lambda: text in screen_text(pilot.app))


@pytest.mark.slow
async def test_two_cards_are_reported_to_staff_without_a_word_on_marks(
    run: Run, program: Program, link: HeldLink, workspace: Workspace
) -> None:
    async with run(app=program) as pilot:
        await paused_after(pilot, link, 2)
        link.cards["user1"] = LaidCard(17, marked=1, others=(31,))
        link.sign(1)
        before = len(link.said)
        live(pilot).control.apply(GoOn())
        name = workspace.name("user1")
        await until_shown(
            pilot, lambda: f"There are two cards in front of {name}: 17 and 31" in told(pilot)
        )
        assert "Tangy cannot tell which is theirs, and judges neither" in told(pilot)
        live(pilot).control.apply(Pause())
        await until_shown(pilot, lambda: not live(pilot).working)
        wrong = workspace.activity.behaviours["remove markers"].name
        assert not [said for said in link.said[before:] if wrong in said]
        assert ("card doubted", "user1", "several cards: 17, 31") in notes(workspace)


@pytest.mark.slow
async def test_staff_can_assign_a_card(
    run: Run, program: Program, link: HeldLink, world: LiveWorld, workspace: Workspace
) -> None:
    world.cards.dealt.deal({"user1": 17, "user2": 31})
    async with run(app=program) as pilot:
        await paused_after(pilot, link, 2)
        world.cards.look("user1", [], person="user1")
        link.place = "user1"
        link.cards["user1"] = LaidCard(31)
        world.cards.look("user1", [], person="user1")
        assert world.cards.doubt is not None
        await until_shown(pilot, lambda: "as far as Tangy knows" in told(pilot))
        await pilot.press("b")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ChooseDialog))
        await shown(pilot, "has card 17")
        await pilot.press("enter")
        await shown(pilot, f"Which card does {workspace.name('user1')} have?")
        await shown(pilot, in_sight_words(workspace.name("user2")))
        await pilot.press("enter")
        await answer_about_owner(pilot, workspace, "y")
        await until_shown(pilot, lambda: world.cards.dealt.card_of("user1") == 31)
        assert world.cards.dealt.card_of("user2") is None
        assert ("card given", "user1", "31") in notes(workspace)
        world.cards.look("user1", [], person="user1")
        assert world.cards.doubt is None


@pytest.mark.slow
async def test_staff_can_let_tangy_learn_a_card_again(
    run: Run, program: Program, link: HeldLink, world: LiveWorld
) -> None:
    world.cards.dealt.deal({"user1": 17})
    async with run(app=program) as pilot:
        await paused_after(pilot, link, 2)
        await pilot.press("b")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ChooseDialog))
        await pilot.press("enter")
        await shown(pilot, "another one")
        await pilot.press("down", "enter")
        await until_shown(pilot, lambda: world.cards.dealt.card_of("user1") is None)


@pytest.mark.slow
async def test_staff_can_type_the_number_of_a_card_before_it_was_seen(
    run: Run, program: Program, link: HeldLink, world: LiveWorld, workspace: Workspace
) -> None:
    world.cards.dealt.deal({"user2": 17})
    async with run(app=program) as pilot:
        await paused_after(pilot, link, 2)
        await pilot.press("b")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ChooseDialog))
        await pilot.press("enter")
        await shown(pilot, TYPE_NUMBER)
        await pilot.press("enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, CardNumberDialog))
        await pilot.press(*"x", "enter")
        await shown(pilot, NO_NUMBER)
        await pilot.press("backspace", *"17", "enter")
        await answer_about_owner(pilot, workspace, "n")
        assert world.cards.dealt.card_of("user2") == 17
        await pilot.press("b")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ChooseDialog))
        await pilot.press("enter")
        await shown(pilot, TYPE_NUMBER)
        await pilot.press("enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, CardNumberDialog))
        await pilot.press(*"17", "enter")
        await answer_about_owner(pilot, workspace, "y")
        await until_shown(pilot, lambda: world.cards.dealt.card_of("user1") == 17)
        assert world.cards.dealt.card_of("user2") is None
        assert ("card given", "user1", "17") in notes(workspace)
