"""The live screen: a game among people with a live robot, in which staff can intervene.

Behaviours take time, so they run in a thread; nothing else uses the supervision meanwhile. Urgent
matters (a STOP, requests, the robot's position) go directly to the robot.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from math import ceil
from time import monotonic
from typing import ClassVar, TypeVar

from textual.binding import BindingType
from textual.content import Content
from textual.events import Resize
from textual.screen import Screen

from tangy_hw.robot_client.declared_live_world import DeclaredLiveWorld
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.game_world import BENCH, GameWorld
from tangy_profiles.past_game import PastGame
from tangy_tui.app.game_commands import AUTONOMY
from tangy_tui.app.seats import Seats
from tangy_tui.app.sensing import LinkedSensors
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import GameChanged
from tangy_tui.monitoring.supervision import Event, Supervision
from tangy_tui.text.control import FINDS_ITS_PLACE, WAITS_FOR_YOU, short_going_words
from tangy_tui.text.joining import GOES_ON, joined_words, setting_up_words
from tangy_tui.text.live_games import LOOKS_ROUND, frozen_words
from tangy_tui.text.live_news import seated_words
from tangy_tui.text.missing_devices import missing_words
from tangy_tui.text.planned_time import after_end_words
from tangy_tui.text.situations import OVER_NOW
from tangy_tui.text.staff_view import BEGINS_NOW
from tangy_tui.text.tablet import screen_words
from tangy_tui.ui.fault_console import Work
from tangy_tui.ui.panels import KeyLine
from tangy_tui.ui.screens import live_keys
from tangy_tui.ui.screens.live_cards import LiveCards
from tangy_tui.ui.screens.live_keys import CARDS_ONLY, FACTS_ONLY, NOT_LIVE
from tangy_tui.ui.screens.live_marks import track
from tangy_tui.ui.screens.live_staff import LiveStaff
from tangy_tui.ui.screens.play_panels import STAFF
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.status_line import Status

TRACK_SECONDS = 0.2
SLOW_TRACK_SECONDS = 1.0
"""The interval between two updates of the robot's position."""
STAFF_SECONDS = 1.0
"""The interval between two updates of the staff panel."""
REST_SECONDS = 5.0  # in which the current behaviour is aborted

MODES: dict[GameWorld, str] = {BENCH: "bench"}
"""The worlds with another name on the status line."""

T = TypeVar("T")


class LiveScreen(LiveStaff):
    """Games among people. Dismissed with their totals."""

    mode = "live"
    FIRST = STAFF
    HELP = live_keys.HELP
    LETTERS_FOLLOW = live_keys.LETTERS_FOLLOW
    BINDINGS: ClassVar[list[BindingType]] = live_keys.BINDINGS

    def __init__(
        self,
        workspace: Workspace,
        supervision: Supervision,
        world: LiveWorld,
        *,
        games: int = 1,
        teacher: str = "",
        past: PastGame | None = None,
    ) -> None:
        """Create the screen for games in a live world; a past game is resumed first."""
        super().__init__(
            workspace,
            supervision,
            games=games,
            speed=1,
            teacher=teacher,
            robot=world,
            past=past,
        )
        self.world = world
        self.mode = MODES.get(world.played_in, self.mode)
        self._faults.beside = self._attend_beside
        self.picture.counts = lambda: bool(self._until_call()) and not self.at_rest
        self.picture.over = self._over_words
        self.closes: Callable[[], object] = lambda: None
        """Switches the robot off; it may be called again."""
        self.took = 0.0
        """How long the robot took to come on, in s; 0: unknown."""
        self.takes = ""
        """What the game takes from the last one, if nobody set it up."""
        self._seen_doing = ""
        self._frozen = 0.0
        self._tracked = 0.0
        self._seats = Seats()
        self._cards = LiveCards(workspace, supervision, world, self._write)

    def on_mount(self) -> None:
        """Show the robot's state, and poll it; the base screen begins the game."""
        self.show_status()
        self.set_interval(STAFF_SECONDS, self.show_staff)
        workspace = self._workspace
        for told in missing_words(workspace.robot, workspace.activity):
            self._write(told, "text")
        if (link := self.world.link).screen:
            self._write(screen_words(link.screen, link.code), "text")
            # a small window hides the log, and the tablet may have to be connected again
            self.query_one(RoomView).border_subtitle = Content(self.world.link.tablet_page)
        self.set_interval(TRACK_SECONDS, self.track)
        if self.takes:
            self.call_after_refresh(self._tell_now, self.takes, "text")

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Disable actions that are not available among people."""
        none = CARDS_ONLY if not self._has_cards else () if self.world.eyes else FACTS_ONLY
        return action not in (*NOT_LIVE, *none) and super().check_action(action, parameters)

    def _seen_since(self) -> bool:
        """Whether the room lacks a sign, or a card, that was seen since it was drawn."""
        scene, shown = self.picture.scene(), self.query_one(RoomView).scene
        return (scene.requests, scene.card) != (shown.requests, shown.card)

    @property
    def _has_cards(self) -> bool:
        return not isinstance(self.world, DeclaredLiveWorld)

    # ---------------------------------------------------------------------------------- game

    def _over_words(self) -> str:
        control = self.control
        if control.beginning:
            return BEGINS_NOW
        return setting_up_words(control.welcomes) if control.joined else OVER_NOW

    async def switch_off(self) -> None:
        """Switch the robot off for a new person, while the screen still shows the game."""
        self.show_status()
        self.show_staff()
        await asyncio.shield(asyncio.to_thread(self.closes))

    async def _begin_game(self) -> list[Event]:
        if not (self.control.stopped and self.control.past is not None):
            await self._until_going()
        if self.world.lost:
            self._write(LOOKS_ROUND, "warn")
        self.picture.forget()
        begun = await super()._begin_game()
        time = self.control.time
        if time.ends is not None and time.ends <= time.clock():
            said = after_end_words(time.ends, time.clock(), by_key=True)
            self._tell_now(self._told(said), "warn")
        return begun

    async def _attend_beside(self, work: Work) -> list[Event]:
        """Act on the fault that halts the robot, which may restart the robot process."""
        try:
            return await self._beside(work)
        finally:
            if self.control.stopped:  # the new process does not know of the stop
                self.control.robot.stop()

    async def _wait(self, seconds: float) -> None:
        """Do not wait: a live behaviour has already taken its time."""
        self._left = 0.0

    # -------------------------------------------------------------------------------- picture

    def _sensors_screen(self, shown: Callable[[], Status]) -> Screen[None]:
        """Create the screen of the robot process's devices."""
        from tangy_tui.ui.screens.sensors import SensorsScreen

        workspace, where = (
            self._workspace,
            "on the bench" if isinstance(self.world, BenchedWorld) else "",
        )
        sensors = LinkedSensors(self.world.link, workspace.robot, workspace.activity.deck)
        return SensorsScreen(
            workspace, sensors, health=sensors.health, shown=shown, live=True, where=where
        )

    def _tell(self, events: list[Event], known: bool = False) -> None:
        """Show events, and people at another person's seat."""
        super()._tell(events, known)
        for seated in self._seats.news(events, self.world.sitting):
            self._write(seated_words(seated, self._workspace.name), "warn")
        self._cards.tell(events)
        joined = [e.person for e in events if isinstance(e, GameChanged) and e.what == "joined"]
        if joined and not self.query_one(LogView).display:  # a small window hides the log
            self.notify(joined_words([*map(self._workspace.name, joined)]), markup=False)

    def track(self) -> None:
        """Draw the robot's pose and its estimates; send it a heartbeat."""
        self.world.link.alive()
        self._cards.tell()
        room = self.query_one(RoomView)
        state = self.world.link.state
        if not state.number:
            return
        if self._short_doing() != self._seen_doing:
            self.show_status()
        if state.frozen and not self._frozen:
            self._write(frozen_words(state.frozen), "bad")
            self.control.note("robot frozen", detail=f"{state.frozen:.1f}")
        self._frozen = state.frozen
        due = SLOW_TRACK_SECONDS if getattr(self.app, "slow_link", False) else 0.0
        if (now := monotonic()) - self._tracked >= due:
            self._tracked = now
            track(room, state)

    async def _come_to_rest(self) -> None:
        """Abort the robot's current behaviour, and wait until it has stopped."""
        self.control.break_off()
        await asyncio.to_thread(self.control.wait_for_turn, REST_SECONDS)

    def went_back(self) -> bool:
        """Go back on a panel, or from another one to *Now*; False: there is nothing to leave."""
        if super().went_back():
            return True
        if self._shows_now or self._asking is not None:
            return False
        self.action_panel(STAFF)
        return True

    def action_panel(self, name: str) -> None:
        """Show a panel, and where Esc leads from there."""
        super().action_panel(name)
        self.show_status()

    def on_resize(self, event: Resize) -> None:
        """Show where Esc leads: a wider screen has more panels."""
        self.call_after_refresh(self.show_status)

    @property
    def _shows_now(self) -> bool:
        """Whether the panel *Now* is visible; its style follows the classes only later."""
        alone = self.has_class("-narrow") and (self.has_class("-left") or self.has_class("-room"))
        return self.has_class("-staff") and not alone

    def show_status(self) -> None:
        """Show the state of the game, and the keys that have an effect now."""
        self._seen_doing = self._short_doing()
        super().show_status()
        going = self.control.going
        self.query_one(KeyLine).show(
            *live_keys.keys(
                going=going,
                over=self.at_rest,
                cards=self._has_cards,
                claims=bool(self._workspace.activity.rules.claim),
                tells=self.world.eyes is not None,
                now=self._shows_now,
                joining=self.control.joined,
            )
        )

    def _note(self) -> str:
        """Describe what the robot is doing, or the effect of the keys."""
        if self.control.joined:
            return GOES_ON
        if self.control.stopped or self._learning or self.at_rest or not self.control.going:
            return super()._note()
        if self.control.phase == "asking":
            return WAITS_FOR_YOU
        level = self.control.autonomy.level
        autonomy = live_keys.DIAL[level] if level != AUTONOMY[0] else ""
        return self._doing() or self._until_call() or autonomy

    def _short_doing(self) -> str:
        """Tell what changes the status line without an event."""
        begins = BEGINS_NOW if self.control.beginning else ""
        return self._doing() or self._until_call() or begins

    def _doing(self) -> str:
        """Describe the robot's current drive, "" if it is not driving."""
        if self.working and self.world.lost:
            return FINDS_ITS_PLACE
        state = self.world.link.state
        return short_going_words(state.going, self._workspace.name, state.yields_to)

    def _until_call(self) -> str:
        left = self.world.calls_in if self.control.counts_down else 0.0
        return f"next call in {ceil(left)} s" if left else ""
