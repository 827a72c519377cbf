"""Screens list their keys correctly: home, its help, and the conflicts at their end."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from tangy_profiles.demonstration import Demonstration
from tangy_tui.app.workspace import Workspace
from tangy_tui.ui.dialogs.messages import MessagesDialog
from tangy_tui.ui.listing import listed
from tangy_tui.ui.message_history import MessageHistoryApp
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.help import help_for
from tangy_tui.ui.screens.home import HomeScreen
from tests.pilot.conftest import SMALL, Run, StillClock
from tests.shown import answering, log_demonstration

SIZES = pytest.mark.parametrize("size", [SMALL, (60, 18)], ids=["small", "smallest"])
WRONG = "incorrectly marked"


@pytest.fixture
def workspace(
    tmp_path: Path, demonstrate: Callable[[str, int, int], Demonstration]
) -> Iterator[Workspace]:
    """A workspace in which Ada and Bea disagree about wrong marks."""
    opened = Workspace(tmp_path / "data")
    games = (demonstrate("bingo", seed, 4) for seed in range(1, 40))
    wanted = (g for g in games if any(s.state.situation.user_state == WRONG for s in g.steps))
    log_demonstration(opened.store, replace(next(wanted), id="aaaa", teacher="Ada"))
    other = replace(next(wanted), id="bbbb", teacher="Bea")
    log_demonstration(opened.store, answering(other, WRONG, "encourage"))
    yield opened
    opened.close()


@SIZES
async def test_home_has_a_line_of_keys_and_shows_every_choice(
    run: Run, size: tuple[int, int]
) -> None:
    async with run(HomeScreen(), size) as pilot:
        keys = pilot.lines()[-1]
        assert "enter choose  letter go to" in keys
        assert "? help" in keys
        assert "leave Tangy" in pilot.text()


async def test_the_help_of_home_lists_only_working_keys(run: Run) -> None:
    async with run(HomeScreen()) as pilot:
        told = dict(help_for(pilot.app.screen).everywhere)
        assert "?" in told
        assert not {":", "+", "esc"} & set(told)
        await pilot.press("plus")
        await pilot.pause()
        assert pilot.app.screen.maximized is None


@pytest.mark.slow
async def test_the_help_of_a_screen_with_a_command_line_lists_both_modes(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.press("t", "enter")
        await pilot.pause()
        await pilot.press("escape")
        await pilot.pause()
        told = dict(help_for(pilot.app.screen).everywhere)
        assert ":" in told
        letters = [
            one for one in listed(pilot.app.screen) if one.key.isalnum() and len(one.key) == 1
        ]
        assert not letters, "the line takes them"
        assert any(one.word == "picture" for one in listed(pilot.app.screen))
        assert "+" not in told  # no panel has the keys
        await pilot.press("up", "ctrl+o")
        await pilot.pause()
        assert "+" in dict(help_for(pilot.app.screen).everywhere)


async def test_the_key_line_after_the_last_conflict_lists_the_remaining_keys(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.press("l", "enter")
        await pilot.pause()
        keys = pilot.lines()[-1]
        assert "1-9 right" in keys
        assert "enter open" in keys
        await pilot.press("1")
        await pilot.pause()
        keys = pilot.lines()[-1]
        assert "1-9" not in keys
        assert "enter let Tangy learn" in keys
        assert "f2 undo" in keys
        await pilot.press("f2")
        await pilot.pause()
        assert "1-9 right" in pilot.lines()[-1]


async def test_messages_can_be_read_again_with_their_times(run: Run) -> None:
    async with run(HomeScreen()) as pilot:
        assert isinstance(pilot.app, MessageHistoryApp)
        pilot.app.say("The first message.")
        pilot.app.say("The second message.")
        pilot.app.clear_notifications()
        await pilot.pause()
        assert "The first message." not in pilot.text()
        await pilot.press("exclamation_mark")
        await pilot.pause()
        assert isinstance(pilot.app.screen, MessagesDialog)
        text = pilot.text()
        assert 0 < text.index(" The second message.") < text.index(" The first message.")
        at, _ = pilot.app.told[0]
        assert f"{at:%H:%M:%S} The first message." in text
