"""The teaching screen under dialogs: a story waits, the keys stay where they were."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from textual.pilot import Pilot

from tangy_tui.house import House
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.help import Help, HelpScreen
from tangy_tui.ui.screens.teach import TeachScreen
from tangy_tui.ui.widgets.command_bar import CommandBar
from tests.pilot.conftest import Run, StillClock

FAST = 60.0
HELPLESS = Help("nothing", (), (), ())


@pytest.fixture
def house(tmp_path: Path) -> Iterator[House]:
    """A house with a data folder of its own."""
    opened = House(tmp_path / "data")
    yield opened
    opened.close()


def program(house: House, ended: list[bool], *, scripted: float | None = None) -> Program:
    """Make the program with the teaching screen open; what it ends with is noted."""

    async def start(started: Program) -> None:
        screen = TeachScreen(house, house.teaching("ann", 1), scripted=scripted)
        ended.append(await started.push_screen_wait(screen))

    return Program(house, start, clock=StillClock())


def teach_screen(pilot: Pilot[None]) -> TeachScreen:
    """Return the teaching screen, which is on top."""
    assert isinstance(pilot.app.screen, TeachScreen)
    return pilot.app.screen


async def until_over(pilot: Pilot[None], screen: TeachScreen) -> None:
    """Wait until the demonstration is finished, and a little longer."""
    for _ in range(500):
        await pilot.pause(0.05)
        if screen._teaching.demonstration.finished:
            await pilot.pause(0.2)
            return


@pytest.mark.parametrize("late", [True, False], ids=["at the end", "from the start"])
async def test_a_story_waits_for_the_help_to_be_closed(run: Run, house: House, late: bool) -> None:
    ended: list[bool] = []
    async with run(app=program(house, ended, scripted=FAST)) as pilot:
        screen = teach_screen(pilot)
        teaching = screen._teaching
        if late:  # the help is opened after the last step, before the screen goes
            apply = teaching.apply

            def last(command):  # type: ignore[no-untyped-def]
                events = apply(command)
                if teaching.demonstration.finished:
                    screen.app.push_screen(HelpScreen(HELPLESS))
                return events

            teaching.apply = last  # type: ignore[method-assign]
            await until_over(pilot, screen)
        else:
            await pilot.press("question_mark")
            await pilot.pause(0.2)
            assert not teaching.demonstration.finished
        assert isinstance(pilot.app.screen, HelpScreen)
        assert screen in pilot.app.screen_stack
        assert ended == []
        await pilot.press("escape")
        await until_over(pilot, screen)
        assert ended == [True]
        assert screen not in pilot.app.screen_stack
        screen.action_leave()  # a key that was on its way
        await pilot.pause()
        assert ended == [True]


async def test_the_keys_are_where_they_were_when_the_help_is_closed(run: Run, house: House) -> None:
    async with run(app=program(house, [])) as pilot:
        bar = pilot.app.screen.query_one(CommandBar)
        await pilot.press("escape", "question_mark")
        await pilot.pause()
        assert isinstance(pilot.app.screen, HelpScreen)
        await pilot.press("escape")
        await pilot.pause()
        await pilot.press("u")
        assert bar.text == ""
        await pilot.press("colon", "question_mark")
        await pilot.pause()
        await pilot.press("escape")
        await pilot.pause()
        await pilot.press("u")
        assert bar.text == "u"
