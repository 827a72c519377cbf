"""Fixtures of the screens' tests: reading the screen, typing at a known moment, sample people.

    async def test_something(run: Run) -> None:
        async with run(HomeScreen()) as pilot:
            pilot.type(*"call number", "enter")
            await pilot.pause()
            assert "Did you say" in pilot.text()

`run(screen)` starts Tangy with a screen and yields the pilot; its clock stands still at 0, so that
dialogs take keys at once (the real clock stamps keys) and a robot moves only on command.
Types are for the type checker only (`if TYPE_CHECKING: from tests.pilot.conftest import Run`):
at run time a module called conftest may be that of any folder.
"""

from __future__ import annotations

import asyncio
import gc
import re
from collections.abc import AsyncIterator, Callable, Hashable, Iterator
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from dataclasses import dataclass, field
from functools import partial
from time import monotonic, process_time
from typing import Any

import pytest
from syrupy.assertion import SnapshotAssertion
from syrupy.extensions.image import SVGImageSnapshotExtension
from textual import events
from textual.app import App
from textual.css.model import RuleSet
from textual.css.stylesheet import Stylesheet
from textual.css.types import CSSLocation
from textual.keys import _character_to_key
from textual.pilot import Pilot
from textual.screen import Screen

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.beliefs import Beliefs, Beta
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.person import Person, load_people
from tangy_profiles.room import Room, load_room
from tangy_profiles.scene import Scene
from tangy_profiles.state import FRONT
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import ForestSettings, Policy
from tangy_tui.ui.app import TangyApp
from tangy_tui.ui.program import Program
from tangy_tui.ui.terminal import TerminalKind
from tests.interaction.gaps import learnt
from tests.pilot.live_games import HeldLink, held_world, live_program
from tests.support.clocks import StillClock as StillClock
from tests.support.waiting import PATIENCE

SMALL = (80, 24)
LARGE = (160, 45)


def screen_lines(app: App[Any]) -> list[str]:
    """Return the readable text of the screen, line by line, without trailing spaces."""
    strips = app.screen._compositor.render_strips()
    return ["".join(segment.text for segment in strip).rstrip() for strip in strips]


def screen_text(app: App[Any]) -> str:
    """Return the readable text of the screen."""
    return "\n".join(screen_lines(app))


def type_at_once(app: App[Any], *keys: str, at: float | None = None) -> None:
    """Type keys in one go, as one write to the terminal would; `at` says when (default: now)."""
    for key in keys:
        name = key if len(key) > 1 else _character_to_key(key)
        event = events.Key(name, key if len(key) == 1 else None)
        event.set_sender(app)
        event.time = monotonic() if at is None else at
        app.post_message(event)


LONGEST = 1.0
"""CPU seconds after which `until_idle` no longer waits for a program that is always busy.

Textual counts seconds of the clock: on a busy machine it gave up before a program had begun.
"""

GLANCE = 0.02
"""Seconds for watching a thread: it is busy if it uses a twentieth of them (as in Textual)."""


def _to_be_painted(screen: Screen[Any]) -> bool:
    return bool(
        screen._layout_required
        or screen._scroll_required
        or screen._repaint_required
        or screen._recompose_required
        or screen._dirty_widgets
        or screen._callbacks
    )


async def until_idle(app: App[Any], least: float = 0.0, most: float = LONGEST) -> None:
    """Wait until a program is idle: it waits for keys, or for time to pass.

    To find out, Textual watches the processor for 20 or 40 ms at every key and pause; that took
    half of the time of these tests. The loop knows at once: no callback is ready, nothing remains
    to be painted, the window is not being resized. The processor is watched as Textual does it
    only while a worker's thread is running.
    """
    loop: Any = asyncio.get_running_loop()
    start, began = monotonic(), process_time()
    quiet = 0
    while process_time() - began < most and monotonic() - start < PATIENCE:
        thread = any(worker._thread_worker and worker.is_running for worker in app.workers)
        used = process_time() if thread else 0.0
        await asyncio.sleep(GLANCE if thread else 0)  # lets the loop poll for events, too
        thinks = thread and process_time() - used >= GLANCE / 20
        screen = app._screen_stack[-1] if app._screen_stack else None
        behind = app._background_screens if screen is not None and not app._exit else []
        if app._resize_event is not None:
            await asyncio.sleep(1 / 120)  # Textual waits this long for a window's last size
            quiet = 0
        elif loop._ready or thinks:
            quiet = 0
        elif screen is not None and not app._exit and _to_be_painted(screen):
            screen._on_timer_update()  # as Textual does at the next sixtieth of a second
            quiet = 0
        elif due := [one for one in behind if one._layout_required or one._callbacks]:
            for covered in due:  # in part, by a dialog
                covered._on_timer_update()
            quiet = 0
        else:
            quiet += 1
            if quiet > 1 and monotonic() - start >= least:
                return


class TangyPilot(Pilot[None]):
    """A pilot that can also read the screen, and type several keys in one go."""

    def text(self) -> str:
        """Return the readable text of the screen."""
        return screen_text(self.app)

    def lines(self) -> list[str]:
        """Return the readable text of the screen, line by line."""
        return screen_lines(self.app)

    def type(self, *keys: str, at: float | None = None) -> None:
        """Type keys at once; they have arrived after the next `pause`."""
        type_at_once(self.app, *keys, at=at)


@dataclass
class Sample:
    """People, a room, a scene and beliefs to try the widgets with."""

    room: Room = field(default_factory=load_room)
    people: tuple[Person, ...] = field(default_factory=lambda: load_people(4))

    @staticmethod
    def of(people: int) -> Sample:
        """Return a sample with this many people."""
        return Sample(people=load_people(people))

    def scene(self, place: str = FRONT, asking: tuple[str, ...] = ("user2",)) -> Scene:
        """Return a scene in which people ask for help."""
        words = ("marks B-7", "asks for help", "watches", "moves the card")
        doing = {p.id: words[n % 4] for n, p in enumerate(self.people)}
        return Scene(place, asking, doing, (7, 22, 31), None)

    def beliefs(self) -> dict[str, Beliefs]:
        """Return different beliefs: unknown, vague, certain."""
        counts = ((7, 2), (1, 3), (0, 0), (40, 60))
        strategies = ("neutral", "praise", "suggestion", "scarcity")
        return {
            person.id: {
                strategy: Beta(1.0 + counts[(n + k) % 4][0], 1.0 + counts[(n + k) % 4][1])
                for k, strategy in enumerate(strategies)
            }
            for n, person in enumerate(self.people)
        }

    def names(self) -> dict[str, str]:
        """Return the names by id."""
        return {person.id: person.name for person in self.people}


_RULES: dict[Hashable, list[RuleSet]] = {}
_parse_rules = Stylesheet._parse_rules


def _parse_once(
    sheet: Stylesheet,
    css: str,
    read_from: CSSLocation,
    is_default_rules: bool = False,
    tie_breaker: int = 0,
    scope: str = "",
) -> list[RuleSet]:
    """Parse a style sheet once for all programs that tests start.

    Textual caches sheets per program; a person starts one program, and the tests start a thousand.
    """
    variables = tuple(sheet._variables.items())
    key = (css, read_from, is_default_rules, tie_breaker, scope, variables)
    if key not in _RULES:
        _RULES[key] = _parse_rules(sheet, css, read_from, is_default_rules, tie_breaker, scope)
    return _RULES[key]


@pytest.fixture(scope="session", autouse=True)
def _style_sheets() -> Iterator[None]:
    """Let all programs share parsed style sheets."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Stylesheet, "_parse_rules", _parse_once)
        yield


@pytest.fixture(scope="session", autouse=True)
def _garbage() -> Iterator[None]:
    """Keep games from freezing all objects, as the program does: it plays one game, tests many.

    Frozen objects are never freed, and each freeze first examines all of them.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(gc, "freeze", lambda: None)
        patch.setattr(gc, "collect", lambda *_: 0)
        yield


Run = Callable[..., AbstractAsyncContextManager[TangyPilot]]


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch) -> Run:
    """Start Tangy with a screen: `async with run(Screen(), size=(80, 24)) as pilot`."""

    @asynccontextmanager
    async def start(
        screen: Screen[Any] | None = None,
        size: tuple[int, int] = SMALL,
        *,
        kind: TerminalKind | None = None,
        clock: Callable[[], float] | None = None,
        app: TangyApp | None = None,
        notifications: bool = False,
    ) -> AsyncIterator[TangyPilot]:
        if app is None:
            first = None if screen is None else lambda: screen
            app = TangyApp(first, kind=kind, clock=clock or StillClock())
        for who_waits in ("textual.app", "textual.pilot"):
            monkeypatch.setattr(f"{who_waits}.wait_for_idle", partial(until_idle, app))
        async with app.run_test(size=size, notifications=notifications):
            pilot = TangyPilot(app)
            await pilot.pause()
            yield pilot

    return start


@pytest.fixture
def clock() -> StillClock:
    """A clock that stands still until it is advanced."""
    return StillClock()


@pytest.fixture
def sample() -> Sample:
    """People, a room, a scene and beliefs."""
    return Sample()


@pytest.fixture
def draw() -> Callable[[App[Any]], str]:
    """Draw the screen as an SVG that fetches nothing, not even a font."""

    def draw_one(app: App[Any]) -> str:
        drawn = app.export_screenshot(title="Tangy", simplify=True)
        return re.sub(r',\s*url\("http[^)]*\) format\("\w+"\)', "", drawn)

    return draw_one


@pytest.fixture
def looks(snapshot: SnapshotAssertion) -> Callable[[App[Any]], None]:
    """Compare the readable text of the screen, cell by cell, with its snapshot."""

    def compare(app: App[Any]) -> None:
        assert screen_text(app) == snapshot

    return compare


@pytest.fixture
def picture(
    snapshot: SnapshotAssertion, draw: Callable[[App[Any]], str]
) -> Callable[[App[Any]], None]:
    """Compare the screen with its SVG picture: for the few screens whose colours carry meaning."""
    pictures = snapshot.use_extension(SVGImageSnapshotExtension)

    def compare(app: App[Any]) -> None:
        assert draw(app) == pictures

    return compare


@pytest.fixture
def policy(
    workspace: Workspace, cover: Callable[[str, int, int], tuple[Demonstration, ...]]
) -> Policy:
    """A policy that covers every situation, learnt by few trees."""
    settings = ForestSettings(trees=5)
    return learnt(workspace.store, workspace.activity, cover("bingo", 1, 4), settings)


@pytest.fixture
def link() -> HeldLink:
    """A fake robot process whose behaviours end only when the test allows it."""
    return HeldLink()


@pytest.fixture
def world(workspace: Workspace, link: HeldLink) -> LiveWorld:
    """The world of that robot."""
    return held_world(workspace, link)


@pytest.fixture
def program(workspace: Workspace, world: LiveWorld, policy: Policy) -> Program:
    """A program that opens with the live screen of that world."""
    return live_program(workspace, world, policy)
