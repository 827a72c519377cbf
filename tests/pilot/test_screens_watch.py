"""A second console shows a game of another program, and stops the robot."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from tangy_profiles.staff_records import StaffAction
from tangy_profiles.store import Store
from tangy_tui.app.game_commands import (
    ChoosePatterns,
    EndGame,
    GameCommand,
    Pause,
    Phase,
    SetAutonomy,
    SetPace,
    TakeOver,
)
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.game_view import view_of
from tangy_tui.app.joining import let_join
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.app.watching import Guest
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.text.control import autonomy_words
from tangy_tui.text.planned_time import clock_words, time_words
from tangy_tui.text.situations import OVER_NOW
from tangy_tui.text.staff_view import lasting_words, person_words
from tangy_tui.text.watching import CLOSED, GONE, NO_GAME, PHASES, robot_words
from tangy_tui.text.worlds import WORLDS
from tangy_tui.ui.screens.watch import WatchScreen
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.status_line import StatusLine
from tests.pilot.conftest import LARGE, SMALL, Run
from tests.support.games import watched_game
from tests.support.waiting import until, until_shown

STAGES = {**PHASES, "idle": OVER_NOW}


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


@pytest.fixture
def control(workspace: Workspace, learnt: Policy) -> GameController:
    """A game after five steps that other consoles may watch."""
    return watched_game(workspace, learnt)


@pytest.fixture
def screen(control: GameController, data_folder: Path) -> Iterator[WatchScreen]:
    """The second console."""
    with Store.open(data_folder, write=False) as store:
        yield WatchScreen(Guest(data_folder), store, who="Bea")


@pytest.mark.parametrize("size", [SMALL, LARGE])
async def test_the_screen_shows_the_room_the_calls_and_the_operator(
    control: GameController, screen: WatchScreen, run: Run, size: tuple[int, int]
) -> None:
    async with run(screen, size=size) as pilot:
        await until(lambda: screen.query(RoomView))
        await pilot.pause()
        scene = control.supervision.world.scene()
        assert screen.query_one(RoomView).scene == scene
        assert "scripted" in screen.query_one(StatusLine).status.note
        label = control.supervision.world.activity.deck.label(scene.called[-1])
        assert label in pilot.text()


@pytest.mark.parametrize("size", [SMALL, LARGE])
async def test_the_screen_shows_the_times_and_waits_of_the_staff_panel(
    control: GameController, screen: WatchScreen, run: Run, size: tuple[int, int]
) -> None:
    world = control.supervision.world
    while not world.scene().requests:
        go_on_by_script(control, expert=False)
    async with run(screen, size=size) as pilot:
        await until(lambda: screen.query(RoomView))
        seen = control.view()
        first = world.scene().requests[0]
        (asks,) = (one for one in seen.people if one.id == first)
        words = person_words(asks)
        assert clock_words(seen.seconds) != "0:00"
        await until_shown(pilot, lambda: time_words(seen.seconds, None) in pilot.text())
        told = f"User {first.removeprefix('user')} {lasting_words(asks.waits or 0.0)}"
        assert (told if size == SMALL else words) in pilot.text()


async def test_the_screen_follows_the_game(
    control: GameController, screen: WatchScreen, run: Run
) -> None:
    async with run(screen):
        await until(lambda: screen.steps == 5)
        told = len(screen.query_one(LogView).sentences)
        go_on_by_script(control, expert=False)
        await until(lambda: screen.steps == 6)
        await until(lambda: len(screen.query_one(LogView).sentences) > told)


async def test_stop_stops_the_robot_and_names_who_did_it(
    control: GameController, screen: WatchScreen, run: Run, workspace: Workspace
) -> None:
    async with run(screen) as pilot:
        await until(lambda: screen.steps == 5)
        await pilot.press("ctrl+x")
        await until(lambda: control.phase == "stopped")
        await until(lambda: screen.query_one(StatusLine).status.alarm)
    assert [event.record.by for event in workspace.store.events(StaffAction)] == ["Bea"]


@pytest.mark.parametrize(
    ("command", "phase"), [(Pause(), "paused"), (TakeOver(), "staff"), (EndGame(), "idle")]
)
async def test_the_status_line_tells_why_tangy_does_nothing(
    control: GameController, screen: WatchScreen, run: Run, command: GameCommand, phase: Phase
) -> None:
    async with run(screen, size=SMALL) as pilot:
        status = screen.query_one(StatusLine)
        await until(lambda: screen.steps == 5)
        assert status.status.stage == ""
        control.apply(command)
        await until(lambda: status.status.stage)
        assert control.phase == phase
        assert (status.status.stage, status.status.robot) == (STAGES[phase], "OK")
        assert STAGES[phase] in pilot.text()
        assert WORLDS[control.supervision.world.played_in] in pilot.text()  # it is not cut


@pytest.mark.parametrize("size", [SMALL, LARGE])
async def test_the_screen_shows_what_staff_have_chosen(
    control: GameController, screen: WatchScreen, run: Run, size: tuple[int, int]
) -> None:
    control.apply(SetAutonomy("each"))
    control.apply(SetPace(25))
    control.apply(ChoosePatterns(("two lines",)))
    async with run(screen, size=size) as pilot:
        await until(lambda: screen.query(RoomView))
        await pilot.pause()
        told = " ".join(pilot.text().split())
        assert autonomy_words("each") in told and "25 s" in told
        assert control.supervision.world.activity.rules.pattern("two lines").label in told


def test_a_stop_does_not_hide_a_fault_that_halts_the_robot(control: GameController) -> None:
    view = view_of(control)
    assert view is not None
    halted = replace(view, phase="stopped", robot="HALTED", cause="battery")
    assert robot_words(halted) == "STOPPED, HALTED: battery"
    assert robot_words(replace(halted, robot="WARN")) == "STOPPED"
    assert "battery" in robot_words(replace(halted, phase="halted"))
    assert "HALTED" not in robot_words(replace(halted, phase="idle"))


async def test_leaving_stops_nothing(
    control: GameController, screen: WatchScreen, run: Run
) -> None:
    async with run(screen) as pilot:
        await until(lambda: screen.steps == 5)
        await pilot.press("ctrl+c")
        await until(lambda: not pilot.app.is_running)
    assert control.phase == "running"


async def test_no_other_key_changes_the_game(
    control: GameController, screen: WatchScreen, run: Run
) -> None:
    async with run(screen) as pilot:
        await until(lambda: screen.steps == 5)
        await pilot.press(*"pEgcodhiaer.<>", "f2", "enter")
        await pilot.pause()
    assert (control.phase, control.supervision.steps) == ("running", 5)


async def test_the_room_is_drawn_again_for_a_person_who_joins(
    workspace: Workspace, learnt: Policy, control: GameController, screen: WatchScreen, run: Run
) -> None:
    async with run(screen, size=LARGE) as pilot:
        await until(lambda: screen.query(RoomView))
        new = let_join(workspace, "Berta")
        more = scripted_controller(workspace.supervision(learnt, 6))
        more.begin()
        workspace.door.attach(more)
        await until_shown(pilot, lambda: "Berta" in pilot.text())
        assert new in screen.query_one(RoomView).scene.doing


async def test_an_onlooker_reads_that_no_game_has_begun(
    workspace: Workspace, data_folder: Path, run: Run
) -> None:
    workspace.door.open()
    with Store.open(data_folder, write=False) as store:
        async with run(WatchScreen(Guest(data_folder), store, who="Bea"), size=LARGE) as pilot:
            await until_shown(pilot, lambda: NO_GAME in " ".join(pilot.text().split()))


async def test_the_keys_of_the_game_say_that_they_do_nothing_here(
    data_folder: Path, workspace: Workspace, run: Run
) -> None:
    workspace.door.open()
    with Store.open(data_folder, write=False) as store:
        screen = WatchScreen(Guest(data_folder), store, who="Bea")
        async with run(screen, size=LARGE, notifications=True) as pilot:
            await until_shown(pilot, lambda: NO_GAME in " ".join(pilot.text().split()))
            assert not screen.query("Toast")
            await pilot.press("p")
            await until_shown(pilot, lambda: bool(screen.query("Toast")))


async def test_a_program_that_is_closed_without_a_game_had_none(
    data_folder: Path, workspace: Workspace, run: Run
) -> None:
    workspace.door.open()
    with Store.open(data_folder, write=False) as store:
        screen = WatchScreen(Guest(data_folder), store, who="Bea")
        async with run(screen, size=LARGE) as pilot:
            await until_shown(pilot, lambda: NO_GAME in " ".join(pilot.text().split()))
            workspace.door.close()
            await until_shown(pilot, lambda: CLOSED in pilot.text())
            assert GONE not in pilot.text()
