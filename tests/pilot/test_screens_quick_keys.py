"""Keys that arrive at once, before a screen has opened or closed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tangy_tui.app.workspace import Workspace
from tangy_tui.ui.app import TangyApp
from tangy_tui.ui.palette import Palette
from tangy_tui.ui.screens.phrases import PhrasesScreen
from tests.pilot.conftest import StillClock

if TYPE_CHECKING:
    from tests.pilot.conftest import Run


async def _silent(phones: str) -> None:
    """Speak nothing."""


@pytest.fixture
def screen(workspace: Workspace) -> PhrasesScreen:
    """A screen that a key can close."""
    return PhrasesScreen(workspace, _silent)


@pytest.mark.slow
@pytest.mark.parametrize("keys", [("enter", "enter"), ("enter", "escape")])
async def test_a_second_key_does_not_close_the_screen_below_the_palette(
    run: Run, screen: PhrasesScreen, keys: tuple[str, str]
) -> None:
    async with run(screen, clock=StillClock()) as pilot:
        await pilot.press("ctrl+p", *"mouse")
        await pilot.app.workers.wait_for_complete()
        await pilot.pause()
        assert isinstance(pilot.app.screen, Palette)
        pilot.type(*keys)
        await pilot.pause()
        await pilot.pause()
        assert screen.is_active


@pytest.mark.slow
async def test_a_command_of_the_palette_runs_once(run: Run, screen: PhrasesScreen) -> None:
    app = TangyApp()
    before = app.mouse
    async with run(screen, clock=StillClock(), app=app) as pilot:
        await pilot.press("ctrl+p", *"mouse")
        await pilot.app.workers.wait_for_complete()
        await pilot.pause()
        pilot.type("enter", "enter")
        for _ in range(5):
            await pilot.pause()
        assert app.mouse is not before


@pytest.mark.slow
async def test_the_key_that_filters_may_come_before_the_screen_is_drawn(
    run: Run, workspace: Workspace
) -> None:
    async with run(PhrasesScreen(workspace, _silent)) as pilot:
        top = PhrasesScreen(workspace, _silent)
        pilot.app.push_screen(top)
        pilot.type("slash")
        await pilot.pause()
        await pilot.pause()
        assert top.focused is not None
        assert top.focused.id == "search"
