"""The demo: a story on one screen that can be paused, stepped through, and left."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tangy_tui.app.workspace import Workspace
from tangy_tui.console.story import Story
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.demo import DemoScreen
from tangy_tui.ui.screens.home import HomeScreen
from tests.pilot.conftest import LARGE, SMALL, Run, StillClock, TangyPilot, screen_text
from tests.support.waiting import until_shown


def program(workspace: Workspace, pace: float) -> Program:
    async def start(program: Program) -> None:
        await program.push_screen(DemoScreen(workspace, Story(workspace, 1), pace=pace))

    return Program(workspace, start, clock=StillClock())


async def shown(pilot: TangyPilot, holds: Callable[[DemoScreen], bool]) -> DemoScreen:
    screen = pilot.app.screen_stack[-1]
    await until_shown(pilot, lambda: isinstance(pilot.app.screen, DemoScreen))
    screen = pilot.app.screen
    assert isinstance(screen, DemoScreen)
    await until_shown(pilot, lambda: holds(screen))
    return screen


@pytest.mark.slow
@pytest.mark.parametrize("size", [SMALL, LARGE])
async def test_the_demo_shows_six_scenes_on_one_screen(
    run: Run, workspace: Workspace, size: tuple[int, int]
) -> None:
    async with run(app=program(workspace, pace=1000), size=size) as pilot:
        screen = await shown(pilot, lambda s: s.ended and s.at == len(s.frames) - 1)
        assert pilot.app.screen is screen
        assert [f.scene for f in screen.frames] == sorted(f.scene for f in screen.frames)
        assert {f.scene for f in screen.frames} == {1, 2, 3, 4, 5, 6}
        assert "Your turn" in screen_text(pilot.app)


@pytest.mark.slow
async def test_space_pauses_and_resumes_the_demo(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace, pace=1000)) as pilot:
        screen = await shown(pilot, lambda s: s.at >= 0)
        await pilot.press("space")
        held = screen.at
        assert "paused" in screen_text(pilot.app)
        await pilot.pause(0.1)
        assert screen.at == held
        await pilot.press("space")
        await shown(pilot, lambda s: s.at > held)


async def test_arrows_step_through_captions_while_paused(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace, pace=0.001)) as pilot:
        screen = await shown(pilot, lambda s: s.at == 0)
        await pilot.press("space")
        captions = [screen.frames[0].caption]
        for _ in range(4):
            await pilot.press("right")
            captions.append(screen.frames[screen.at].caption)
        assert len(set(captions)) == 5
        assert captions[-1] in " ".join(screen_text(pilot.app).split()).replace(" │ │ ", " ")
        for caption in reversed(captions[:-1]):
            await pilot.press("left")
            assert screen.frames[screen.at].caption == caption
        await pilot.press("left")
        assert screen.at == 0


async def test_letters_change_nothing_in_the_demo(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace, pace=0.001)) as pilot:
        screen = await shown(pilot, lambda s: s.at == 0)
        await pilot.press(*"abcdefghijklnoqrtuwxyz")
        assert pilot.app.screen is screen
        assert screen.at == 0
        assert not screen.held


@pytest.mark.slow
async def test_escape_leaves_the_demo_without_a_trace(run: Run, workspace: Workspace) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.press("d", "enter")
        await shown(pilot, lambda s: s.at >= 0)
        await pilot.press("escape")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, HomeScreen))
        assert not list(workspace.store.events())
