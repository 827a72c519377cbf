"""The page on which a live game is set up: choices, checks, and nothing that moves before begin."""

from __future__ import annotations

from typing import Any

import pytest

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_hw.robot_process.stop_latch import STAFF
from tangy_profiles.game_rules import GamePlan
from tangy_profiles.health import OK, STALE
from tangy_tui.app.set_up import SetUp
from tangy_tui.app.workspace import Workspace
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.tablet import qr_lines
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.set_up import SetUpScreen
from tangy_tui.ui.terminal import TerminalKind
from tests.pilot.conftest import Run, StillClock
from tests.pilot.live_games import HeldLink, live_world
from tests.support.waiting import until_shown


class Setting:
    """A program that opens with the page, and a robot that is switched on when it asks for it."""

    def __init__(self, workspace: Workspace) -> None:
        self.workspace = workspace
        self.setup = SetUp.of(workspace)
        self.link = HeldLink()
        self.begins: list[bool] = []

    async def switch_on(self) -> LiveWorld | None:
        return live_world(self.workspace, self.link)

    def program(self) -> Program:
        async def start(program: Program) -> None:
            page = SetUpScreen(self.setup, self.switch_on)
            self.begins.append(await program.push_screen_wait(page))

        return Program(
            self.workspace, start, kind=TerminalKind(full_screen=True), clock=StillClock()
        )


@pytest.fixture
def setting(workspace: Workspace) -> Setting:
    return Setting(workspace)


async def opened(pilot: Any) -> None:
    await until_shown(pilot, lambda: isinstance(pilot.app.screen, SetUpScreen))


async def test_people_patterns_and_seats_are_chosen_by_keys_and_nothing_moves(
    run: Run, setting: Setting
) -> None:
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        await pilot.press("enter", "down", "right", "1", "6")
        setup = setting.setup
        assert setup.away == {"user1"} and setup.seats == ["user1", "user3", "user2", "user4"]
        assert list(setting.workspace.names) == setup.seats
        assert setup.plan == GamePlan(("line", "full card"), absent=("user1",), pace=setup.pace)
        await pilot.press("1")
        assert setup.patterns == ["full card"] and setting.link.done == []


async def test_begin_switches_on_and_begins(run: Run, setting: Setting) -> None:
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        await pilot.press("B")
        await until_shown(pilot, lambda: setting.begins == [True])
        assert setting.setup.world is not None


async def test_what_is_not_ready_is_said_before_the_game_begins(run: Run, setting: Setting) -> None:
    setting.link.ail("voice", STALE)
    setting.setup.world = live_world(setting.workspace, setting.link)
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        assert [check.name for check in setting.setup.not_ready] == ["robot"]
        await pilot.press("B")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
        await pilot.press("n")
        await opened(pilot)
        assert setting.begins == []
        await pilot.press("escape")
        await until_shown(pilot, lambda: setting.begins == [False])


def test_a_tablet_that_is_not_there_is_no_fault_of_the_robot(setting: Setting) -> None:
    setting.link.ail("screen", STALE)
    setting.setup.world = live_world(setting.workspace, setting.link)
    robot, *_ = setting.setup.checks()
    assert (robot.name, robot.state) == ("robot", "ready")


async def test_a_stop_while_devices_get_ready_calls_the_game_off(
    run: Run, setting: Setting
) -> None:
    setting.link.ail("voice", STALE)
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        await pilot.press("B")
        await until_shown(pilot, lambda: setting.setup.world is not None)
        await pilot.press("ctrl+x")
        await until_shown(pilot, lambda: setting.link.held_by == {STAFF})
        setting.link.ail("voice", OK)
        await until_shown(pilot, lambda: all(one.is_finished for one in pilot.app.workers
                                             if one.name == "begin"))  # fmt: skip
        assert setting.begins == [] and isinstance(pilot.app.screen, SetUpScreen)
        await pilot.press("B")
        await until_shown(pilot, lambda: setting.begins == [True])


async def test_sound_is_ready_once_it_was_heard(run: Run, setting: Setting) -> None:
    setting.setup.world = live_world(setting.workspace, setting.link)
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        await pilot.press("end", "enter")
        await until_shown(pilot, lambda: setting.setup.said)
        assert setting.link.said and setting.setup.not_ready[-1].name == "sound"
        await pilot.press("enter")
        await until_shown(pilot, lambda: setting.setup.heard)
        assert not setting.setup.not_ready


def test_a_code_has_light_all_round_and_is_square() -> None:
    lines = qr_lines("http://192.168.1.20:8000/")
    assert len({len(line) for line in lines}) == 1 and lines[0] == "█" * len(lines[0])
    assert abs(len(lines[0]) - 2 * len(lines)) <= 1
