"""The demo on one screen: caption, room, events, and the teacher's command."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import Any, ClassVar

from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical, VerticalScroll
from textual.content import Content
from textual.widgets import Static

from tangy_tui.app.workspace import Workspace
from tangy_tui.console.story import Story, StoryFrame
from tangy_tui.text import demo as text
from tangy_tui.ui.base import TangyScreen, on_top
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.keys import bind
from tangy_tui.ui.panels import LOW, WIDE, KeyLine, panel, room_panel
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.status_line import Status, StatusLine

LONGEST_DRIVE = 1.5
"""The longest animation of the robot, in s."""

READ = (text.LEARNT, text.WHY, text.BELIEVES)
"""Headings of panels to read rather than watch: at 80 columns they replace the room."""

KEYS = (
    f"still:{text.HOLD}", f"left:{text.EARLIER}", f"right:{text.LATER}", "back:leave", "help",
)  # fmt: skip


class DemoScreen(TangyScreen[None]):
    """Plays the frames of a story at reading pace; the user can pause and step through them."""

    CSS_PATH = "demo.tcss"
    HORIZONTAL_BREAKPOINTS = WIDE
    VERTICAL_BREAKPOINTS = LOW
    AUTO_FOCUS = ""
    HELP = text.HELP
    BINDINGS: ClassVar[list[BindingType]] = [
        *bind("still", "hold", name=text.HOLD.capitalize()),
        *bind("left", "go(-1)", name=text.EARLIER.capitalize()),
        *bind("right", "go(1)", name=text.LATER.capitalize()),
        *bind("back", "leave"),
    ]

    def __init__(self, workspace: Workspace, story: Story, *, pace: float = 1.0) -> None:
        """Create the screen; `pace` is the ratio of its speed to reading pace."""
        super().__init__()
        self._workspace = workspace
        self._story = story.frames()
        self._pace = pace
        self.frames: list[StoryFrame] = []
        """The frames so far."""
        self.at = -1
        """The index of the frame shown."""
        self.held = False
        self.ended = False
        """Whether the story has ended."""
        self._making = asyncio.Lock()
        self._nudge = asyncio.Event()

    def compose(self) -> ComposeResult:
        """Lay out the caption above room and lines, with the teacher's command below."""
        yield StatusLine(Status(mode="demo"))
        yield panel(Static(id="caption", markup=False))
        with Horizontal(id="body"):
            with Vertical(id="left"):
                yield room_panel(self._workspace)
            with panel(VerticalScroll(id="told", can_focus=False)):
                yield Static(id="lines", markup=False)
        yield Static(id="typed", markup=False)
        yield KeyLine(*KEYS)

    def on_mount(self) -> None:
        """Start the story."""
        self.run_worker(self._tell(), name="story")

    async def _tell(self) -> None:
        """Show one frame after the other, each for its reading time."""
        while await self._make(self.at + 1):
            await on_top(self)
            if self.at + 1 < len(self.frames) and not self.held:
                self._show(self.at + 1)
            self._nudge.clear()
            if self.held:
                await self._nudge.wait()
                continue
            making = asyncio.create_task(self._make(self.at + 1))
            with suppress(TimeoutError):
                await asyncio.wait_for(
                    self._nudge.wait(), self.frames[self.at].seconds / self._pace
                )
            await making
        self._status()

    async def _make(self, number: int) -> bool:
        """Generate frames up to a number, in a thread; False: the story has ended before it."""
        async with self._making:
            while number >= len(self.frames) and not self.ended:
                frame = await asyncio.to_thread(next, self._story, None)
                if frame is None:
                    self.ended = True
                else:
                    self.frames.append(frame)
        return number < len(self.frames)

    async def rest(self) -> None:
        """Wait until no frame is being generated, so that the data folder can be deleted."""
        async with self._making:
            self.ended = True

    # ---------------------------------------------------------------------------------- keys

    def action_hold(self) -> None:
        """Pause or resume the story."""
        self.held = not self.held
        self._nudge.set()
        self._status()

    async def action_go(self, by: int) -> None:
        """Go to the previous or the next caption."""
        if not self.frames:
            return
        if by < 0:
            self._show(self._beginning(max(0, self._beginning(self.at) - 1)))
        else:
            at = self.at
            while await self._make(at + 1):
                at += 1
                if self._beginning(at) > self.at:
                    break
            self._show(at)
        self._nudge.set()

    def _beginning(self, at: int) -> int:
        """Return the first frame with the caption of a frame."""
        while at and self.frames[at - 1].caption == self.frames[at].caption:
            at -= 1
        return at

    def action_leave(self) -> None:
        """Leave the demo."""
        self.close(None)

    # --------------------------------------------------------------------------------- frame

    def _show(self, at: int) -> None:
        before = self.frames[self.at] if 0 <= self.at < len(self.frames) else None
        forward = at == self.at + 1
        self.at, frame = at, self.frames[at]
        caption = self.query_one("#caption", Static)
        caption.border_title = Content(text.scene_words(frame.scene))
        caption.update(frame.caption)
        self._room(frame, before if forward else None)
        self.set_class(frame.heading in READ, "-read")
        told = self.query_one("#told", VerticalScroll)
        told.border_title = Content(frame.heading)
        self.query_one("#lines", Static).update("\n".join(map(clean, frame.lines)))
        self.call_after_refresh(
            told.scroll_home if frame.heading in READ else told.scroll_end, animate=False
        )
        self.query_one("#typed", Static).update(_typed(frame))
        self._status()

    def _room(self, frame: StoryFrame, before: StoryFrame | None) -> None:
        room = self.query_one(RoomView)
        if before is not None and before.room.place != frame.room.place:
            room.drive(frame.room.place, min(LONGEST_DRIVE, frame.seconds / 2))
        elif before is None:
            room.put(frame.room.place)
        room.show(frame.room)
        room.say(frame.said)

    def _status(self) -> None:
        if not self.frames:
            return
        frame = self.frames[self.at]
        over = self.ended and self.at == len(self.frames) - 1
        note = text.ENDED if over else text.HELD if self.held else ""
        where = text.scene_note(frame.scene)
        self.query_one(StatusLine).show(
            Status(mode="demo", note=" │ ".join(filter(None, (where, note))))
        )


def _typed(frame: StoryFrame) -> Content:
    """Format the teacher's command, or the question that replaces it."""
    if not frame.asked:
        return (
            Content.assemble("\n", ("> ", "$accent bold"), frame.typed)
            if frame.typed
            else Content("")
        )
    parts: list[Any] = [(clean(text.ASKS.format(frame.asked)), "$accent bold"), "\n"]
    for key, words in text.YES_KEYS:
        parts += [(key, "$primary bold"), f" {words}   "]
    return Content.assemble(*parts)
