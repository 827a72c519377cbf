"""The devices of a live robot on a screen: readings, camera picture and the last card."""

from __future__ import annotations

import asyncio
import base64
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import astuple, replace
from typing import TYPE_CHECKING, Any

import pytest
from textual.app import App

from tangy_hw.drivers.camera_state import Sight
from tangy_profiles.card_face import numbers_of
from tangy_profiles.health import STALE
from tangy_tui.app.sensing import LinkedSensors
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.ui.screens.sensors import SensorsScreen
from tangy_tui.ui.widgets.block_picture import BLOCK
from tests.pilot.conftest import SMALL, screen_text
from tests.pilot.live_games import (
    HeldLink,
    held_world,
    live,
    live_program,
    paused_after,
    settled,
)
from tests.support.waiting import until_shown

if TYPE_CHECKING:
    from tests.pilot.conftest import Run, TangyPilot

AT = "ws://192.168.1.20:9090"
WELL = Sight("OK", "", 8.0, 0.05, 0.0, 0.5, 0.2, 0.6)
READ = {"card": 17, "marked": 0b11, "hidden": 0b11000, "state": "", "problem": "", "pictures": 2}


class SeeingLink(HeldLink):
    """A robot with wheels, a laser scanner and a head camera, and no arms."""

    def __init__(self) -> None:
        super().__init__()
        self.setup = replace(
            self.setup,
            drivers={"base": {"kind": "rosbridge", "at": AT}, "laser": {"kind": "scip"}},
            cameras={"camera": "/dev/video0"},
        )
        self.screen = ""
        self.pid = 1
        self.sight = WELL
        self.looked: dict[str, Any] | None = None
        self.read: dict[str, Any] | None = None
        self.asked_for: list[dict[str, Any]] = []
        self.answers = True

    def ask(self, do: str, **what: Any) -> Future[dict[str, Any]]:
        if do not in ("picture", "sights"):
            return super().ask(do, **what)
        answer: Future[dict[str, Any]] = Future()
        if do == "picture":
            self.asked_for.append(what)
        if self.answers:
            answer.set_result(self._picture(*what["fit"]) if do == "picture" else self._sights())
        return answer

    def _picture(self, width: int, height: int) -> dict[str, Any]:
        pixels = base64.b64encode(bytes((200, 20, 60)) * width * height).decode()
        return {"seq": len(self.asked_for), "size": [width, height], "pixels": pixels}

    def _sights(self) -> dict[str, Any]:
        sights = {"camera": ["/dev/video0", *astuple(self.sight)]}
        return {"sights": sights, "looked": self.looked, "read": self.read}


@pytest.fixture
def link() -> SeeingLink:
    return SeeingLink()


@pytest.fixture
def sensors(workspace: Workspace, link: SeeingLink) -> LinkedSensors:
    given: Any = link
    return LinkedSensors(given, workspace.robot, workspace.activity.deck)


@pytest.fixture
def make(workspace: Workspace, sensors: LinkedSensors) -> Callable[[], SensorsScreen]:
    return lambda: SensorsScreen(
        workspace, sensors, health=sensors.health, live=True, where="on the bench"
    )


async def shown(pilot: TangyPilot, words: str) -> None:
    """Wait until the screen shows this."""
    await until_shown(pilot, lambda: words in pilot.text())


def row(pilot: TangyPilot, label: str) -> str:
    return next(line[:46] for line in pilot.lines() if label in line[:46])


@pytest.mark.slow
async def test_key_7_shows_the_devices_of_the_robot(
    run: Run, workspace: Workspace, policy: Policy, link: SeeingLink
) -> None:
    program = live_program(workspace, held_world(workspace, link), policy)
    async with run(app=program) as pilot:
        await paused_after(pilot, link, 2)
        assert "TANGY live" in screen_text(pilot.app)
        await pilot.press("7")
        assert isinstance(pilot.app.screen, SensorsScreen)
        await shown(pilot, "working for 8")
        told = pilot.text()
        assert "TANGY live" in told and "simulated" not in told
        assert "on the bench" not in told
        assert "working" in row(pilot, "wheels") and "0.1 s" in row(pilot, "wheels")
        assert "from /dev/video0" in told
        await pilot.press("escape")
        assert live(pilot).is_active


async def test_each_device_names_its_driver(run: Run, make: Callable[[], SensorsScreen]) -> None:
    async with run(make()) as pilot:
        assert "not there" in row(pilot, "arms") and "not there" in row(pilot, "voice")
        assert "on the bench" in pilot.text()
        pilot.type("home", "down", "down", "down")
        await shown(pilot, f"from rosbridge {AT}")
        pilot.type("down")
        await shown(pilot, "from the robot process")
        pilot.type("end")
        await shown(pilot, "No driver in the robot file")


async def test_v_shows_the_camera_picture(
    run: Run, make: Callable[[], SensorsScreen], link: SeeingLink
) -> None:
    async with run(make()) as pilot:
        assert link.asked_for == []
        pilot.type("V")
        await shown(pilot, BLOCK)
        await until_shown(pilot, lambda: len(link.asked_for) > 2)
        first, second = link.asked_for[:2]
        assert (first["after"], second["after"]) == (-1, 1)
        link.pid = 2  # it restarted, and counts its pictures from the beginning
        count = len(link.asked_for)
        await until_shown(pilot, lambda: len(link.asked_for) > count)
        assert link.asked_for[count]["after"] == -1


@pytest.mark.slow
async def test_the_last_card_is_drawn_as_the_robot_read_it(
    run: Run, make: Callable[[], SensorsScreen], link: SeeingLink, workspace: Workspace
) -> None:
    numbers = numbers_of(workspace.activity.deck, 17)
    async with run(make()) as pilot:
        assert "No card was read yet." in pilot.text()
        link.looked = link.read = {**READ, "age": 1.0}
        await shown(pilot, "Card 17, 2 of its numbers")
        assert f"[{numbers[0]}]" in pilot.text() and f"░{numbers[3]}░" in pilot.text()
        link.read = {**READ, "age": 21.0}
        link.looked = {**READ, "card": None, "problem": "no card in sight", "age": 15.0}
        await shown(pilot, "15 s ago: no card in sight.")
        assert "read 21 s" in pilot.text()


async def test_a_silent_robot_process_is_reported_and_not_queried(
    run: Run, make: Callable[[], SensorsScreen], link: SeeingLink
) -> None:
    async with run(make()) as pilot:
        await shown(pilot, "working for 8")
        link.silent = "the robot process does not answer"
        link.state = replace(
            link.state, health=tuple(r._replace(state=STALE) for r in link.state.health)
        )
        pilot.type("V")
        await shown(pilot, "No picture comes")
        assert "!! head camera" in pilot.text() and "disconnected" in row(pilot, "head camera")
        assert "no data" in row(pilot, "wheels")
        await pilot.pause(0.3)
        assert link.asked_for == []


async def test_leaving_does_not_wait_for_an_answer(
    sensors: LinkedSensors, link: SeeingLink
) -> None:
    link.answers = False
    async with asyncio.timeout(2), sensors:
        await asyncio.sleep(0.05)


@pytest.mark.slow
@pytest.mark.parametrize("size", [SMALL, (120, 40)], ids=["small", "large"])
async def test_the_live_sensors_match_their_snapshot(
    size: tuple[int, int],
    run: Run,
    make: Callable[[], SensorsScreen],
    link: SeeingLink,
    draw: Callable[[App[Any]], str],
    looks: Callable[[App[Any]], None],
) -> None:
    why = "Nothing can be seen in the picture."
    # in the middle of a minute before rounding, however slow the test is
    link.sight = replace(WELL, state="COVERED", why=why, seconds=785.0, age=185.0)
    link.looked = link.read = {**READ, "age": -9.0}
    async with run(make(), size) as pilot:
        pilot.type("V")
        await shown(pilot, "Card 17")
        await shown(pilot, BLOCK)
        await shown(pilot, "covered for 13 min")
        await shown(pilot, "covered, 3 min old")
        await settled(pilot, lambda: draw(pilot.app))  # a bar follows long words
        looks(pilot.app)
