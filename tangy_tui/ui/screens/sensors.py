"""The sensors screen: the state of every device, a camera's picture, and the last card read."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, ClassVar

from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Container
from textual.message import Message
from textual.widget import Widget

from tangy_profiles.health import Health
from tangy_tui.app.workspace import Workspace
from tangy_tui.text import sensors as text
from tangy_tui.text.keys import with_keys
from tangy_tui.text.sensors import (
    Clock,
    DeviceSummaries,
    DeviceSummary,
    Sensing,
    age_words,
    card_words,
    rate_words,
    remark,
)
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.keys import bind, keymap_of
from tangy_tui.ui.panels import LOW, WIDE, key_line, panel
from tangy_tui.ui.widgets.block_picture import BlockPicture
from tangy_tui.ui.widgets.card_lines import SEEN_LEGEND, seen_card_lines
from tangy_tui.ui.widgets.choice_list import ChoiceLine, ChoiceList
from tangy_tui.ui.widgets.page import Page, PageLine, paragraph
from tangy_tui.ui.widgets.rows import Row, fit, shorten
from tangy_tui.ui.widgets.status_line import Status, StatusLine

if TYPE_CHECKING:
    from tangy_hw.perception.camera_hub import CardSight

LOOK_SECONDS = 0.25
"""The interval between two updates of devices and picture."""

TINY_OR_WIDE = [(0, "-tiny"), (77, "-narrow"), WIDE[-1]]
"""Below this width in cells, devices and picture are not shown side by side."""

Shown = Callable[[], Status]


class DeviceList(ChoiceList):
    """The devices; posts `Chosen` on Enter."""

    class Chosen(Message):
        """The device at the cursor was chosen."""

    def _tell(self, index: int) -> None:
        self.post_message(self.Chosen())


class SensorsScreen(TangyScreen[None]):
    """The devices of a robot, the picture of the chosen camera, and the card it read.

    The cameras stay open while the screen is open.
    """

    CSS_PATH = "sensors.tcss"
    HORIZONTAL_BREAKPOINTS = TINY_OR_WIDE
    VERTICAL_BREAKPOINTS = LOW
    TITLE = "Sensors"
    HELP = (
        "Every device of the robot, how it is in a word, and how old its newest data is. A ~ "
        "stands before one that is simulated: what it says comes from the game, and from no "
        "sensor. {camera}, or Enter on a camera, "
        "shows what it sees, and hides it again; nothing of it is kept. Below that is the last "
        "card as it was read: what could not be seen of it is hatched, and never guessed. tab "
        "goes to the picture, and {zoom} enlarges it. A camera that was unplugged is opened again "
        "by itself."
    )
    BINDINGS: ClassVar[list[BindingType]] = [
        *bind("camera", "picture"),
        *bind("back", "leave"),
    ]

    def __init__(
        self,
        workspace: Workspace,
        sensors: Sensing | None = None,
        *,
        health: Callable[[], Health] = tuple,
        shown: Shown | None = None,
        live: bool = False,
        where: str = "",
        clock: Clock = time.monotonic,
    ) -> None:
        """Create the screen.

        Args:
            workspace: the workspace with the robot.
            sensors: its cameras, opened and closed with the screen.
            health: returns the readings of a game's devices.
            shown: returns the status of that game.
            live: whether those devices are real.
            where: a note on the robot, in a few words.
            clock: returns s, for the time that a device has been in its state.
        """
        super().__init__()
        self._workspace = workspace
        self._sensors = sensors
        self._summaries = DeviceSummaries(workspace.robot, sensors, health, clock, live=live)
        self._no_source = text.no_source_words("live" if live else "sensors")
        self._where = where
        self._shown = shown
        self.told: dict[str, DeviceSummary] = {}
        self._frames: dict[Widget, tuple[str | None, str | None]] = {}
        self._seen = False
        """Whether a picture is shown."""

    def compose(self) -> ComposeResult:
        """Lay out the devices, details of one, its picture and the card."""
        yield StatusLine(self._status())
        with Container(id="body"):
            with Container(id="left"):
                yield panel(DeviceList("Devices", text.DEVICES_HELP, id="devices"))
                yield panel(Page(id="about"))
            with Container(id="right"):
                yield panel(BlockPicture("Picture", text.PICTURE_HELP, id="picture"))
                yield panel(Page(id="card"), "Last card")
        yield key_line(("up down", "choose"), "camera", "panel", "zoom", "back", "help")

    def on_mount(self) -> None:
        """Open the cameras, and poll all devices."""
        self._devices.focus()
        self.look()
        cameras = self._cameras
        if cameras:
            self._devices.show(self._device_lines, cameras[0])
            self._tell_of_chosen()
            self.run_worker(self._keep_open(), group="cameras")
        self.set_interval(LOOK_SECONDS, self.look)

    def on_choice_list_moved(self, event: ChoiceList.Moved) -> None:
        """Show another device, with its picture if wanted."""
        event.stop()
        self._tell_of_chosen()
        self._watch()

    def on_device_list_chosen(self, event: DeviceList.Chosen) -> None:
        """Show or hide the picture of the camera chosen with Enter."""
        event.stop()
        if self._chosen in self._cameras:
            self.action_picture()

    def action_picture(self) -> None:
        """Show or hide the picture of the chosen camera."""
        self._seen = not self._seen
        if self._seen and self._chosen not in self._cameras:
            self._seen = False
            if self._cameras:
                self._devices.show(self._device_lines, self._cameras[0])
                self._seen = True
        self.set_class(self._seen, "-seen")
        if not self._seen:
            self._devices.focus()
        self._tell_of_chosen()
        self._watch()

    def action_leave(self) -> None:
        """Restore a maximised panel, or close the screen."""
        if self.maximized is not None:
            self.minimize()
        else:
            self.leave(None)

    # ------------------------------------------------------------------------------ cameras

    @property
    def _cameras(self) -> tuple[str, ...]:
        return () if self._sensors is None else self._sensors.cameras

    async def _keep_open(self) -> None:
        """Keep the cameras open and read cards while the screen is open."""
        assert self._sensors is not None  # noqa: S101 - there are cameras
        async with self._sensors:
            with self._sensors.reading_cards():
                await asyncio.Event().wait()

    def _watch(self) -> None:
        """Request pictures of the chosen camera only if they are shown."""
        if self._seen and self._chosen in self._cameras:
            self.run_worker(self._draw(self._chosen), group="picture", exclusive=True)
        else:
            self.workers.cancel_group(self, "picture")

    async def _draw(self, device: str) -> None:
        """Draw a camera's pictures as they arrive."""
        assert self._sensors is not None  # noqa: S101 - there are cameras
        await asyncio.to_thread(__import__, "numpy")
        picture, loop = self.query_one(BlockPicture), asyncio.get_running_loop()
        seq, size = -1, picture.fit
        picture.say(text.PICTURE_COMES)
        while True:
            began = loop.time()
            if self.is_active and picture.is_on_screen:
                if picture.fit != size:
                    seq, size = -1, picture.fit
                frame = await self._sensors.picture(device, size, after=seq)
                if frame is not None:
                    seq = frame.seq
                    picture.show(frame)
            await asyncio.sleep(max(0.02, began + LOOK_SECONDS - loop.time()))

    # ------------------------------------------------------------------------------ telling

    @property
    def _devices(self) -> ChoiceList:
        return self.query_one("#devices", ChoiceList)

    @property
    def _chosen(self) -> str:
        """The device at the cursor."""
        return str(self._devices.chosen)

    def _status(self) -> Status:
        if self._shown is not None:
            return self._shown()
        return Status(mode="sensors", note=self._workspace.robot.title)

    def look(self) -> None:
        """Update all devices, if the screen is visible."""
        if self.told and not self.is_active:
            return
        self.told = {told.device.name: told for told in self._summaries.current()}
        self.query_one(StatusLine).show(self._status())
        devices = self._devices
        devices.show(self._device_lines)
        simulated = any(told.code and not told.live for told in self.told.values())
        self._frame(devices, below="~ simulated" if simulated else self._where)
        self._tell_of_chosen()
        self._tell_of_card()

    def _device_lines(self, width: int, height: int) -> list[ChoiceLine]:
        return [ChoiceLine(device_row(told, width), name) for name, told in self.told.items()]

    def _tell_of_chosen(self) -> None:
        told = self.told.get(self._chosen)
        if told is None:
            return
        about = self.query_one("#about", Page)
        self._frame(about, above=told.device.label)
        about.show(lambda width: about_lines(told, width), None)
        picture = self.query_one(BlockPicture)
        below = ""
        if not self._cameras:
            picture.say(self._no_source)
        elif told.device.name not in self._cameras:
            picture.say(text.no_pictures_words(told.device.label))
        elif not self._seen:
            words = text.look_words(told.device.label)
            picture.say(with_keys(words, keymap_of(self.app)))
        elif picture.there:
            below = "live" if told.well else f"{told.state}, {age_words(told.age)} old"
        self._frame(picture, below=below)

    def _frame(self, widget: Widget, *, above: str | None = None, below: str | None = None) -> None:
        """Set title and subtitle of a frame; unchanged ones would redraw the panel."""
        title, subtitle = self._frames.get(widget, (None, None))
        above, below = title if above is None else above, subtitle if below is None else below
        self._frames[widget] = above, below
        if above is not None and above != title:
            widget.border_title = clean(above).replace("[", "\\[")
        if below is not None and below != subtitle:
            widget.border_subtitle = clean(below).replace("[", "\\[")

    def _tell_of_card(self) -> None:
        sensors, page = self._sensors, self.query_one("#card", Page)
        if sensors is None or not sensors.card_device:
            words = text.NO_CARD_CAMERA
            page.show(lambda width: paragraph(words, width, "dim"), None)
            return
        cards = sensors.cards
        letters = [column.letter for column in self._workspace.activity.deck.columns]
        page.show(lambda width: card_page(cards, letters, width), None)


def device_row(told: DeviceSummary, width: int) -> Row:
    """Format a device: mark, state, age of its data, and the reason if there is room."""
    label = min(20, max(10, width - 24))
    ink = state_ink(told)
    mark = "  " if told.well or not told.code else "!!" if told.bad else "! "
    simulated = "~" if told.code and not told.live else " "
    left = width - label - 26
    return (
        (mark, ink),
        (simulated, "dim"),
        (fit(clean(told.device.label), label), "text" if told.code else "dim"),
        (f" {fit(told.state, 14)}", ink),
        (f"{age_words(told.age):>6}", "dim"),
        (f"  {shorten(clean(remark(told)), left)}" if left > 12 else "", "dim"),
    )


def state_ink(told: DeviceSummary) -> str:
    """Return the ink of a state, whose word tells the same."""
    if not told.code or told.code in ("OPENING", "ENDED"):
        return "dim"
    return "good" if told.well else "bad" if told.bad else "warn"


def about_lines(told: DeviceSummary, width: int) -> list[PageLine]:
    """Describe a device: state, reason, duration, and measurements."""
    since = f" for {age_words(told.seconds)}" if told.seconds is not None and told.code else ""
    kind = "" if told.live or not told.code else " (simulated)"
    lines = [PageLine(((f"{told.state}{since}{kind}", state_ink(told)),))]
    if told.why:
        lines += paragraph(clean(told.why), width)
    if told.age is not None:
        wanted = f" (at most {told.device.stale_after:g} s)"
        lines.append(PageLine(((f"newest data {age_words(told.age)} old{wanted}", "dim"),)))
        if rate := rate_words(told):
            lines.append(PageLine(((f"new data at {rate}", "dim"),)))
    for fact in told.facts:
        lines += paragraph(clean(fact), width, "dim")
    if told.source:
        lines += paragraph(f"from {clean(told.source)}", width, "dim")
    return lines


def card_page(cards: CardSight, letters: list[str], width: int) -> list[PageLine]:
    """Describe the last card read, its time, and why none is read now."""
    read, problem = card_words(cards)
    lines = paragraph(read, width)
    if problem:
        lines += paragraph(problem, width, "warn")
    if cards.last is not None:
        lines += [PageLine(row) for row in seen_card_lines(cards.last, letters)]
        lines.append(PageLine(SEEN_LEGEND))
    return lines
