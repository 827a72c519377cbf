"""The setup page of a live game: choices and checks; nothing moves before the start."""

from __future__ import annotations

from pathlib import Path
from threading import Event
from typing import Any

import pytest
from textual.app import ComposeResult

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_hw.robot_process.stop_latch import STAFF
from tangy_profiles.errors import TangyError
from tangy_profiles.game_rules import GamePlan
from tangy_profiles.health import OK, STALE
from tangy_tui.app.set_up import SetUp
from tangy_tui.app.workspace import Workspace
from tangy_tui.text import set_up as text
from tangy_tui.text.set_up import NOT_READY
from tangy_tui.text.staff_view import said_words
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.dialogs.choose import ChooseDialog
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.tablet import qr_lines
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.help import help_for
from tangy_tui.ui.screens.set_up import SetUpScreen
from tangy_tui.ui.terminal import TerminalKind
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.set_up_list import SetUpList
from tangy_tui.ui.widgets.staff_panel import StaffPanel
from tangy_tui.ui.widgets.status_line import StatusLine
from tests.pilot.conftest import LARGE, Run, StillClock
from tests.pilot.live_games import HeldLink, held_world
from tests.support.waiting import until_shown


class Setting:
    """A program that opens with the page, and a robot that it can open."""

    def __init__(self, workspace: Workspace) -> None:
        self.workspace = workspace
        self.setup = SetUp.of(workspace)
        self.link = HeldLink()
        self.begins: list[bool] = []

    async def switch_on(self) -> LiveWorld | None:
        return held_world(self.workspace, self.link)

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


@pytest.mark.slow
async def test_keys_choose_people_patterns_and_seats_without_moving_the_robot(
    run: Run, setting: Setting
) -> None:
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        await pilot.press("enter", "down", "space", "down", "space", "1", "6")
        setup = setting.setup
        assert setup.away == {"user1"} and setup.seats == ["user1", "user3", "user2", "user4"]
        assert list(setting.workspace.names) == setup.seats
        assert setup.plan == GamePlan(("line", "full card"), absent=("user1",), pace=setup.pace)
        await pilot.press("1")
        assert setup.patterns == ["full card"] and setting.link.done == []


async def test_moving_a_person_shows_the_keys_for_it(run: Run, setting: Setting) -> None:
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        await pilot.press("space")
        await until_shown(pilot, lambda: "User 1: the arrows" in pilot.lines()[1])
        await pilot.press("down")
        await until_shown(pilot, lambda: "User 1 and User 2 change seats?" in pilot.lines()[1])
        await pilot.press("space")
        await until_shown(pilot, lambda: "change seats" not in pilot.lines()[1])
        assert setting.setup.seats[:2] == ["user2", "user1"]


async def test_esc_puts_a_person_back_whom_the_arrows_carried(run: Run, setting: Setting) -> None:
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        before = [*setting.setup.seats]
        await pilot.press("space", "down", "down")
        assert setting.setup.seats == ["user3", "user2", "user1", "user4"]  # as it would be
        await pilot.press("escape")
        await until_shown(pilot, lambda: "change seats" not in pilot.lines()[1])
        assert setting.setup.seats == before == list(setting.workspace.names)
        await pilot.press("down")
        assert setting.setup.seats == before and setting.begins == []


async def test_the_help_shows_the_title_of_a_list_without_its_markup(
    run: Run, setting: Setting
) -> None:
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        await pilot.press("space")
        await pilot.pause()
        assert help_for(pilot.app.screen).title == f"Tangy · {text.CARRIED.format('User 1')}"


async def test_the_current_line_is_marked_and_shows_its_keys(run: Run, setting: Setting) -> None:
    async with run(app=setting.program()) as pilot:
        await pilot.press(*["down"] * (len(setting.setup.seats) + 2))
        await until_shown(
            pilot, lambda: "▸ Played for             a line, as usual" in pilot.text()
        )
        assert "← →" not in pilot.text()
        await pilot.press("down")
        await until_shown(pilot, lambda: "▸ Winners                one  ← →" in pilot.text())


async def test_every_pattern_is_named_beside_the_room(run: Run, setting: Setting) -> None:
    patterns = setting.workspace.activity.rules.patterns
    async with run(app=setting.program(), size=(120, 40)) as pilot:
        last = patterns[-1].name.split()[-1]
        await until_shown(pilot, lambda: last in pilot.text())
        words = " ".join(pilot.text().split())
        assert [one.name for one in patterns if one.name.split()[-1] not in words] == []


async def test_begin_opens_the_robot_and_starts_the_game(run: Run, setting: Setting) -> None:
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        await pilot.press("B")
        await until_shown(pilot, lambda: setting.begins == [True])
        assert setting.setup.world is not None


@pytest.mark.slow
async def test_leaving_asks_only_if_choices_would_be_lost(run: Run, setting: Setting) -> None:
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        setting.setup.away.add(setting.setup.seats[0])
        await pilot.press("escape")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
        await pilot.press("n")
        await opened(pilot)
        assert setting.begins == []
        setting.setup.away.clear()
        await pilot.press("escape")
        await until_shown(pilot, lambda: setting.begins == [False])


async def test_unready_parts_are_reported_before_the_game(run: Run, setting: Setting) -> None:
    setting.link.ail("voice", STALE)
    setting.setup.world = held_world(setting.workspace, setting.link)
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


def test_a_missing_tablet_is_no_fault_of_the_robot(setting: Setting) -> None:
    setting.link.ail("screen", STALE)
    setting.setup.world = held_world(setting.workspace, setting.link)
    robot, *_ = setting.setup.checks()
    assert (robot.name, robot.state) == ("robot", "ready")


async def test_a_stop_during_preparation_cancels_the_game(run: Run, setting: Setting) -> None:
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


async def test_the_sound_is_ready_after_its_test(run: Run, setting: Setting) -> None:
    setting.setup.world = held_world(setting.workspace, setting.link)
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        await pilot.press("end", "enter")
        await until_shown(pilot, lambda: setting.setup.said)
        assert setting.link.said and setting.setup.not_ready[-1].name == "sound"
        await pilot.press("enter")
        await until_shown(pilot, lambda: setting.setup.heard)
        assert not setting.setup.not_ready


async def test_people_can_be_moved_between_the_tables_of_a_hall(
    run: Run, data_folder: Path
) -> None:
    workspace = Workspace(data_folder, users=12)
    setting = Setting(workspace)
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        setup = setting.setup
        assert [len(table) for table in setup.tables] == [4, 4, 4]
        await pilot.press("space", "right", "right", "down", "space")  # the first one to the third
        before = [f"user{number}" for number in range(1, 13)]
        before[0], before[9] = before[9], before[0]
        assert setup.seats == before  # whom the arrows passed kept their seats
        assert list(workspace.names) == setup.seats
        await pilot.press("enter")
        assert setup.away == {"user1"}
    workspace.close()


async def test_the_readiness_stays_visible_with_many_people(run: Run, data_folder: Path) -> None:
    workspace = Workspace(data_folder, users=24)
    setting = Setting(workspace)
    setting.link.ail("voice", STALE)
    setting.setup.world = held_world(workspace, setting.link)
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        await pilot.press("home")
        await pilot.pause()
        assert "robot" in pilot.lines()[-2]
    workspace.close()


@pytest.mark.slow
async def test_a_guest_can_be_added_on_the_page(run: Run, setting: Setting) -> None:
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        await pilot.press("J", *"Anna", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ChooseDialog))
        await pilot.press("down", "enter")
        await until_shown(pilot, lambda: len(setting.setup.seats) == 5)
        assert setting.setup.seats[-1] == "guest1"
        assert setting.workspace.name("guest1") == "Anna"
        await opened(pilot)
        await pilot.press("home", "T", *"Rosa", "enter")
        await until_shown(pilot, lambda: setting.workspace.name("user1") == "Rosa")


@pytest.mark.slow
async def test_a_wide_page_draws_everybody_at_their_seats(run: Run, setting: Setting) -> None:
    async with run(app=setting.program(), size=LARGE) as pilot:
        await opened(pilot)
        await pilot.press("J", *"Anna", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ChooseDialog))
        await pilot.press("down", "enter")
        await until_shown(pilot, lambda: len(setting.setup.seats) == 5)
        await opened(pilot)
        await pilot.press("home", "enter")
        await pilot.pause()
        (room,) = pilot.app.screen.query(RoomView)
        drawn = [line[room.region.x :] for line in pilot.lines()]
        (names,) = [line for line in drawn if "User 1" in line]  # an absent person's seat is free
        assert names.index("User 1") < names.index("User 2")
        assert any("away" in line for line in drawn) and any("Anna" in line for line in drawn)


async def test_messages_cover_no_line_of_the_page(run: Run, setting: Setting) -> None:
    setting.setup.world = held_world(setting.workspace, setting.link)
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        shown = pilot.lines()[2:]
        await pilot.press("J")
        await pilot.pause()
        assert text.SEATED in pilot.lines()[1]
        assert pilot.lines()[2:] == shown and not pilot.app.screen.query("Toast")
        await pilot.press("enter")
        await pilot.pause()
        assert text.SEATED not in pilot.text()


@pytest.mark.slow
async def test_showing_a_card_to_the_robot_marks_a_person_as_present(
    run: Run, setting: Setting
) -> None:
    setting.setup.world = held_world(setting.workspace, setting.link)
    setting.setup.toggle("user2")
    setting.setup.look_at_card = lambda: "17"  # type: ignore[method-assign]
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        await pilot.press("end", "up", "up", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ChooseDialog))
        await pilot.press("down", "enter")
        await until_shown(pilot, lambda: not setting.setup.away)
        assert setting.setup.holder(17) == "user2"
        setting.setup.toggle("user2")
        await opened(pilot)
        await pilot.press("enter")
        await until_shown(pilot, lambda: not setting.setup.away)


async def test_a_recognised_face_marks_a_person_as_present(run: Run, setting: Setting) -> None:
    world = setting.setup.world = held_world(setting.workspace, setting.link)
    world.knows_faces = True
    setting.setup.toggle("user3")
    setting.setup.world.commands.do = lambda *_, **__: {"person": "user3"}  # type: ignore
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        await pilot.press("end", "up", "enter")
        await until_shown(pilot, lambda: not setting.setup.away)
        assert setting.setup.face == "user3"


async def test_keys_are_answered_while_tangy_looks(run: Run, setting: Setting) -> None:
    world = setting.setup.world = held_world(setting.workspace, setting.link)
    world.knows_faces = True
    looks = Event()

    def look() -> str:
        looks.wait(10)
        return ""

    setting.setup.look_at_face = look  # type: ignore[method-assign]
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        await pilot.press("end", "up", "enter")
        await until_shown(pilot, lambda: text.LOOKS in pilot.lines()[1])
        await pilot.press("down", "enter")
        await until_shown(pilot, lambda: text.STILL_BUSY in pilot.lines()[1])
        looks.set()
        await until_shown(pilot, lambda: text.NO_FACE in pilot.lines()[1])


async def test_an_activity_without_calls_has_no_settings_for_calls(
    run: Run, data_folder: Path
) -> None:
    workspace = Workspace(data_folder, activity="trivia")
    setting = Setting(workspace)
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        ids = {line.id for line in pilot.app.screen.query_one(SetUpList).choices}
        assert "activity" in ids and ids.isdisjoint({"pace", "patterns", "several", "visits"})
        shown = pilot.text()
        assert "played for" not in shown  # the game has no key for patterns
        assert "Cards" not in shown and "Faces" in shown  # and no card to hold up
        assert "[▦]" not in shown
    workspace.close()


class Panel(TangyScreen[None]):
    """A screen with the staff panel alone."""

    def compose(self) -> ComposeResult:
        yield StaffPanel()


async def test_a_long_question_is_shown_in_full(run: Run) -> None:
    asked = "Reds, question 1: How many minutes are there in an hour? thirty, sixty or ninety?"
    async with run(Panel()) as pilot:
        panel = pilot.app.screen.query_one(StaffPanel)
        panel.show("", said_words(asked), ["1:01 so far"], [("Reds", "no visit yet", "text")])
        await pilot.pause()
        read = " ".join(pilot.text().split())
        assert "sixty or" in read and "ninety?" in read and "1:01 so far" in read


def test_an_untaught_activity_cannot_be_chosen(
    taught: Path,
) -> None:
    workspace = Workspace(taught)
    setup = SetUp.of(workspace)
    with pytest.raises(TangyError):
        setup.play("trivia")  # nobody has taught it
    assert workspace.profile == "bingo"
    workspace.close()


def test_a_qr_code_is_square_with_a_light_margin() -> None:
    lines = qr_lines("http://192.168.1.20:8000/")
    assert len({len(line) for line in lines}) == 1 and lines[0] == "█" * len(lines[0])
    assert abs(len(lines[0]) - 2 * len(lines)) <= 1


async def test_a_small_b_tells_how_to_begin(run: Run, setting: Setting) -> None:
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        await pilot.press("b")
        title = str(pilot.app.screen.query_one(SetUpList).border_title)
        assert "Shift" in title and setting.begins == []
        assert setting.setup.world is None


async def test_the_status_warns_of_a_robot_that_is_not_well_and_of_nothing_else(
    run: Run, setting: Setting
) -> None:
    async with run(app=setting.program()) as pilot:
        await opened(pilot)
        page = pilot.app.screen
        assert isinstance(page, SetUpScreen)
        setting.setup.world = await setting.switch_on()
        setting.setup.said = True  # and nobody has heard it: the sound is not ready
        line = page.query_one(StatusLine)
        await until_shown(pilot, lambda: line.status.robot == "OK")
        assert setting.setup.not_ready and not line.status.alarm
        setting.link.ail("laser", "ERROR")
        await until_shown(pilot, lambda: line.status.robot == NOT_READY)
        assert line.status.alarm
