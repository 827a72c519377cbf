"""The reports of sessions, reached from home and from the list of all commands."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from datetime import timedelta
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tangy_tui.app.game_commands import EndGame
from tangy_tui.app.scripted_staff import scripted_controller
from tangy_tui.app.session_reports import sessions_of
from tangy_tui.app.workspace import Workspace
from tangy_tui.monitoring.games import read_games
from tangy_tui.text.games import NONE_YET, REPORT_AT_HOME
from tangy_tui.text.session_page import SUMS
from tangy_tui.text.session_reports import REPORTS, games_title
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.home import CHOICES, HomeScreen
from tangy_tui.ui.screens.report import ReportScreen
from tests.app.test_interruption import Interrupted
from tests.pilot.conftest import StillClock, screen_text
from tests.support.waiting import until_shown

if TYPE_CHECKING:
    from tests.pilot.conftest import Run, TangyPilot


def is_shown(pilot: TangyPilot, words: str) -> bool:
    return words in pilot.text()


@pytest.fixture
def played(taught: Path) -> Iterator[Workspace]:
    """A data folder with three games that were played to their end."""
    there = Interrupted(taught)
    for _ in range(3):
        control = scripted_controller(there.new())
        control.begin()
        control.next()
        control.apply(EndGame())
    yield there.workspace
    there.workspace.close()


@pytest.mark.slow
def test_games_more_than_half_an_hour_apart_are_of_different_sessions(played: Workspace) -> None:
    games = read_games(played.store)
    hour = timedelta(hours=1)
    assert [[game.number for game in one] for one in sessions_of(games)] == [[1, 2, 3]]
    earlier = [replace(one, at=one.at - hour, ended=one.at - hour) for one in games[:2]]
    sessions = sessions_of([*earlier, games[2]])
    assert [[game.number for game in one] for one in sessions] == [[3], [1, 2]]


@pytest.mark.slow
async def test_home_opens_the_report_of_the_last_session(run: Run, played: Workspace) -> None:
    async with run(app=Program(played, clock=StillClock())) as pilot:
        await pilot.press("b", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ReportScreen))
        await until_shown(pilot, lambda: games_title(read_games(played.store)) in pilot.text())
        await pilot.press("escape")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, HomeScreen))


@pytest.mark.slow
async def test_left_and_right_go_to_earlier_and_later_reports(run: Run, played: Workspace) -> None:
    games = read_games(played.store)
    screen = ReportScreen(played, [games[1:], games[:1]])
    async with run(screen) as pilot:
        for key, shown in (("left", games[:1]), ("left", games[:1]), ("right", games[1:])):
            await pilot.press(key)
            title = games_title(shown)
            await until_shown(pilot, partial(is_shown, pilot, title))
            assert screen.games == shown


async def test_without_a_game_home_says_that_none_was_played(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.press("b", "enter")
        await until_shown(pilot, lambda: NONE_YET in screen_text(pilot.app))


async def test_the_list_of_all_commands_finds_the_report(run: Run, workspace: Workspace) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.press("ctrl+p", *"report")
        await until_shown(pilot, lambda: REPORTS[0] in screen_text(pilot.app))


def test_the_end_of_a_live_game_names_the_way_to_its_report() -> None:
    (item,) = [choice for choice in CHOICES if choice.id == "reports"]
    assert item.name in REPORT_AT_HOME


@pytest.mark.slow
async def test_a_key_writes_the_shown_report_as_a_page_to_print(
    run: Run, played: Workspace
) -> None:
    games = read_games(played.store)
    async with run(ReportScreen(played, [games])) as pilot:
        await until_shown(pilot, partial(is_shown, pilot, "X page to print"))
        await pilot.press("X")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, MessageDialog))
        (page,) = played.store.folder.glob("report-*.html")
        written = page.read_text(encoding="utf-8")
        assert written.startswith("<!DOCTYPE html>") and SUMS not in written  # that is for --full
        await until_shown(pilot, partial(is_shown, pilot, page.name))
