"""Reads cards and identifies faces in the frames of a camera.

Each reading fuses several frames, all taken after the request: frames from before the robot arrived
show something else.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeVar

from tangy_hw.drivers.camera import Frame
from tangy_hw.drivers.camera_source import CameraError
from tangy_hw.perception.camera_hub import CameraHub
from tangy_hw.perception.cards.look import MOMENT, CardLook
from tangy_hw.perception.faces.face_votes import FRAMES, Vote, vote
from tangy_profiles.activity import Activity
from tangy_profiles.card_face import USUAL_SEED
from tangy_profiles.cards import Deck
from tangy_profiles.robot import FaceModels

if TYPE_CHECKING:
    from tangy_hw.perception.cards.reader import CardReader
    from tangy_hw.perception.faces.gallery import FaceMatch, Gallery
    from tangy_hw.perception.faces.reader import FaceReader

T = TypeVar("T")

MOST_PICTURES = 5  # of a card: another frame may show what a hand hides in one
SETTLE_SECONDS = 0.15  # after which a frame that was under way at the request has arrived
NOTHING_SEEN = "no picture came"


@dataclass(frozen=True, slots=True)
class CardSeen:
    """A reading of the card beside the robot.

    `card` is its number, None if it cannot be read, and `problem` says why; `marked` and `hidden`
    are masks of its cells; `state` is the user activity state; `pictures` is the number of frames
    read. `cards` are the numbers of all cards in sight: if there are several, none is read. `sure`
    says whether frames of two moments show this card.
    """

    card: int | None
    marked: int
    hidden: int
    state: str
    problem: str
    pictures: int
    cards: tuple[int, ...] = ()
    sure: bool = False

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON for the program."""
        return {name: getattr(self, name) for name in self.__slots__}


class CardAndFacePerception:
    """Cards and faces in the frames of one camera."""

    def __init__(
        self,
        sensors: CameraHub,
        activity: Activity,
        *,
        deck_seed: int = USUAL_SEED,
        faces: Mapping[str, Any] | None = None,
        models: FaceModels | None = None,
    ) -> None:
        """Prepare the readers.

        Args:
            sensors: the robot's cameras, one of which looks at cards.
            activity: the activity, with its deck and user activity states.
            deck_seed: seed that determines the numbers on the cards.
            faces: feature vectors of enrolled people (a row for each image), by id.
            models: the robot's model files for faces, if it has any.
        """
        self.sensors = sensors
        self._activity = activity
        self._deck_seed = deck_seed
        self._faces = dict(faces or {})
        self._models = models
        self._thread = ThreadPoolExecutor(1, "senses")
        self._reader: CardReader | None = None
        self._face_reader: FaceReader | None = None
        self._gallery: Gallery | None = None

    def close(self) -> None:
        """Close after the current reading."""
        self._thread.shutdown(wait=False, cancel_futures=True)

    async def prepare(self) -> None:
        """Load the models, so that the first reading takes no longer than later ones."""
        await self._in_thread(self._load)

    async def read_card(
        self,
        called: set[int],
        most: int = MOST_PICTURES,
        *,
        identify: bool = False,
        wins: tuple[tuple[str, ...], int] | None = None,
    ) -> CardSeen:
        """Read the card that the robot looks at, from as many frames as necessary.

        Args:
            called: the called numbers.
            most: maximum number of frames; reading ends as soon as the state is known.
            identify: require that two frames identify the card, whatever its state.
            wins: winning patterns, and how many of them are required together; None: the
                activity's.
        """
        look: CardLook | None = None
        async for frame in _fresh(self.sensors, most, apart=MOMENT):
            reader = await self._in_thread(self._card_reader)
            if look is None:
                reader.deck = self._deck(wins)
                look = CardLook(reader, self._activity.user_states, called, identify=identify)
            if look.is_another(frame.pixels, frame.stamp):
                look.add(await self._in_thread(reader.read, frame.image()))
            if look.is_over:
                break
        if look is None:
            return CardSeen(None, 0, 0, self._activity.unread, NOTHING_SEEN, 0)
        seen = look.reading
        return CardSeen(
            seen.card,
            seen.marked,
            seen.hidden,
            look.state,
            seen.problem,
            look.pictures,
            seen.cards,
            look.sure,
        )

    def _deck(self, wins: tuple[tuple[str, ...], int] | None) -> Deck:
        deck = self._activity.deck
        return deck if wins is None else replace(deck, patterns=wins[0], together=wins[1])

    async def who(self, most: int = 2 * FRAMES) -> Vote:
        """Identify the face before the robot by a vote over at most `most` frames."""
        matches: list[FaceMatch] = []
        async for frame in _fresh(self.sensors, most):
            match = await self._in_thread(self._match, frame)
            if match is not None:
                matches.append(match)
            if len(matches) == FRAMES:
                break
        return vote(matches)

    def _load(self) -> None:
        import cv2

        from tangy_hw.perception.cards.reader import CardReader
        from tangy_hw.perception.faces.gallery import Gallery
        from tangy_hw.perception.faces.reader import open_reader

        cv2.setNumThreads(1)
        if self._reader is None and self._activity.deck.numbers:
            self._reader = CardReader(self._activity.deck, self._deck_seed)
        if self._face_reader is None:
            self._face_reader = open_reader(self._models)
            self._gallery = Gallery(self._faces)

    def _card_reader(self) -> CardReader:
        self._load()
        assert self._reader is not None  # noqa: S101 - `_load` has set it
        return self._reader

    def _match(self, frame: Frame) -> FaceMatch | None:
        """Compare the largest face of sufficient quality in a frame, if there is one."""
        self._load()
        assert self._face_reader is not None and self._gallery is not None  # noqa: S101
        for face in self._face_reader.read(frame.image()):
            if face.vector is not None:
                return self._gallery.compare(face.vector)
        return None

    async def _in_thread(self, work: Callable[..., T], *args: Any) -> T:
        return await asyncio.get_running_loop().run_in_executor(self._thread, work, *args)


async def _fresh(sensors: CameraHub, most: int, apart: float = 0.0) -> AsyncIterator[Frame]:
    """Yield up to `most` frames taken from now on, until two timeouts.

    Each was taken at least `apart` s after the previous one.
    """
    after, seq = time.monotonic() + SETTLE_SECONDS, -1
    given = late = 0
    while given < most and late < 2 and sensors.card_device:
        try:
            frame = await sensors.frame(sensors.card_device, after=seq)
        except CameraError:
            return
        if frame is None:
            late += 1
            continue
        seq = frame.seq
        if frame.stamp >= after:
            given += 1
            after = frame.stamp + apart
            yield frame
