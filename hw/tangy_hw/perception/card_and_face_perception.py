"""Perception from pictures: the number of a card, its marks, and the identity of a face.

Several pictures are made one reading of, each taken after the question was put: a picture from
before the robot arrived tells nothing.
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

MOST_PICTURES = 5  # of a card: what a hand hides in one another may show
SETTLE_SECONDS = 0.15  # in which a picture that was under way when it was asked for has come
NOTHING_SEEN = "no picture came"


@dataclass(frozen=True, slots=True)
class CardSeen:
    """A reading of the card beside the robot.

    `card` is its number, None where it cannot be told, and `problem` says why; `marked` and
    `hidden` are masks of its cells; `state` is the user activity state; `pictures` is how many
    were looked at. `cards` are the numbers of all cards in sight: of several none is told. `sure`:
    pictures of two moments show this card.
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
        """Return it as the robot process tells it."""
        return {name: getattr(self, name) for name in self.__slots__}


class CardAndFacePerception:
    """Cards and faces in the pictures of one camera."""

    def __init__(
        self,
        sensors: CameraHub,
        activity: Activity,
        *,
        deck_seed: int = USUAL_SEED,
        faces: Mapping[str, Any] | None = None,
        models: FaceModels | None = None,
    ) -> None:
        """Prepare.

        Args:
            sensors: the robot's cameras, of which one looks at cards.
            activity: what is played; its deck and its user activity states.
            deck_seed: which numbers the cards have.
            faces: rows of features of the people who are known, by id.
            models: the robot's files for faces, if it has some.
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
        """Load what readers need, so that the first reading takes no longer than others."""
        await self._in_thread(self._load)

    async def read_card(
        self,
        called: set[int],
        most: int = MOST_PICTURES,
        *,
        identify: bool = False,
        wins: tuple[tuple[str, ...], int] | None = None,
    ) -> CardSeen:
        """Read the card that the robot looks at, from as many pictures as it takes.

        Args:
            called: the numbers that were called.
            most: pictures that are looked at; it ends as soon as the state is told.
            identify: two of them are to show which card it is, whatever its state is.
            wins: the shapes that win, and how many of them together, if not the activity's.
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
        """Identify the face before the robot by a vote over so many pictures."""
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
        assert self._reader is not None  # noqa: S101 - `_load` has seen to that
        return self._reader

    def _match(self, frame: Frame) -> FaceMatch | None:
        """Compare the largest face in a picture that is seen well enough, if there is one."""
        self._load()
        assert self._face_reader is not None and self._gallery is not None  # noqa: S101
        for face in self._face_reader.read(frame.image()):
            if face.vector is not None:
                return self._gallery.compare(face.vector)
        return None

    async def _in_thread(self, work: Callable[..., T], *args: Any) -> T:
        return await asyncio.get_running_loop().run_in_executor(self._thread, work, *args)


async def _fresh(sensors: CameraHub, most: int, apart: float = 0.0) -> AsyncIterator[Frame]:
    """Give pictures that were taken from now on, at most so many; none if none comes.

    Each was taken so many s `apart` from the one before.
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
