"""The open cameras of a robot: their states, their frames, and the last card read.

The robot's profile lists the cameras and their sources; a source on the command line overrides it.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from tangy_hw.drivers.camera import Camera, Frame
from tangy_hw.drivers.camera_source import CameraError, CameraSource, find_camera
from tangy_hw.drivers.camera_state import Sight
from tangy_profiles.card_face import USUAL_SEED, numbers_of
from tangy_profiles.cards import Deck
from tangy_profiles.health import Health
from tangy_profiles.reading import nearest, plain
from tangy_profiles.robot import DeviceProfile, Robot

if TYPE_CHECKING:
    from tangy_hw.perception.cards.reader import CardReader

LOG = "camera.log"  # in the data folder: messages of the drivers
READ_SECONDS = 0.5  # between two card readings, to use at most a tenth of a core
FRAME_SECONDS = 1.0  # timeout of a frame
CARDS = "cards"

Sources = Mapping[str, CameraSource]
"""Sources of a robot's cameras, by device name."""


def camera_sources(robot: Robot, given: Sequence[str] = ()) -> Sources:
    """Find the sources of a robot's cameras; files and folders are played in a loop.

    Args:
        robot: the robot's profile.
        given: DEVICE=SOURCE arguments of the command line, which override the profile.

    Raises:
        CameraError: a device does not exist, or a source is invalid.
    """
    named: dict[str, str] = {}
    for text in given:
        name, equals, source = text.partition("=")
        if not (equals and name and source):
            raise CameraError(plain(f"--camera {text}: write DEVICE=SOURCE, as in camera=0."))
        if name not in robot.devices:
            wrong = f"{robot.title} has no device {name!r}; {nearest(name, robot.devices)}"
            raise CameraError(plain(f"--camera {text}: {wrong}"))
        if name in named:
            raise CameraError(plain(f"--camera {text}: {name} was given a source already."))
        named[name] = source
    found: dict[str, CameraSource] = {}
    for device in robot.devices.values():
        if device.name in named:
            found[device.name] = find_camera(named[device.name], loop=True)
        elif device.source:
            found[device.name] = _of_profile(robot, device)
    return MappingProxyType(found)


def _of_profile(robot: Robot, device: DeviceProfile) -> CameraSource:
    source = device.source
    if "://" not in source and not source.isdecimal():
        source = str(robot.file.parent / source)
    try:
        return find_camera(source, loop=True)
    except CameraError as error:
        where = f"{robot.file.name}: devices[{device.name}].source"
        raise CameraError(plain(f"{where} = {device.source!r}: {error}")) from None


@dataclass(frozen=True, slots=True)
class SeenCard:
    """A card as read: its number, the numbers of its cells row by row, and masks of cells.

    `stamp` is of the monotonic clock, in s.
    """

    card: int
    numbers: tuple[int, ...]
    marked: int
    hidden: int
    free: int
    columns: int
    stamp: float

    @classmethod
    def of(
        cls, deck: Deck, card: int, marked: int, hidden: int, stamp: float, deck_seed: int
    ) -> SeenCard:
        """Return a reading (at a time in s) of a card of a deck, with the card's numbers."""
        numbers = numbers_of(deck, card, deck_seed)
        return cls(card, numbers, marked, hidden, deck.free, len(deck.columns), stamp)


@dataclass(frozen=True, slots=True)
class CardSight:
    """Latest readings of the camera that looks at cards.

    `last` is the last readable card. `problem` says why the newest frame shows none, "" if it does;
    that frame was taken at `stamp` (monotonic, s), None before the first.
    """

    last: SeenCard | None = None
    problem: str = ""
    stamp: float | None = None


class CameraHub:
    """The cameras of one robot, open while anybody is within its `async with`.

    `health` returns the readings for the diagnosis. Cards are read only within `reading_cards`.
    """

    def __init__(
        self,
        robot: Robot,
        sources: Sources,
        deck: Deck | None = None,
        *,
        deck_seed: int = USUAL_SEED,
        log: Path | None = None,
    ) -> None:
        """Prepare the cameras.

        Args:
            robot: the robot's profile.
            sources: sources of the cameras.
            deck: deck of the cards to read; None: no cards are read.
            deck_seed: seed that determines the numbers on the cards.
            log: file for messages of the drivers; None: they are dropped.
        """
        self.robot = robot
        self.streams = {
            name: Camera(source, device=name, log=log) for name, source in sources.items()
        }
        looking = (n for n in self.streams if robot.devices[n].looks_at == CARDS)
        self.card_device = next(looking, "") if deck is not None else ""
        """Device that looks at cards; "" if none does."""
        self._deck = deck
        self._deck_seed = deck_seed
        self._cards = CardSight()
        self._users = 0
        self._open = asyncio.Lock()
        self._readers = 0
        self._wanted = asyncio.Event()
        self._task: asyncio.Task[None] | None = None

    async def __aenter__(self) -> CameraHub:
        async with self._open:
            self._users += 1
            if self._users == 1:
                await self._start()
        return self

    async def __aexit__(self, *_: object) -> None:
        async with self._open:
            self._users = max(0, self._users - 1)
            if self._users == 0:
                await self._end()

    async def close(self) -> None:
        """Close everything, even while it is in use."""
        async with self._open:
            self._users = 0
            await self._end()

    @property
    def cameras(self) -> tuple[str, ...]:
        """Devices that are cameras with a source, in the order of the profile."""
        return tuple(self.streams)

    def source(self, device: str) -> str:
        """Return the source of a camera, as it was named."""
        return self.streams[device].name

    def sight(self, device: str) -> Sight:
        """Return the state of a camera and the evidence for it."""
        return self.streams[device].sight

    def health(self) -> Health:
        """Return the latest reading of each camera."""
        return tuple(camera.reading() for camera in self.streams.values())

    async def settled(self, seconds: float) -> None:
        """Wait until each camera has delivered a frame or failed, with a timeout in s."""
        with suppress(TimeoutError):
            async with asyncio.timeout(seconds):
                while any(c.sight.state == "OPENING" for c in self.streams.values()):  # noqa: ASYNC110
                    await asyncio.sleep(0.05)

    async def picture(self, device: str, fit: tuple[int, int], *, after: int = -1) -> Frame | None:
        """Return a camera's newest frame, scaled to fit into a width and height.

        Args:
            device: name of the camera.
            fit: size in pixels.
            after: return a frame with a higher number; None after a timeout of a second.
        """
        with suppress(CameraError):  # its state reports the error
            return await self.streams[device].frame(after=after, wait=FRAME_SECONDS, fit=fit)
        return None

    async def frame(self, device: str, *, after: int = -1) -> Frame | None:
        """Return a camera's newest frame, unscaled, with a higher number than `after`.

        None if no frame came within a second.

        Raises:
            CameraError: no more frames will come.
        """
        return await self.streams[device].frame(after=after, wait=FRAME_SECONDS)

    @contextmanager
    def reading_cards(self) -> Iterator[None]:
        """Read cards while the context is active."""
        self._readers += 1
        self._wanted.set()
        try:
            yield
        finally:
            self._readers -= 1
            if not self._readers:
                self._wanted.clear()

    @property
    def cards(self) -> CardSight:
        """Latest card readings."""
        return self._cards

    async def _start(self) -> None:
        self._cards = CardSight()
        for camera in self.streams.values():
            await camera.start()
        if self.card_device and self._deck is not None and self._deck.numbers:
            self._task = asyncio.create_task(self._read())

    async def _end(self) -> None:
        """Close everything; may be called again if it was interrupted."""
        task, self._task = self._task, None
        if task is not None:
            task.cancel()
            await asyncio.wait([task])
        await asyncio.gather(*(camera.close() for camera in self.streams.values()))

    async def _read(self) -> None:
        """Keep reading the card in the newest frame, on a thread."""
        camera, seq = self.streams[self.card_device], -1
        loop = asyncio.get_running_loop()
        reader: CardReader | None = None
        with ThreadPoolExecutor(1, "cards") as thread:  # exiting waits for the current reading
            while not camera.over:
                await self._wanted.wait()
                began = loop.time()
                with suppress(CameraError):
                    frame = await camera.frame(after=seq, wait=FRAME_SECONDS)
                    if frame is not None:
                        seq = frame.seq
                        if reader is None:
                            reader = await loop.run_in_executor(thread, self._reader)
                        self._cards = await loop.run_in_executor(thread, self._look, reader, frame)
                await asyncio.sleep(max(0.0, began + READ_SECONDS - loop.time()))

    def _reader(self) -> CardReader:
        import cv2

        from tangy_hw.perception.cards.reader import CardReader

        cv2.setNumThreads(1)
        with suppress(AttributeError):
            cv2.utils.logging.setLogLevel(0)  # its messages would go to the terminal
        assert self._deck is not None  # noqa: S101 - card_device is "" without a deck
        return CardReader(self._deck, self._deck_seed)

    def _look(self, reader: CardReader, frame: Frame) -> CardSight:
        """Read the card in a frame; called on the thread."""
        reading = reader.read(frame.image())
        if reading.card is None:
            return CardSight(self._cards.last, reading.problem, frame.stamp)
        marks = reading.marked, reading.hidden
        seen = SeenCard.of(reader.deck, reading.card, *marks, frame.stamp, self._deck_seed)
        return CardSight(seen, "", frame.stamp)


def sensors_of(
    robot: Robot,
    deck: Deck,
    folder: Path,
    given: Sequence[str] = (),
    *,
    deck_seed: int = USUAL_SEED,
) -> CameraHub:
    """Create the cameras of a robot, from its profile and the command line (see `camera_sources`).

    Raises:
        CameraError: a source is invalid.
    """
    sources = camera_sources(robot, given)
    return CameraHub(robot, sources, deck, deck_seed=deck_seed, log=folder / LOG)
