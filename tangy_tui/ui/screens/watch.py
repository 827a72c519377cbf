"""A second console: shows the game of another program, and can stop the robot."""

from __future__ import annotations

from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical
from textual.content import Content
from textual.widgets import Static

from tangy_profiles.activity import Activity
from tangy_profiles.game_records import CallMade, GameChange
from tangy_profiles.person import Person
from tangy_profiles.room import Point
from tangy_profiles.store import Store
from tangy_tui.app.game_view import GameView
from tangy_tui.app.watching import WATCH_SECONDS, Guest, NobodyThere, WatchedLog, room_of
from tangy_tui.monitoring.fault import Diagnosed, Moved
from tangy_tui.monitoring.replay import AnsweredRequest, Done, Moment, Noted, Unclear
from tangy_tui.text import watching as text
from tangy_tui.text.endings import ending_words
from tangy_tui.text.fault_views import WAITS
from tangy_tui.text.interruptions import GOES_ON_LATER
from tangy_tui.text.log import game_words, moment_lines
from tangy_tui.text.register import staff_names
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.keys import keymap_of
from tangy_tui.ui.messages import Stop
from tangy_tui.ui.panels import LOW, WIDE, KeyLine, panel
from tangy_tui.ui.screens.play_view import person_lines
from tangy_tui.ui.widgets.call_board import CallBoard
from tangy_tui.ui.widgets.log_view import Kind, LogView
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.staff_panel import StaffPanel
from tangy_tui.ui.widgets.status_line import Status, StatusLine

LOOKS_WITHOUT = 3
"""After so many looks without a game there is none: it may be changing at that moment."""
ALARMS = ("stopped", "halted")
OF_THE_GAME = (
    *("pause", "step", "faster", "slower", "autonomy", "take_over", "drive", "call_again"),
    *("ask_for", "claim", "presence", "whose_card", "tell", "undo", "command"),
)
"""Actions of staff whose keys an onlooker may press."""
KINDS: dict[type, Kind] = {
    Diagnosed: "warn",
    Moved: "dim",
    Noted: "dim",
    Unclear: "warn",
    CallMade: "warn",
    GameChange: "dim",
}


class WatchScreen(TangyScreen[None]):
    """Shows a game to an onlooker. Nothing here changes the game; STOP stops the robot."""

    CSS_PATH = "watch.tcss"
    HORIZONTAL_BREAKPOINTS = WIDE
    VERTICAL_BREAKPOINTS = LOW
    HELP = text.HELP
    AUTO_FOCUS = "#log"
    BINDINGS: ClassVar[list[BindingType]] = []

    def __init__(self, guest: Guest, store: Store, *, who: str, note: str = "") -> None:
        """Create the screen.

        Args:
            guest: the connection to the program that runs the games.
            store: its log, open for reading.
            who: the onlooker, named in the log if they stop the robot.
            note: the first line of the log panel.
        """
        super().__init__()
        self._guest, self._log = guest, WatchedLog(store)
        self._called = staff_names(self._log.name)
        self._who, self._note = who, note
        self._view: GameView | None = None
        self._there = False
        self._none = 0  # looks without a game
        self._shown: tuple[str, tuple[str, ...]] = ("", ())
        self._activity: Activity | None = None

    def compose(self) -> ComposeResult:
        """Lay out the room and the board of calls, with the log beside or below."""
        yield StatusLine(Status(mode="watch"))
        with Horizontal(id="body"):
            with Vertical(id="left"):
                yield Static("", id="called")
            yield panel(LogView(id="log"))
        yield KeyLine("filter", "zoom", "palette", "quit", "help")

    @property
    def steps(self) -> int:
        """The number of steps of the game so far; 0: there is no game."""
        return 0 if self._view is None else self._view.step

    async def on_mount(self) -> None:
        """Start to poll."""
        log = self.query_one(LogView)
        for sentence in (self._note, text.READ_ONLY):
            if sentence:
                log.write(sentence, "dim")
        await self.look()
        if not self._there:
            log.write(text.NOBODY, "warn")
        self.set_interval(WATCH_SECONDS, self.look)

    def on_unmount(self) -> None:
        """Disconnect."""
        self._guest.close()

    def on_key(self, event: events.Key) -> None:
        """Tell that a key of the game does nothing here."""
        if keymap_of(self.app).action(event.key) in OF_THE_GAME:
            event.stop()
            self.app.clear_notifications()
            self.notify(text.READ_ONLY, markup=False)

    def on_stop(self, message: Stop) -> None:
        """Stop the robot first, then redraw."""
        if getattr(self.app, "leaving", False):
            return  # an onlooker may leave without stopping the robot
        log = self.query_one(LogView)
        try:
            self._guest.stop(self._who)
        except NobodyThere:
            log.write(text.NOTHING_TO_STOP, "bad")
        else:
            log.write(text.ASKED_TO_STOP, "warn")

    async def look(self) -> None:
        """Show new events."""
        was, stops = self._there, self._guest.stops
        self._there = self._guest.look()
        self._tell_log()
        if was and not self._there:
            over = self._view is None or self._log.over
            gone = text.CLOSED if self._view is None else text.GONE
            self.query_one(LogView).write(gone, "warn")
            if not over and self._view is not None:
                self.query_one(LogView).write(GOES_ON_LATER, "warn")
        if self._guest.stops > stops:
            self.query_one(LogView).write(text.STOPPED_HERE, "bad")
        if self._there and self._guest.pid and self._guest.view is None:
            self._none += 1
            if self._none == LOOKS_WITHOUT:
                self.query_one(LogView).write(text.NO_GAME, "dim")
        elif self._none < LOOKS_WITHOUT:
            self._none = 0
        if self._guest.view != self._view:
            self._view = self._guest.view
            await self._show_room()
        self._show_status()

    def _tell_log(self) -> None:
        news = self._log.news()
        if news is None:
            return
        log = self.query_one(LogView)
        if news.begun:
            log.write(game_words(news.game, news.activity))
        for moment in news.moments:
            kind = _kind(moment)
            for line in moment_lines(moment, news.replay.timed, news.activity, self._called):
                log.write(line, kind)
                kind = "text" if kind == "text" else "dim"
            if isinstance(moment.what, Done) and moment.what.said:
                for room in self.query(RoomView):
                    room.say(moment.what.said)
        if news.game.ended is not None:
            log.write(ending_words(news.game), "good" if news.game.smooth else "bad")

    async def _show_room(self) -> None:
        view = self._view
        if view is None:
            return
        people = tuple(view.scene.doing)
        if (view.activity, people) != self._shown:
            self._shown = view.activity, people
            await self._lay_out(view, people)
        for room in self.query(RoomView):
            room.show(view.scene)
            room.hold(view.phase in ALARMS)
            if view.pose is not None:
                room.track(Point(*view.pose), "", ())
        for board in self.query(CallBoard):
            board.show(view.scene.called)
        now = text.now_lines(view, self._activity, self._called)
        self.query_one("#called", Static).update(Content("\n".join(map(clean, now))))
        for staff in self.query(StaffPanel):
            lines = person_lines(view.people, self._called)
            staff.show(self._call(view), "", text.facts(view), lines)

    def _call(self, view: GameView) -> str:
        """Return the last call in short, "" if there is none."""
        called, activity = view.scene.called, self._activity
        return activity.deck.label(called[-1]).replace("-", "") if called and activity else ""

    async def _lay_out(self, view: GameView, people: tuple[str, ...]) -> None:
        """Create room and board again for the people and the activity of a game."""
        left = self.query_one("#left", Vertical)
        await left.remove_children(".panel")  # before the new panels get the same ids
        self._activity = self._log.activity(view.activity)
        room = room_of(view, self._log.folder)
        seated = room.placed([Person(one, self._called(one)) for one in people])
        label = str if self._activity is None else self._activity.deck.label
        cards = self._activity is None or bool(self._activity.deck.columns)
        view_of_room = RoomView(room, seated, label=label, cards=cards)
        left.mount(panel(view_of_room), before="#called")
        left.mount(panel(StaffPanel()))
        if self._activity is not None and self._activity.deck.columns:
            left.mount(panel(CallBoard(self._activity.deck)))

    def _show_status(self) -> None:
        view = self._view if self._there else None
        line = self.query_one(StatusLine)
        if view is None:
            line.show(Status(mode="watch"))
            return
        robot = text.robot_words(view)
        line.show(
            Status(
                mode="watch",
                robot=robot,
                stage=text.stage_words(view),
                game=view.number,
                note=text.world_and_driver(view),
                alarm=robot != "OK" and not robot.startswith(WAITS),
            )
        )


def _kind(moment: Moment) -> Kind:
    match moment.what:
        case Diagnosed(fault):
            return "bad" if fault.critical else "warn"
        case AnsweredRequest(complied=complied):
            return "good" if complied else "dim"
        case what:
            return KINDS.get(type(what), "text")
