"""Requests by signs: people turn up a triangle that shines in the image of an infrared camera.

The camera sees the whole table from a fixed place. The four corners of the table in its image
determine at which seat a sign stands.
"""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import Sequence
from dataclasses import replace
from math import hypot
from typing import TYPE_CHECKING

from tangy_hw.drivers.camera import Camera
from tangy_hw.drivers.camera_source import CameraError, CameraSource
from tangy_hw.drivers.camera_state import USUAL as USUAL_CAMERA
from tangy_hw.perception.requests.answer_signs import AnswerPersistence
from tangy_hw.perception.requests.help_request_source import DEVICE, RequestError, RequestSource
from tangy_hw.perception.requests.triangles import USUAL, TriangleLimits, find_triangles
from tangy_profiles.health import OK, STALE, Reading
from tangy_profiles.room import Point, Room

if TYPE_CHECKING:
    from tangy_hw.drivers.camera_look import Image

Corners = tuple[tuple[float, float], tuple[float, float], tuple[float, float], tuple[float, float]]

OF, BEGINS, ENDS = 5, 3, 1
"""A sign is up if three of the last five frames show it, and down again at one."""

FAR = 0.9  # metres between a sign and its place at a seat
EDGE = 0.25  # metres beyond the table's edge that a sign may seem to stand
PAUSE = 0.1  # s between two processed frames

# An infrared image is dark and often empty: neither is a fault of the camera.
INFRARED = replace(USUAL_CAMERA, dark=0.0, flat=0.0, blurred=0.0)


class TableView:
    """Maps pixels of a fixed camera to seats."""

    def __init__(self, corners: Corners, room: Room, seats: int) -> None:
        """Compute the mapping from the table's corners.

        Args:
            corners: corners of the table in pixels: left near, right near, right far, left far in
                the room; near is the robot's side.
            room: the room, with table and seats.
            seats: number of people.

        Raises:
            RequestError: the corners do not form a table.
        """
        left, near, right, far = room.table
        self._table = room.table
        self._matrix = _homography(
            corners, ((left, near), (right, near), (right, far), (left, far))
        )
        self._places = [
            Point(min(max(seat.x, left), right), min(max(seat.y, near), far))
            for seat in room.seated(seats)
        ]

    def place(self, x: float, y: float) -> Point | None:
        """Return the place on the table, in m, at a pixel; None beyond its horizon."""
        a, b, c = (row[0] * x + row[1] * y + row[2] for row in self._matrix)
        return Point(a / c, b / c) if c > 1e-9 else None

    def seat(self, x: float, y: float) -> int:
        """Return the seat (from 1) of a sign at this px, or 0."""
        place = self.place(x, y)
        left, near, right, far = self._table
        if (
            place is None
            or not left - EDGE <= place.x <= right + EDGE
            or not near - EDGE <= place.y <= far + EDGE
        ):
            return 0
        distances = [place.distance(seat) for seat in self._places]
        least = min(distances)
        return distances.index(least) + 1 if least <= FAR else 0


class Hysteresis:
    """Hysteresis over frames: on at three of five, off at one of five or fewer."""

    def __init__(self) -> None:
        self._seen: dict[int, deque[float]] = {}
        self._believed: set[int] = set()

    def take(self, found: dict[int, float]) -> dict[int, float]:
        """Add a frame's signs (seat to probability); return the confirmed ones likewise."""
        for seat in found:
            self._seen.setdefault(seat, deque((0.0,) * OF, OF))
        for seat, last in list(self._seen.items()):
            last.append(found.get(seat, 0.0))
            times = sum(sure > 0 for sure in last)
            if times >= BEGINS:
                self._believed.add(seat)
            elif times <= ENDS:
                self._believed.discard(seat)
            if not times:
                del self._seen[seat]
        return {seat: sum(self._seen[seat]) / OF for seat in self._believed}


class SignWatcher:
    """Detects in a sequence of frames at which seats signs are up."""

    def __init__(self, view: TableView, limits: TriangleLimits = USUAL) -> None:
        self._view = view
        self._limits = limits
        self._persistence = Hysteresis()
        self._answers = AnswerPersistence(view.seat)
        self.found: dict[int, float] = {}
        """Signs of the last frame alone: seat to probability."""

    def look(self, image: Image) -> dict[int, float]:
        """Process a frame (BGR); return who asks: seat (from 1) to probability."""
        self.found = {}
        for one in find_triangles(image, self._limits):
            seat = self._view.seat(one.x, one.y)
            if seat:
                self.found[seat] = max(self.found.get(seat, 0.0), one.sure)
        return self._persistence.take(self.found)

    def answers(self, image: Image) -> dict[int, tuple[str, float]]:
        """Take a picture (BGR); return who shows which letter: seat to letter and probability."""
        return self._answers.look(image)

    @property
    def sure_of_answers(self) -> bool:
        """Whether the last picture showed exactly the letters that count as shown."""
        shown = {seat: letter for seat, (letter, _) in self._answers.shown.items()}
        return shown == self._answers.found


class SignRequests(RequestSource):
    """Requests by signs before a camera."""

    def __init__(
        self, source: CameraSource, view: TableView, seats: int, people: Sequence[str] = ()
    ) -> None:
        """Prepare to watch a table through a camera, which `start` opens."""
        super().__init__(f"signs:{source.name}", seats, people)
        self.camera = Camera(source, device=DEVICE, limits=INFRARED)
        self._watcher = SignWatcher(view)
        self._task: asyncio.Task[None] | None = None

    def reading(self) -> Reading:
        """Return the reading for the diagnosis, with the age of the newest frame."""
        sight = self.camera.sight
        return Reading(DEVICE, sight.age, OK if sight.state == "OK" else STALE, rate=sight.rate)

    async def start(self) -> None:
        """Start watching."""
        self.camera.changed = lambda sight: self.tell(sight.why) if sight.why else None
        await self.camera.start()
        self._task = asyncio.create_task(self._watch())

    async def close(self) -> None:
        """Stop watching."""
        await super().close()
        if self._task is not None:
            self._task.cancel()
            await asyncio.wait({self._task})
        await self.camera.close()

    def answered(self, seat: int) -> None:
        """Do nothing: a request ends when the sign is turned down."""

    async def _watch(self) -> None:
        try:
            await self._look()
        except CameraError as error:
            self._error = RequestError(str(error))
        self._closed = True  # a file has ended
        self._changed.set()

    async def _look(self) -> None:
        async for frame in self.camera:
            image = frame.image()
            asks = await asyncio.to_thread(self._watcher.look, image)
            self._show(await asyncio.to_thread(self._watcher.answers, image), frame.stamp)
            for seat, sure in asks.items():
                self._ask(seat, sure, frame.stamp)
            for seat in set(self._asks) - set(asks):
                self._withdraw(seat)
            self.looks += 1
            agreed = set(self._watcher.found) == set(self._asks) and self._watcher.sure_of_answers
            self.agreed = self.agreed + 1 if agreed else 0
            if not self.camera.source.each:
                await asyncio.sleep(max(0.0, PAUSE - (time.monotonic() - frame.stamp)))


def _homography(pixels: Corners, places: Corners) -> list[list[float]]:
    import numpy as np

    if len({*pixels}) < 4 or not _goes_round(pixels):
        raise RequestError(
            "The corners of the table must go round it: left near, right near, right far, left far."
        )
    rows, wanted = [], []
    for (x, y), (a, b) in zip(pixels, places, strict=True):
        rows += [[x, y, 1, 0, 0, 0, -a * x, -a * y], [0, 0, 0, x, y, 1, -b * x, -b * y]]
        wanted += [a, b]
    found = [*np.linalg.solve(np.array(rows, float), np.array(wanted, float)), 1.0]
    return [[float(one) for one in found[row : row + 3]] for row in (0, 3, 6)]


def _goes_round(corners: Corners) -> bool:
    """Return whether four points form a convex quadrilateral that is not degenerate."""
    turns = []
    for here in range(4):
        (ax, ay), (bx, by), (cx, cy) = corners[here - 2], corners[here - 1], corners[here]
        long = hypot(bx - ax, by - ay) * hypot(cx - bx, cy - by)
        turns.append(((bx - ax) * (cy - by) - (by - ay) * (cx - bx)) / max(long, 1e-9))
    return min(turns) > 0.05 or max(turns) < -0.05
