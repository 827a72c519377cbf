"""The sensors on a screen: states of devices, a picture on request, the card as read."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from time import monotonic
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest
from textual.app import App

from tangy_hw.drivers.camera_state import Sight
from tangy_hw.perception.camera_hub import CardSight, SeenCard
from tangy_profiles.card_face import numbers_of
from tangy_profiles.health import ERROR, OK, STALE, Health, Reading
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.screens.sensors import SensorsScreen, device_row
from tangy_tui.ui.terminal import TerminalKind
from tangy_tui.ui.widgets.block_picture import BLOCK, BlockPicture
from tests.pilot.conftest import StillClock
from tests.support.waiting import until_shown

if TYPE_CHECKING:
    from tests.pilot.conftest import Run, TangyPilot

WELL = Sight("OK", "", 8.0, 0.05, 0.0, 0.5, 0.2, 0.6)
LOOK = 0.25


def picture(width: int, height: int, red: int = 0) -> Any:
    """A picture that is blue above and bright below, with this much red."""
    above, below = bytes((200, 20, red)) * width, bytes((250, 250, 250)) * width
    pixels = above * (height // 2) + below * (height - height // 2)
    return SimpleNamespace(width=width, height=height, pixels=pixels, seq=1)


@dataclass
class FakeSensors:
    """A head camera with given readings; it counts the requests."""

    now: Sight = WELL
    cards: CardSight = field(default_factory=CardSight)
    cameras: tuple[str, ...] = ("camera",)
    card_device: str = "camera"
    open: int = 0
    readers: int = 0
    asked: list[tuple[int, int]] = field(default_factory=list)
    red: int = 0

    async def __aenter__(self) -> FakeSensors:
        self.open += 1
        return self

    async def __aexit__(self, *_: object) -> None:
        self.open -= 1

    async def close(self) -> None:
        self.open = 0

    def source(self, device: str) -> str:
        return "/dev/video0"

    def sight(self, device: str) -> Sight:
        return self.now

    async def picture(self, device: str, fit: tuple[int, int], *, after: int = -1) -> Any:
        self.asked.append(fit)
        return picture(*fit, red=self.red)

    def health(self) -> Health:
        return (self.now.reading("camera"),)

    async def settled(self, seconds: float) -> None:
        return None

    @contextmanager
    def reading_cards(self) -> Iterator[None]:
        self.readers += 1
        try:
            yield
        finally:
            self.readers -= 1


def card(workspace: Workspace, hidden: int = 0b11000, stamp: float | None = None) -> SeenCard:
    """Card 17 with its first two numbers marked, read just now."""
    deck = workspace.activity.deck
    at = monotonic() if stamp is None else stamp
    return SeenCard(17, numbers_of(deck, 17), 0b11, hidden, deck.free, 5, at)


@pytest.fixture
def sensors() -> FakeSensors:
    return FakeSensors()


@pytest.fixture
def make(workspace: Workspace, sensors: FakeSensors) -> Callable[..., SensorsScreen]:
    given: Any = sensors
    return lambda **more: SensorsScreen(workspace, given, **more)


async def later(pilot: TangyPilot) -> None:
    """Wait until the screen has polled the devices again."""
    screen = pilot.app.screen
    assert isinstance(screen, SensorsScreen)
    screen.look()
    await pilot.pause()


def left(pilot: TangyPilot) -> list[str]:
    """The left side: the devices, and details of one."""
    return [line[:46] for line in pilot.lines()]


def row(pilot: TangyPilot, label: str) -> str:
    return next(line for line in left(pilot) if label in line)


@pytest.mark.slow
async def test_a_camera_is_shown_with_state_age_reason_and_duration(
    run: Run, make: Callable[..., SensorsScreen], sensors: FakeSensors
) -> None:
    async with run(make()) as pilot:
        assert "working" in row(pilot, "head camera") and "0.1 s" in row(pilot, "head camera")
        assert "working for 8.0 s" in pilot.text()
        why = "No picture has come: it stopped sending."
        sensors.now = Sight("DISCONNECTED", why, 42.0, 44.0, 0.0, 0.5, 0.2, 0.6)
        await later(pilot)
        assert "!! head camera" in pilot.text() and "disconnected" in row(pilot, "!! head camera")
        assert "disconnected for 42 s" in pilot.text() and "44 s" in row(pilot, "!! head camera")
        assert "it stopped sending" in pilot.text()
        sensors.now = replace(WELL, state="COVERED", why="Does something cover the lens?")
        await later(pilot)
        assert "!  head camera" in pilot.text() and "covered" in pilot.text()
        assert "cover the lens" in pilot.text()
        sensors.now = WELL
        await later(pilot)
        assert "working" in row(pilot, "   head camera")


async def test_simulated_devices_are_marked(run: Run, make: Callable[..., SensorsScreen]) -> None:
    readings: list[Reading] = []

    def health() -> Health:
        return tuple(readings)

    clock = StillClock()
    async with run(make(health=health, clock=clock)) as pilot:
        assert "simulated" in row(pilot, "laser scanner")
        near = {"near_share": 0.9, "variety": 0.3}
        readings += [
            Reading("laser", 0.05, OK, near), Reading("link", 3.0, OK), Reading("arms", 0.1, ERROR),
        ]  # fmt: skip
        await later(pilot)
        assert "~laser scanner" in row(pilot, "laser scanner") and "~ simulated" in pilot.text()
        assert "!!~link to the robot" in pilot.text()
        assert "no data" in row(pilot, "link to") and "failed" in row(pilot, "arms")
        clock.now += 2.0
        await later(pilot)
        pilot.type("home")
        await pilot.pause()
        assert "no data for 2.0 s (simulated)" in pilot.text()
        assert "at most 0.25 s" in pilot.text()
        pilot.type("down", "down")
        await pilot.pause()
        assert "share of beams that end within a" in pilot.text() and "0.90" in pilot.text()
        assert STALE not in pilot.text()  # words for staff, none of the code's


async def test_the_rate_of_data_is_shown_beside_its_age(
    run: Run, make: Callable[..., SensorsScreen], sensors: FakeSensors
) -> None:
    sensors.now = replace(WELL, rate=14.6)
    readings = [Reading("laser", 0.05, OK, {}, 10.02), Reading("base", 9.0, OK, {}, 0.0)]
    screen = make(health=lambda: tuple(readings), live=True)
    async with run(screen) as pilot:
        await later(pilot)
        pilot.type("home", "down", "down")
        await pilot.pause()
        assert "new data at 10 Hz" in pilot.text()
        rows = {
            name: "".join(part for part, _ in device_row(told, 80))
            for name, told in screen.told.items()
        }
        assert "0.1 s  10 Hz" in rows["laser"]
        assert "9.0 s  0.0 Hz  Its data" in rows["base"]
        assert "0.1 s  15 Hz" in rows["camera"]
        assert "Hz" not in rows["voice"]


async def test_a_picture_is_fetched_only_while_it_is_shown(
    run: Run, make: Callable[..., SensorsScreen], sensors: FakeSensors
) -> None:
    async with run(make()) as pilot:
        await pilot.pause(2 * LOOK)
        assert sensors.asked == [] and BLOCK not in pilot.text()
        pilot.type("V")
        await until_shown(pilot, lambda: BLOCK in pilot.text())
        shown = pilot.app.screen.query_one(BlockPicture)
        width, height = shown.content_size
        assert sensors.asked[-1] == (width, 2 * height) == shown.fit
        assert pilot.text().count(BLOCK * width) == height
        await later(pilot)
        assert "live" in pilot.text()
        pilot.type("question_mark")
        await pilot.pause()
        asked = len(sensors.asked)
        await pilot.pause(2 * LOOK)
        assert len(sensors.asked) <= asked + 1  # help covers it
        pilot.type("escape")
        await pilot.pause()
        pilot.type("enter")
        await pilot.pause()
        asked = len(sensors.asked)
        await pilot.pause(2 * LOOK)
        assert len(sensors.asked) == asked and BLOCK not in pilot.text()


async def test_an_enlarged_picture_uses_the_available_space(
    run: Run, make: Callable[..., SensorsScreen], sensors: FakeSensors
) -> None:
    async with run(make()) as pilot:
        pilot.type("V", "tab", "tab")
        await pilot.pause()
        pilot.type("plus")
        await until_shown(pilot, lambda: BLOCK * 70 in pilot.text())
        assert sensors.asked[-1][0] > 70 and sensors.asked[-1][1] > 36
        pilot.type("escape")
        await until_shown(pilot, lambda: sensors.asked[-1][0] < 40)
        assert isinstance(pilot.app.screen, SensorsScreen)


@pytest.mark.parametrize("kind", [TerminalKind(ascii=True), TerminalKind(ansi=True)])
async def test_a_picture_without_colours_is_drawn_in_shades(
    run: Run, make: Callable[..., SensorsScreen], kind: TerminalKind
) -> None:
    async with run(make(), kind=kind) as pilot:
        pilot.type("V")
        await until_shown(pilot, lambda: "@@@" in pilot.text())
        width, height = pilot.app.screen.query_one(BlockPicture).content_size
        assert pilot.text().count("." * width) >= height // 2 - 1
        assert pilot.text().count("@" * width) >= height // 2


async def test_only_the_changed_part_of_a_picture_is_drawn(run: Run) -> None:
    shown = BlockPicture("Picture", "")
    drawn: list[Any] = []

    class One(App[None]):
        def compose(self) -> Any:
            yield shown

    async with One().run_test(size=(40, 10)) as pilot:
        shown.show(picture(30, 16))
        await pilot.pause()
        shown.refresh = lambda *regions, **_: drawn.append(regions)  # type: ignore[method-assign,assignment]
        shown.show(picture(30, 16, red=9))  # no more than noise
        assert drawn == []
        shown.show(picture(30, 16, red=90))
        ((*regions,),) = drawn
        assert [(region.y, region.width) for region in regions] == [(1 + n, 30) for n in range(4)]


async def test_the_last_card_is_drawn_as_read(
    run: Run, make: Callable[..., SensorsScreen], sensors: FakeSensors, workspace: Workspace
) -> None:
    async with run(make()) as pilot:
        assert "No card was read yet." in pilot.text()
        sensors.cards = CardSight(card(workspace), "", monotonic())
        await later(pilot)
        numbers = numbers_of(workspace.activity.deck, 17)
        assert "Card 17, 2 of its numbers" in pilot.text()
        assert f"[{numbers[0]}]" in pilot.text() and f"[{numbers[1]}]" in pilot.text()
        assert f"░{numbers[3]}░" in pilot.text() and f"░{numbers[4]}░" in pilot.text()
        assert f"[{numbers[3]}]" not in pilot.text()
        assert all(f" {number} " in pilot.text() for number in numbers[5:])
        assert "not seen" in pilot.text()
        sensors.cards = CardSight(
            card(workspace, 0, monotonic() - 20), "no card in sight", monotonic()
        )
        await later(pilot)
        assert "Card 17, read 20 s ago." in pilot.text()
        assert "Now: no card in sight." in pilot.text()


async def test_the_cameras_are_open_while_the_screen_is(
    run: Run, workspace: Workspace, sensors: FakeSensors
) -> None:
    given: Any = sensors
    async with run(app=Program(workspace, sensors=given)) as pilot:
        assert sensors.open == 0
        pilot.type("c", "enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, SensorsScreen)
        assert (sensors.open, sensors.readers) == (1, 1)
        pilot.type("escape")
        await until_shown(pilot, lambda: (sensors.open, sensors.readers) == (0, 0))
        assert not isinstance(pilot.app.screen, SensorsScreen)
        pilot.type("c", "enter")
        await pilot.pause()
        assert sensors.open == 1
    assert sensors.open == 0


async def test_a_missing_camera_is_explained(run: Run, workspace: Workspace) -> None:
    async with run(SensorsScreen(workspace)) as pilot:
        assert "camera=0" in pilot.text()
        pilot.type("V", "enter")
        await pilot.pause()
        assert "camera=0" in pilot.text() and "No camera looks at cards." in pilot.text()


@pytest.mark.slow
async def test_a_real_camera_is_used_in_a_game_and_shown_by_key_7(
    run: Run,
    workspace: Workspace,
    policy: Policy,
    sensors: FakeSensors,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async def loaded(program: Program, wanted: str = "") -> Policy:
        return policy

    monkeypatch.setattr(Program, "load_policy", loaded)
    given: Any = sensors
    clock = StillClock()
    app = Program(
        workspace, lambda program: program.play(seed=3), sensors=given, live=True, clock=clock
    )
    async with run(app=app) as pilot:
        await until_shown(pilot, lambda: "robot OK" in pilot.text())
        assert (sensors.open, sensors.readers) == (1, 0)
        sensors.now = replace(WELL, state="COVERED", brightness=0.01, contrast=0.005)
        await until_shown(pilot, lambda: "Head camera covered" in pilot.text())
        pilot.type("7")
        await pilot.pause()
        assert "! robot WARN: Head camera covered" in pilot.lines()[0]
        assert "covered" in row(pilot, "!  head camera") and "~arms" in row(pilot, "arms")
        assert sensors.open == 2
        pilot.type("escape")
        await until_shown(pilot, lambda: sensors.open == 1)
        assert isinstance(pilot.app.screen, PlayScreen)
        pilot.type("escape")
        await pilot.pause()
        pilot.type("y")
        await until_shown(pilot, lambda: sensors.open == 0)
        assert isinstance(pilot.app.screen, HomeScreen)


@pytest.mark.parametrize("size", [(80, 24), (120, 40)], ids=["small", "large"])
async def test_the_sensors_match_their_snapshot(
    size: tuple[int, int],
    run: Run,
    make: Callable[..., SensorsScreen],
    sensors: FakeSensors,
    workspace: Workspace,
    picture: Callable[[App[Any]], None],
) -> None:
    sensors.now = replace(WELL, state="COVERED", why="Nothing can be seen in the picture.")
    sensors.cards = CardSight(card(workspace, stamp=monotonic() + 9), "", monotonic())
    health = (Reading("laser", 0.05, OK), Reading("link", 3.0))
    async with run(make(health=lambda: health), size) as pilot:
        pilot.type("V")
        await until_shown(pilot, lambda: BLOCK in pilot.text())
        await later(pilot)
        picture(pilot.app)


async def test_v_switches_to_picture_and_card_in_a_narrow_window(
    run: Run, make: Callable[..., SensorsScreen], sensors: FakeSensors, workspace: Workspace
) -> None:
    sensors.cards = CardSight(card(workspace), "", monotonic())
    async with run(make(), (60, 18)) as pilot:
        assert "head camera" in pilot.text() and "Last card" not in pilot.text()
        pilot.type("V")
        await until_shown(pilot, lambda: BLOCK in pilot.text())
        assert "Card 17" in pilot.text() and "Devices" not in pilot.text()
        pilot.type("V")
        await pilot.pause()
        assert "Last card" not in pilot.text()
        assert pilot.app.focused is pilot.app.screen.query_one("#devices")
