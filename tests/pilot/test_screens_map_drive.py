"""The screen on which staff drive to draw a map."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from threading import Event, current_thread, main_thread
from typing import TYPE_CHECKING

import pytest

from tangy_hw.device_protocols import Pose
from tangy_hw.navigation.scan_recorder import robot_laser_line
from tangy_profiles.room import load_room
from tangy_tui.ui.screens import map_drive
from tangy_tui.ui.screens.map_drive import MapDriveScreen
from tests.hw.raycast import look, room_sides
from tests.pilot.conftest import StillClock, screen_text
from tests.pilot.live_games import HeldLink
from tests.support.waiting import until_shown

if TYPE_CHECKING:
    from tests.pilot.conftest import Run

SIDES = room_sides(load_room())

pytestmark = pytest.mark.slow


def record(path: Path, scans: int) -> None:
    """Write a drive across a room."""
    poses = [Pose(2.0 + 0.1 * number, 2.0, 0.0) for number in range(scans)]
    path.write_text("".join(robot_laser_line(look(SIDES, pose), pose, pose.x) for pose in poses))


async def test_the_map_grows_during_the_drive(run: Run, tmp_path: Path) -> None:
    link, log = HeldLink(), tmp_path / "a-scans.log"
    screen = MapDriveScreen(link, log, "Tangy")  # type: ignore[arg-type]
    async with run(screen) as pilot:
        await pilot.press("up", "left", "shift+up", "space")
        assert link.told.count("drive") == 4
        link.state = replace(link.state, pose=Pose(3.0, 2.0, 0.0))
        record(log, 11)
        await until_shown(
            pilot, lambda: "11 scans recorded, 1.0 m driven" in screen_text(pilot.app)
        )
        shown = screen_text(pilot.app)
        assert "●" in shown and "█" in shown
        assert link.stamps, "a screen that hangs has to stop the robot"


async def test_one_map_is_drawn_at_a_time(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun, go_on = list[Path](), Event()

    def slow(log: Path) -> None:
        begun.append(log)
        go_on.wait(20)

    monkeypatch.setattr(map_drive, "map_so_far", slow)
    monkeypatch.setattr(map_drive, "DRAWN_SECONDS", 0.01)
    link = HeldLink()
    async with run(MapDriveScreen(link, tmp_path / "a.log", "Tangy")) as pilot:  # type: ignore[arg-type]
        await until_shown(pilot, lambda: len(begun) == 1 and link.stamps > 3)
        assert len(begun) == 1
        go_on.set()
        await until_shown(pilot, lambda: len(begun) > 2)


async def test_the_next_map_waits_three_times_as_long_as_the_last_took(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    looking, drawing, begun = StillClock(), StillClock(), list[float]()

    def clock() -> float:
        return looking.now if current_thread() is main_thread() else drawing.now

    def slow(log: Path) -> None:
        begun.append(drawing.now)
        drawing.now += 2.0

    monkeypatch.setattr(map_drive, "map_so_far", slow)
    monkeypatch.setattr(map_drive, "monotonic", clock)
    monkeypatch.setattr(map_drive, "DRAWN_SECONDS", 0.01)
    link = HeldLink()
    async with run(MapDriveScreen(link, tmp_path / "a.log", "Tangy")) as pilot:  # type: ignore[arg-type]
        await until_shown(pilot, lambda: drawing.now == 2.0)
        looking.now = 7.9
        seen = link.stamps
        await until_shown(pilot, lambda: link.stamps > seen + 3)  # the screen has polled again
        assert begun == [0.0]
        looking.now = 8.1
        await until_shown(pilot, lambda: len(begun) == 2)


async def test_near_obstacles_are_reported_and_a_stop_holds_until_release(
    run: Run, tmp_path: Path
) -> None:
    link = HeldLink()
    screen = MapDriveScreen(link, tmp_path / "a.log", "Tangy")  # type: ignore[arg-type]
    async with run(screen) as pilot:
        link.state = replace(link.state, held="stands")
        await until_shown(pilot, lambda: "Tangy stands. Turn" in screen_text(pilot.app))
        await pilot.press("ctrl+x")
        await until_shown(pilot, lambda: bool(link.held_by))
        assert "Press g to go on" in screen_text(pilot.app)
        await pilot.press("g")
        await until_shown(pilot, lambda: not link.held_by)


async def test_enter_asks_before_the_drive_ends(run: Run, tmp_path: Path) -> None:
    link, log = HeldLink(), tmp_path / "a.log"
    record(log, 3)
    screen = MapDriveScreen(link, log, "Tangy")  # type: ignore[arg-type]
    async with run(screen) as pilot:
        await until_shown(pilot, lambda: "3 scans" in screen_text(pilot.app))
        await pilot.press("enter")
        await until_shown(pilot, lambda: "Is the drive over?" in screen_text(pilot.app))
        await pilot.press("n")
        await until_shown(pilot, lambda: pilot.app.screen is screen)
        assert not screen.done
        await pilot.press("enter")
        await until_shown(pilot, lambda: "Is the drive over?" in screen_text(pilot.app))
        await pilot.press("y")
        await until_shown(pilot, lambda: screen.done)


async def test_leaving_without_scans_draws_no_map(run: Run, tmp_path: Path) -> None:
    screen = MapDriveScreen(HeldLink(), tmp_path / "a.log", "Tangy")  # type: ignore[arg-type]
    async with run(screen) as pilot:
        await pilot.press("escape")
        await until_shown(pilot, lambda: "Leave without a map?" in screen_text(pilot.app))
        await pilot.press("y")
        await until_shown(pilot, lambda: not pilot.app.is_running)
        assert not screen.done
