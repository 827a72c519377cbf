"""Words for the state of the robot's devices, on the screen and in the console."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import AbstractAsyncContextManager, AbstractContextManager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from tangy_profiles.health import ERROR, OK, STALE, WARN, Fact, Health, Reading, state_of
from tangy_tui.monitoring.evidence import STATES

if TYPE_CHECKING:
    from tangy_hw.drivers.camera import Frame
    from tangy_hw.drivers.camera_state import Sight
    from tangy_hw.perception.camera_hub import CardSight
    from tangy_profiles.robot import DeviceProfile, Robot

CAMERA_STATES = {
    "OPENING": "no picture yet",
    "OK": STATES[OK],
    "DISCONNECTED": "disconnected",
    "FROZEN": "frozen",
    "COVERED": "covered",
    "DARK": "too dark",
    "BLURRED": "blurred",
    "ENDED": "at its end",
}
"""Words for the states of a camera."""

NOW_SECONDS = 3.0  # for which the last look at a card counts as current
SIMULATED = "simulated"
ABSENT = "not there"
BAD = ("DISCONNECTED", "FROZEN", STALE, ERROR)
WELL = ("OK", OK)

Clock = Callable[[], float]


class Sensing(AbstractAsyncContextManager[Any, Any], Protocol):
    """The cameras of a robot for a screen: opened by this process, or by the robot process.

    They are open within `async with`, and cards are read within `reading_cards`.
    """

    @property
    def cameras(self) -> tuple[str, ...]:
        """The cameras that have a source, in the order of the profile."""
        ...

    @property
    def card_device(self) -> str:
        """The device that looks at cards, "" if there is none."""
        ...

    @property
    def cards(self) -> CardSight:
        """The latest card readings."""
        ...

    def source(self, device: str) -> str:
        """Return the source of a device's data, as configured."""
        ...

    def sight(self, device: str) -> Sight:
        """Return the state of a camera and the evidence for it."""
        ...

    async def picture(self, device: str, fit: tuple[int, int], *, after: int = -1) -> Frame | None:
        """Return a camera's newest picture, scaled to fit; None if it is not newer than `after`."""
        ...

    def reading_cards(self) -> AbstractContextManager[None]:
        """Read cards inside the context."""
        ...


@dataclass(frozen=True, slots=True)
class DeviceSummary:
    """A device as shown to people: its state, since when (s; None: unknown), and why.

    `code` is the state that the device reports, "" if unknown; `age` is that of its newest data, in
    s, and `rate` its rate in Hz (None: not measured); `facts` are its measurements in words.
    """

    device: DeviceProfile
    code: str
    state: str
    why: str = ""
    age: float | None = None
    seconds: float | None = None
    source: str = ""
    facts: tuple[str, ...] = ()
    live: bool = False
    """Whether it is a real device."""
    rate: float | None = None

    @property
    def well(self) -> bool:
        """Whether it works."""
        return self.code in WELL

    @property
    def bad(self) -> bool:
        """Whether the device gives no information."""
        return self.code in BAD


class DeviceSummaries:
    """Describes the devices of a robot, real and simulated."""

    def __init__(
        self,
        robot: Robot,
        sensors: Sensing | None = None,
        health: Callable[[], Health] = tuple,
        clock: Clock = time.monotonic,
        *,
        live: bool = False,
    ) -> None:
        """Describe a robot's devices.

        Args:
            robot: the robot with the devices.
            sensors: its real cameras, if there are any.
            health: returns the readings of a game's devices; empty if there is no game.
            clock: returns s, to measure how long other devices have been in their state.
            live: the readings come from a real robot; devices without one are absent.
        """
        self._robot = robot
        self._sensors = sensors
        self._health = health
        self._clock = clock
        self._live = live
        self._since: dict[str, tuple[str, float]] = {}

    def current(self) -> list[DeviceSummary]:
        """Describe every device, in the order of the profile."""
        readings = {reading.device: reading for reading in self._health()}
        sensors = self._sensors
        cameras = () if sensors is None else sensors.cameras
        return [
            _camera(device, sensors.sight(device.name), sensors.source(device.name))
            if sensors is not None and device.name in cameras
            else self._other(device, readings.get(device.name))
            for device in self._robot.devices.values()
        ]

    def _other(self, device: DeviceProfile, reading: Reading | None) -> DeviceSummary:
        if reading is None:
            self._since.pop(device.name, None)
            if self._live:
                return DeviceSummary(device, "", ABSENT, "No driver in the robot file.")
            return DeviceSummary(device, "", SIMULATED, "No data until a game runs.")
        code, now = state_of(device, reading), self._clock()
        before, since = self._since.get(device.name, ("", now))
        if code != before:
            since = now
            self._since[device.name] = code, since
        why = ""
        if code == STALE:
            why = f"Its data is too old: at most {device.stale_after:g} s are allowed."
        elif code == ERROR:
            why = "It reports a failure."
        elif code == WARN:
            why = "It warns of something."
        return DeviceSummary(
            device,
            code,
            STATES[code],
            why,
            reading.age,
            now - since,
            self._sensors.source(device.name) if self._live and self._sensors else "",
            _facts(device, dict(reading.facts)),
            self._live,
            reading.rate,
        )


def _camera(device: DeviceProfile, sight: Sight, source: str) -> DeviceSummary:
    facts: dict[str, Fact] = dict(sight.reading(device.name).facts)
    told = _facts(device, facts)
    if sight.sharpness is not None:
        told += (f"sharpness (0 to 1): {sight.sharpness:.2f}",)
    return DeviceSummary(
        device,
        sight.state,
        CAMERA_STATES[sight.state],
        sight.why,
        sight.age,
        sight.seconds,
        source,
        told,
        live=True,
        rate=None if sight.state in ("DISCONNECTED", "ENDED") else sight.rate,
    )


def _facts(device: DeviceProfile, facts: dict[str, Fact]) -> tuple[str, ...]:
    """Describe a device's measurements, in the words of its profile."""
    return tuple(
        f"{device.facts[name].says}: {_value(value)}"
        for name, value in facts.items()
        if name in device.facts
    )


def _value(value: Fact) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return value if isinstance(value, str) else f"{value:.2f}"


def age_words(seconds: float | None) -> str:
    """Format an age (in s) in a few characters that do not flicker."""
    if seconds is None:
        return ""
    if seconds < 10:
        return f"{max(0.1, seconds):.1f} s"
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.0f} h"


def rate_words(told: DeviceSummary) -> str:
    """Format the rate of a device's data in Hz, "" if not measured."""
    if told.rate is None:
        return ""
    return f"{told.rate:.0f} Hz" if told.rate >= 9.5 else f"{told.rate:.1f} Hz"


def remark(told: DeviceSummary) -> str:
    """Return a remark beside the age: the rate, and the problem."""
    return "  ".join(filter(None, (rate_words(told), told.why)))


def card_words(cards: CardSight) -> tuple[str, str]:
    """Tell which card was read and when, and why none is read now ("" if one is)."""
    now = time.monotonic()
    last = cards.last
    problem = ""
    if cards.problem:
        ago = 0.0 if cards.stamp is None else now - cards.stamp
        when = "Now" if ago < NOW_SECONDS else f"{age_words(ago)} ago"
        problem = f"{when}: {cards.problem}."
    if last is None:
        return "No card was read yet.", problem
    hidden = f", {last.hidden.bit_count()} of its numbers hidden" if last.hidden else ""
    words = f"Card {last.card}{hidden}, read {age_words(now - last.stamp)} ago."
    return words, problem


def sensor_line(told: DeviceSummary, width: int) -> str:
    """Format a device as one line, its name padded to a width."""
    if not told.code:
        return f"{told.device.label:<{width}}  {told.state}"
    state = told.state if told.live else f"{told.state} ({SIMULATED})"
    line = f"{told.device.label:<{width}}  {state:<14}  {age_words(told.age):>6}  {remark(told)}"
    return line.rstrip()


def sensor_document(told: DeviceSummary) -> dict[str, Any]:
    """Return a device as its JSON document."""
    return {
        "device": told.device.name,
        "label": told.device.label,
        "source": told.source or None,
        "simulated": not told.live,
        "state": told.code or None,
        "why": told.why,
        "age": None if told.age is None else round(told.age, 3),
        "rate": None if told.rate is None else round(told.rate, 1),
        "seconds": None if told.seconds is None else round(told.seconds, 3),
        "works": told.well if told.live else None,
        "facts": list(told.facts),
    }


def card_document(cards: CardSight) -> dict[str, Any]:
    """Return the last card that was read as JSON data."""
    last = cards.last
    document: dict[str, Any] = {"card": None, "problem": cards.problem}
    if last is None:
        return document

    def places(mask: int) -> list[list[int]]:
        cells = range(len(last.numbers))
        return [list(divmod(cell, last.columns)) for cell in cells if mask >> cell & 1]

    age = round(max(0.0, time.monotonic() - last.stamp), 3)
    marked, hidden = places(last.marked), places(last.hidden)
    return {**document, "card": last.card, "marked": marked, "hidden": hidden, "age": age}


DEVICES_HELP = (
    "Each device with a word for its state: a ! where something is wrong with it, !! where "
    "it tells Tangy nothing, and a ~ where it is simulated. Up and down choose one."
)
PICTURE_HELP = "What the chosen camera sees now, in small. Nothing of it is kept."
PICTURE_COMES = "The first picture is coming ..."
NO_CARD_CAMERA = "No camera looks at cards."


def no_source_words(verb: str) -> str:
    """Tell that no camera is named, and how a command names one."""
    return (
        f"No camera is named. Name one when you start Tangy, as in: tangy {verb} --camera "
        "camera=0; or write its source into the robot's file."
    )


def no_pictures_words(label: str) -> str:
    """Tell that a device is no camera."""
    return f"The {label} takes no pictures."


def look_words(label: str) -> str:
    """Tell which key shows a camera's picture."""
    return f"{{camera}} shows what the {label} sees."
