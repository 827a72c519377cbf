"""Faults in the full-screen program: continuous checks, and their appearance."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from textual.app import App

from tangy_profiles.errors import TangyError
from tangy_profiles.events import EventRecord
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.fault import BORNE, Diagnosed
from tangy_tui.monitoring.supervision import Event
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.transcript import Transcript
from tests.pilot.conftest import SMALL, Run
from tests.pilot.faults import (
    MIDDLE,
    TINY,
    game_of,
    halted,
    halting,
    playing,
)
from tests.support.waiting import until_shown

# ------------------------------------------------------------ looking


@pytest.mark.slow
@pytest.mark.parametrize("at", ["playing", "paused"])
async def test_a_fault_is_reported_at_the_next_look(
    run: Run, workspace: Workspace, policy: Policy, at: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        _, game, world = game_of(pilot)
        if at == "paused":
            await pilot.press("p")
        looks: list[list[Event]] = []
        look = game.look

        def counted() -> list[Event]:
            looks.append(look())
            return looks[-1]

        monkeypatch.setattr(game, "look", counted)
        world.inject("laser-disconnected")
        await until_shown(pilot, lambda: looks)
        assert any(isinstance(event, Diagnosed) for event in looks[0])
        assert game.halted is not None
        await halted(pilot)
        assert "Laser scanner silent" in pilot.text()


@pytest.mark.slow
async def test_an_unchanged_state_writes_no_event(
    run: Run, workspace: Workspace, policy: Policy, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        screen = game_of(pilot)[0]
        await pilot.press("p")
        await pilot.pause()
        looked: list[list[Event]] = []
        look = screen.control.look

        def noted() -> list[Event]:
            looked.append(look() or [])
            return looked[-1]

        monkeypatch.setattr(screen.control, "look", noted)
        kept, told = list(workspace.store.events()), list(screen.query_one(LogView).sentences)
        await until_shown(pilot, lambda: len(looked) > 2)
        assert list(workspace.store.events()) == kept
        assert list(screen.query_one(LogView).sentences) == told
        assert not any(looked)


@pytest.mark.slow
async def test_a_failed_write_while_looking_pauses_the_game_until_a_retry(
    run: Run, workspace: Workspace, policy: Policy, monkeypatch: pytest.MonkeyPatch
) -> None:
    append = workspace.store.append

    def refuse(record: EventRecord, **more: Any) -> int:
        if record.KIND == "fault":
            raise TangyError("The log cannot be written: the disk is full.")
        return append(record, **more)

    async with run(app=playing(workspace, policy)) as pilot:
        screen, _, world = game_of(pilot)
        with monkeypatch.context() as broken:
            broken.setattr(workspace.store, "append", refuse)
            world.inject("emergency-stop")
            await until_shown(pilot, lambda: isinstance(pilot.app.screen, MessageDialog))
            count = screen.query_one(Transcript).count
            assert "the disk is full" in pilot.text()
        await pilot.press("enter")
        await pilot.pause()
        await pilot.press("p")
        await halted(pilot)
        assert screen.query_one(Transcript).count == count


# ------------------------------------------------------------ pictures


@pytest.mark.slow
@pytest.mark.parametrize("size", [TINY, SMALL], ids=["tiny", "small"])
async def test_the_halted_screen_matches_its_snapshot(
    run: Run,
    workspace: Workspace,
    policy: Policy,
    size: tuple[int, int],
    looks: Callable[[App[None]], None],
) -> None:
    async with run(app=playing(workspace, policy), size=size) as pilot:
        await halting(pilot, "laser-disconnected")
        await pilot.press("a")
        await pilot.pause()
        looks(pilot.app)


@pytest.mark.slow
@pytest.mark.parametrize("size", [SMALL, MIDDLE], ids=["small", "middle"])
async def test_the_fault_banner_and_list_match_their_snapshots(
    run: Run,
    workspace: Workspace,
    policy: Policy,
    size: tuple[int, int],
    looks: Callable[[App[None]], None],
) -> None:
    async with run(app=playing(workspace, policy), size=size) as pilot:
        game, world = game_of(pilot)[1:]
        await pilot.press("p")
        for kind in ("requests-silent", "arm-failed"):
            world.inject(kind)
            await until_shown(pilot, lambda: len(game.faults) == len(world.present))
        while [fault.status for fault in game.faults] != [BORNE, BORNE]:
            await pilot.press("full_stop")
            await pilot.pause()
        await pilot.press("6")
        await pilot.pause()
        looks(pilot.app)
