"""Faults in the full-screen program: they are looked for all the time, and how they look."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from textual.app import App

from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import TangyError
from tangy_sim.faulty import FaultyWorld
from tangy_tui.house import House
from tangy_tui.learning.policy import ForestSettings, Policy
from tangy_tui.monitoring.fault import BORNE, Diagnosed, Fault
from tangy_tui.monitoring.supervision import Event, Supervision
from tangy_tui.ui.dialogs.critical import CriticalDialog
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.asking import AskingPanel
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.transcript import Transcript
from tests.interaction.gaps import learnt
from tests.pilot.conftest import SMALL, Run, StillClock, TangyPilot

Cover = Callable[[str, int, int], tuple[Demonstration, ...]]
FEW = ForestSettings(trees=5)
TINY = (60, 18)
MIDDLE = (120, 40)


@pytest.fixture
def house(tmp_path: Path) -> Iterator[House]:
    """A house with a data folder of its own."""
    opened = House(tmp_path / "data")
    yield opened
    opened.close()


@pytest.fixture
def policy(house: House, cover: Cover) -> Policy:
    """A policy that knows all that comes about."""
    return learnt(house.store, house.activity, cover("bingo", 1, 4), FEW)


def playing(
    house: House,
    policy: Policy,
    *injections: str,
    speed: float = 1,
    leave_after: float | None = None,
) -> Program:
    """Make the program with the playing screen open; at speed 1 only keys move the game."""

    async def start(program: Program) -> None:
        supervision = house.supervision(policy, 5, asks=True, injections=injections)
        screen = PlayScreen(house, supervision, speed=speed, leave_after=leave_after, teacher="ann")
        await program.push_screen(screen)

    return Program(house, start, clock=StillClock())


def game_of(pilot: TangyPilot) -> tuple[PlayScreen, Supervision, FaultyWorld]:
    """Return the playing screen, what supervises its games, and their world."""
    screen = next(s for s in pilot.app.screen_stack if isinstance(s, PlayScreen))
    world = screen._supervision.world
    assert isinstance(world, FaultyWorld)
    return screen, screen._supervision, world


async def until(pilot: TangyPilot, so: Callable[[], object]) -> None:
    """Wait until something is so."""
    while not so():
        await pilot.pause(0.02)
    await pilot.pause()


async def halted(pilot: TangyPilot) -> CriticalDialog:
    """Wait until the dialog of a critical fault takes keys."""
    await until(pilot, lambda: isinstance(pilot.app.screen, CriticalDialog))
    dialog = pilot.app.screen
    assert isinstance(dialog, CriticalDialog)
    await until(pilot, lambda: dialog._keys._from is not None)
    return dialog


async def halting(pilot: TangyPilot, kind: str = "emergency-stop") -> CriticalDialog:
    """Pause the game, bring about a critical fault, and wait for its dialog."""
    await pilot.press("p")
    game_of(pilot)[2].inject(kind)
    return await halted(pilot)


async def asked(pilot: TangyPilot) -> AskingPanel:
    """Wait until Tangy asks and a command can be typed."""
    screen = game_of(pilot)[0]
    await until(pilot, lambda: screen.query(AskingPanel))
    await until(pilot, lambda: not screen.query_one(CommandBar).closed)
    return screen.query_one(AskingPanel)


def kinds_of(fault: Fault) -> list[str]:
    """Return what was done about a fault, in order."""
    return [move.kind for move in fault.moves]


def seen(pilot: TangyPilot) -> str:
    """Return what can be read, on one line."""
    return " ".join(pilot.text().split())


def sentences(screen: PlayScreen) -> list[str]:
    """Return what stands in the log."""
    return list(screen.query_one(LogView).sentences)


# ------------------------------------------------------------ looking


@pytest.mark.parametrize("at", ["playing", "paused"])
async def test_a_fault_is_told_at_the_next_look(
    run: Run, house: House, policy: Policy, at: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with run(app=playing(house, policy)) as pilot:
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
        await until(pilot, lambda: looks)
        assert any(isinstance(event, Diagnosed) for event in looks[0])
        assert game.halted is not None
        await halted(pilot)
        assert "Laser scanner silent" in pilot.text()


async def test_nothing_is_written_while_nothing_changes(
    run: Run, house: House, policy: Policy, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with run(app=playing(house, policy)) as pilot:
        screen = game_of(pilot)[0]
        await pilot.press("p")
        told: list[Any] = []
        monkeypatch.setattr(screen._faults, "_tell", lambda *told_now: told.append(told_now))
        ticks = screen._faults.ticks
        await until(pilot, lambda: screen._faults.ticks > ticks + 2)
        assert not told


async def test_a_log_that_cannot_be_written_while_looking_stands_still_and_is_tried_again(
    run: Run, house: House, policy: Policy, monkeypatch: pytest.MonkeyPatch
) -> None:
    append = house.store.append

    def refuse(kind: str, *rest: object, **more: object) -> int:
        if kind == "fault":
            raise TangyError("The log cannot be written: the disk is full.")
        return append(kind, *rest, **more)  # type: ignore[arg-type]

    async with run(app=playing(house, policy)) as pilot:
        screen, _, world = game_of(pilot)
        with monkeypatch.context() as broken:
            broken.setattr(house.store, "append", refuse)
            world.inject("emergency-stop")
            await until(pilot, lambda: isinstance(pilot.app.screen, MessageDialog))
            count = screen.query_one(Transcript).count
            assert "the disk is full" in pilot.text()
        await pilot.press("enter")
        await pilot.pause()
        await pilot.press("p")
        await halted(pilot)
        assert screen.query_one(Transcript).count == count


# ------------------------------------------------------------ pictures


@pytest.mark.parametrize("size", [TINY, SMALL], ids=["tiny", "small"])
async def test_how_standing_still_looks(
    run: Run,
    house: House,
    policy: Policy,
    size: tuple[int, int],
    picture: Callable[[App[None]], None],
) -> None:
    async with run(app=playing(house, policy), size=size) as pilot:
        await halting(pilot, "laser-disconnected")
        await pilot.press("a")
        await pilot.pause()
        picture(pilot.app)


@pytest.mark.parametrize("size", [SMALL, MIDDLE], ids=["small", "middle"])
async def test_how_banner_and_list_look(
    run: Run,
    house: House,
    policy: Policy,
    size: tuple[int, int],
    picture: Callable[[App[None]], None],
) -> None:
    async with run(app=playing(house, policy), size=size) as pilot:
        game, world = game_of(pilot)[1:]
        await pilot.press("p")
        for kind in ("requests-silent", "arm-failed"):
            world.inject(kind)
            await until(pilot, lambda: len(game.faults) == len(world.present))
        while [fault.status for fault in game.faults] != [BORNE, BORNE]:
            await pilot.press("n")
            await pilot.pause()
        await pilot.press("6")
        await pilot.pause()
        picture(pilot.app)
