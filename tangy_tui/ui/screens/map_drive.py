"""Driving the robot by keys to draw a map, which grows on the screen."""

from __future__ import annotations

from math import inf
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, ClassVar

from textual.app import ComposeResult
from textual.binding import BindingType
from textual.content import Content
from textual.widgets import Static

from tangy_hw.device_protocols import Twist
from tangy_hw.navigation.map_drawing import map_lines
from tangy_tui.app.map_drive import SoFar, map_so_far
from tangy_tui.text import maps as text
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.hand_driving import DRIVE_KEYS, TELL_SECONDS, HandDriving
from tangy_tui.ui.keys import bind
from tangy_tui.ui.messages import Stop
from tangy_tui.ui.panels import KeyLine
from tangy_tui.ui.widgets.status_line import Status, StatusLine

if TYPE_CHECKING:
    from tangy_hw.robot_client.client import RobotLink
    from tangy_tui.ui.app import TangyApp

DRAWN_SECONDS = 2.0  # between two updates of the map
PAUSE = 3.0  # times what the last drawing took: the keys and the robot's heartbeat come first


class MapDriveScreen(HandDriving, TangyScreen[None]):
    """The map so far, and the driving keys. Enter ends the drive, ctrl+x stops the robot."""

    DEFAULT_CSS = """
    MapDriveScreen #map { height: 1fr; content-align: center middle; }
    MapDriveScreen #hazard { height: 2; padding: 0 1; }
    MapDriveScreen #so-far { height: 1; padding: 0 1; }
    """
    HELP = text.DRIVE_HELP
    BINDINGS: ClassVar[list[BindingType]] = [
        *DRIVE_KEYS,
        *bind("open", "done", name=text.DONE),
        *bind("back", "done", name=text.DONE, show=False),
        *bind("next", "go_on", name=text.GO_ON),
    ]

    app: TangyApp

    def __init__(self, link: RobotLink, record: Path, title: str) -> None:
        """Create the screen.

        Args:
            link: the link to the robot, which is on.
            record: the log that the robot writes.
            title: the robot's title.
        """
        HandDriving.__init__(self, link)
        TangyScreen.__init__(self)
        self._record, self._title = record, title
        self._so_far: SoFar | None = None
        self._drawn_next = 0.0
        self.done = False
        """Whether to draw the map from this drive."""

    def compose(self) -> ComposeResult:
        """Lay out the map, the amount recorded, and the keys."""
        yield StatusLine(Status(mode=text.DRIVE_MODE, robot=self._title))
        yield Static("", id="map", markup=False)
        yield Static(text.recorded_words(0, 0.0), id="so-far")
        yield Static(text.HOW_TO_DRIVE, id="hazard")
        yield KeyLine(("↑↓←→", text.DRIVES), "still", "open:draw the map", "stop", "help")

    def on_mount(self) -> None:
        """Poll the robot, and redraw the map from time to time."""
        self.set_interval(TELL_SECONDS, self._watch)
        self.set_interval(DRAWN_SECONDS, self._look)

    def _watch(self) -> None:
        """Send a heartbeat to the robot, and show why it stands still."""
        self.link.alive()
        stopped = self.link.state.stopped
        self.query_one(StatusLine).show(
            Status(
                mode=text.DRIVE_MODE,
                robot=text.STOPPED if stopped else self._title,
                alarm=bool(stopped),
            )
        )
        if not stopped:
            self.tell_held()

    def _look(self) -> None:
        if monotonic() >= self._drawn_next:
            self._drawn_next = inf  # until this drawing has ended
            self.run_worker(self._draw, thread=True, group="map")

    def _draw(self) -> None:
        """Draw the map so far, in a thread: reading a long record takes seconds."""
        begun = monotonic()
        found = map_so_far(self._record)
        ended = monotonic()
        self._drawn_next = ended + PAUSE * (ended - begun)
        if found is not None:
            self.app.call_from_thread(self._show, found)

    def _show(self, found: SoFar) -> None:
        self._so_far = found
        picture = self.query_one("#map", Static)
        columns, rows = picture.size
        lines = map_lines(
            found.map,
            max(1, columns),
            max(1, rows),
            robot=self.link.state.pose[:2],
            ascii_only=self.app.kind.ascii,
        )
        width = max(map(len, lines), default=0)
        picture.update(Content("\n".join(line.ljust(width) for line in lines)))
        self.query_one("#so-far", Static).update(text.recorded_words(found.scans, found.metres))

    def show_words(self, words: str) -> None:
        """Show the words below the map."""
        self.query_one("#hazard", Static).update(Content(words))

    def on_stop(self, message: Stop) -> None:
        """Stop the robot first, then redraw."""
        self.link.stop(message.reason)
        self.show_words(text.STOPPED_HERE)

    def action_go_on(self) -> None:
        """Release a stop."""
        self.link.release()
        self.show_words("")

    def action_done(self) -> None:
        """Ask whether the drive is over, with the robot stopped."""
        self.drive(Twist())
        self.run_worker(self._ask_done(), group="done", exclusive=True)

    async def _ask_done(self) -> None:
        if self._so_far is None:
            asked = ConfirmDialog(text.NOTHING_YET, yes=text.LEAVE, no=text.DRIVE_ON)
        else:
            asked = ConfirmDialog(text.OVER, text.OVER_DETAIL, yes=text.DONE, no=text.DRIVE_ON)
        if await self.app.push_screen_wait(asked):
            self.done = self._so_far is not None
            self.app.leave()
