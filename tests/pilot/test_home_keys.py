"""From home one thing is opened at a time, however fast the keys come."""

from __future__ import annotations

import pytest

from tangy_tui.house import House
from tangy_tui.learning.library import read_library
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.screens.teach import TeachScreen
from tests.pilot.conftest import Run, StillClock


@pytest.mark.parametrize("keys", ["tt", "gg", "ee", "ii", "tgiep", "dd", "de"])
async def test_a_key_that_comes_twice_opens_one_screen(keys: str, run: Run, house: House) -> None:
    async with run(app=Program(house, clock=StillClock())) as pilot:
        pilot.type(*keys)
        for _ in range(4):
            await pilot.pause(0.05)
        assert isinstance(pilot.app.screen_stack[0], HomeScreen)
        assert len(pilot.app.screen_stack) == 2


async def test_two_keys_make_one_demonstration(run: Run, house: House) -> None:
    async with run(app=Program(house, clock=StillClock())) as pilot:
        pilot.type("t", "t")
        await pilot.pause()
        assert isinstance(pilot.app.screen, TeachScreen)
        pilot.type(*"greet everyone", "enter")
        await pilot.pause()
        pilot.type("y")
        await pilot.pause()
        assert len(read_library(house.store, "bingo").entries) <= 1


async def test_stop_at_home_says_that_nothing_moves(
    run: Run, house: House, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with run(app=Program(house, clock=StillClock())) as pilot:
        said: list[str] = []
        monkeypatch.setattr(pilot.app, "say", lambda sentence, **more: said.append(sentence))
        await pilot.press("ctrl+x")
        assert said == ["Nothing is moving."]
        await pilot.press("t")
        await pilot.pause()
        await pilot.press("ctrl+x")
        assert said == ["Nothing is moving."]
