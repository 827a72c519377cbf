"""Letters that are typed right after a key, before what the key opens is there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from textual.widgets import Input

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_tui.text.staff_view import you_say_words
from tangy_tui.ui.dialogs.choose import ChooseDialog
from tangy_tui.ui.dialogs.staff_line import CommandDialog, NextDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.round_trip import ReplyParser
from tests.pilot.conftest import SMALL, screen_text
from tests.pilot.live_games import HeldLink, ask_for_the_choice, live, until_a_call_is_held
from tests.support.waiting import until_shown

if TYPE_CHECKING:
    from tests.pilot.conftest import Run, TangyPilot


def together(pilot: TangyPilot, key: str, letters: str) -> None:
    """Type a key, and letters that the terminal sends in one piece right after it."""
    pilot.type(key)
    for message in ReplyParser().feed(letters):
        pilot.app.post_message(message)


async def at_the_front(pilot: TangyPilot, world: LiveWorld) -> None:
    """Wait until Tangy only waits for the time of the second call."""
    await until_shown(pilot, lambda: len(world.called) == 1)
    await until_shown(pilot, lambda: live(pilot).control.counts_down)


@pytest.mark.slow
async def test_words_right_after_the_key_for_the_choice_reach_tangy_at_the_front(
    run: Run, program: Program, world: LiveWorld
) -> None:
    world.pace = 300.0
    async with run(app=program, size=SMALL) as pilot:
        await at_the_front(pilot, world)
        together(pilot, "o", "celebrate\r")
        await until_shown(pilot, lambda: "That cannot be done now" in screen_text(pilot.app))
        assert "> celebrate" in screen_text(pilot.app)


@pytest.mark.slow
@pytest.mark.parametrize("key", ["h", "L", "b"])
async def test_letters_right_after_the_key_of_a_list_filter_it(
    run: Run, program: Program, world: LiveWorld, key: str
) -> None:
    world.pace = 300.0
    async with run(app=program, size=SMALL) as pilot:
        await at_the_front(pilot, world)
        together(pilot, key, "user 3")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ChooseDialog))
        await until_shown(pilot, lambda: "/user 3_" in screen_text(pilot.app))
        assert "User 4" not in screen_text(pilot.app).partition("/user 3_")[0].rpartition("╭")[2]


@pytest.mark.slow
@pytest.mark.parametrize(("key", "begun"), [("K", "bingo "), ("colon", "")])
async def test_letters_right_after_the_key_of_a_line_are_in_it(
    run: Run, program: Program, world: LiveWorld, key: str, begun: str
) -> None:
    world.pace = 300.0
    async with run(app=program, size=SMALL) as pilot:
        await at_the_front(pilot, world)
        together(pilot, key, "pace 20")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, CommandDialog))
        line = pilot.app.screen.query_one(Input)
        await until_shown(pilot, lambda: line.value == f"{begun}pace 20")
        assert live(pilot).control.going  # p is no key here


@pytest.mark.slow
async def test_words_that_wait_for_tangy_are_shown_and_another_line_keeps_them(
    run: Run, program: Program, link: HeldLink, world: LiveWorld
) -> None:
    async with run(app=program, size=SMALL) as pilot:
        await until_a_call_is_held(pilot, link, world)
        await ask_for_the_choice(pilot)
        await pilot.press(*"call number", "enter")
        await until_shown(pilot, lambda: you_say_words("call number") in screen_text(pilot.app))
        await pilot.press("colon")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, CommandDialog))
        await pilot.press("escape")
        await until_shown(pilot, lambda: live(pilot).is_active)
        await ask_for_the_choice(pilot)  # shows them again
        assert pilot.app.screen.query_one(Input).value == "call number"
        await pilot.press("enter")
        link.most = len(link.said)
        await until_shown(pilot, lambda: "Did you say: call number?" in screen_text(pilot.app))
        link.most = 1000


@pytest.mark.slow
async def test_the_key_for_the_choice_leads_back_to_the_line_of_its_question(
    run: Run, program: Program, world: LiveWorld
) -> None:
    world.pace = 300.0
    async with run(app=program, size=SMALL) as pilot:
        await at_the_front(pilot, world)
        await pilot.press("o")
        await until_shown(pilot, lambda: live(pilot).query("#command-input"))
        await until_shown(pilot, lambda: live(pilot).is_active)
        line = live(pilot).query_one("#command-input", Input)
        await until_shown(pilot, lambda: line.has_focus)
        pilot.app.screen.set_focus(None)  # as by a click elsewhere
        await until_shown(pilot, lambda: not line.has_focus)
        together(pilot, "o", "greet")
        await until_shown(pilot, lambda: line.value == "greet")


@pytest.mark.slow
async def test_the_word_stop_counts_if_one_of_its_letters_opened_a_line(
    run: Run, program: Program, link: HeldLink, world: LiveWorld
) -> None:
    async with run(app=program, size=SMALL) as pilot:
        await until_a_call_is_held(pilot, link, world)
        await pilot.press(*"sto")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, NextDialog))
        await pilot.press(*"p the robot")
        await until_shown(pilot, lambda: live(pilot).is_active and live(pilot).control.stopped)
        link.most = 1000
