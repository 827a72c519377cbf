"""Images of the bench's cameras: cards and faces for the head, signs for the infrared camera.

An image is drawn once for a scene, and then sent with varying noise. Drawing takes at most .1 s,
another frame of the same scene some milliseconds.
"""

from __future__ import annotations

from collections import OrderedDict, deque
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from threading import Lock
from typing import TYPE_CHECKING, Any

import cv2
import numpy as np

from tangy_profiles.activity import Activity
from tangy_profiles.card_face import USUAL_SEED
from tangy_sim.device_simulator.world import HeadScene
from tangy_sim.rendering.card_backgrounds import background, tone_of
from tangy_sim.rendering.card_chips import Chip
from tangy_sim.rendering.card_frames import CardCamera, View
from tangy_sim.rendering.faces import drawn_face

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Picture = NDArray[np.uint8]
    Draws = Callable[[HeadScene], "list[Picture]"]

SIZE = (1280, 720)
MAT = 440  # pixels per side of the mat under a card
QUALITY = 88  # of the head camera's JPEG
NOISE = 2.5  # grey levels
VARIANTS = 6  # frames of a scene with different noise, sent in rotation
SCENES = 12  # scenes whose frames are cached
FACE = 300  # pixels of a face with its surroundings
FACE_PICTURES = 4  # of one person, in rotation
FIRST_PICTURE = 1_000  # differs from the images of enrolment
DEGREE = 12  # pixels of the panorama per degree
CHIPS = (0.0, 215.0, 130.0, 285.0, 24.0, 335.0, 50.0, 180.0)  # hues, by seat


class HeadCamera:
    """Produces the frames of the head camera, as JPEG."""

    def __init__(
        self,
        activity: Activity,
        people: Sequence[str],
        faces: Mapping[str, int],
        *,
        seed: int,
        title: str = "",
    ) -> None:
        """Prepare the camera; `faces` are the numbers of people's drawn faces."""
        self._people = list(people)
        self._faces = dict(faces)
        self._seed = seed
        self._camera = CardCamera(activity.deck, deck_seed=USUAL_SEED, title=title)
        self._noise = np.random.default_rng([seed, 3])
        self._frames: OrderedDict[HeadScene, deque[bytes]] = OrderedDict()
        self._pictures: OrderedDict[HeadScene, list[Picture]] = OrderedDict()
        self._tables: dict[tuple[int, int], Picture] = {}
        self._last = b""
        self._drawing = Lock()  # of tables: `prepare` may run beside `frame`

    def frame(self, scene: HeadScene) -> bytes:
        """Return the next frame of a scene; a frozen camera repeats its last frame."""
        if scene.kind == "frozen":
            return self._last or self.frame(HeadScene("room"))
        frames = self._frames.setdefault(scene, deque())
        self._frames.move_to_end(scene)
        while len(self._frames) > SCENES:
            self._frames.popitem(last=False)
        if len(frames) < VARIANTS:
            pictures = self._drawn(scene)
            frames.appendleft(self._exposed(pictures[len(frames) % len(pictures)]))
            self._last = frames[0]
        else:
            frames.rotate(1)
            self._last = frames[0]
        return self._last

    def _drawn(self, scene: HeadScene) -> list[Picture]:
        if scene not in self._pictures:
            draws: dict[str, Draws] = {
                "card": self._card, "face": self._face, "room": self._room, "dark": self._dark,
            }  # fmt: skip
            self._pictures[scene] = draws[scene.kind](scene)
            while len(self._pictures) > SCENES // 2:
                self._pictures.popitem(last=False)
        return self._pictures[scene]

    def _exposed(self, picture: Picture) -> bytes:
        """Add sensor noise and encode the image; the noise is a window of a larger sheet."""
        x, y = self._noise.integers(0, 64, 2)
        grain = self._sheet[y : y + picture.shape[0], x : x + picture.shape[1]]
        grainy = cv2.add(picture, grain, dtype=cv2.CV_8U)
        return _packed(grainy, QUALITY)

    @cached_property
    def _sheet(self) -> NDArray[np.int16]:
        random = np.random.default_rng([self._seed, 4])
        across, down = SIZE[0] + 64, SIZE[1] + 64
        return random.normal(0, NOISE, (down, across, 3)).astype(np.int16)

    # ------------------------------------------------------------------------------ scenes

    def _card(self, scene: HeadScene) -> list[Picture]:
        """Draw the card before a person on a mat, in good light, slightly rotated and tilted."""
        who = self._people.index(scene.person)
        now = np.random.default_rng([self._seed, 5, scene.game, who, scene.moved])
        picture = self._table(scene.game, who).copy()
        if scene.hides == "away":
            return [picture]
        mat, corners = self._mat(scene, who, now)
        x, y = int(now.integers(0, SIZE[0] - MAT)), int(now.integers(0, SIZE[1] - MAT))
        if scene.hides == "edge":  # only the part above the grid is visible
            y = SIZE[1] + 12 - int(corners[:, 1].min())
        elif scene.hides == "sheet":
            middle = corners.mean(0)
            sheet = (middle + (corners - middle) * 1.25).astype(np.int32)
            tone = [float(c * 255) for c in tone_of(now.uniform(0, 360), 0.3, 0.85)]
            cv2.fillPoly(mat, [sheet], tone, cv2.LINE_AA)
        picture[y : y + MAT, x : x + MAT] = mat[: SIZE[1] - y]
        return [picture]

    def _mat(
        self, scene: HeadScene, who: int, random: np.random.Generator
    ) -> tuple[Picture, NDArray[np.float32]]:
        """Return the mat with the card as the camera sees it, and the corners of its grid."""
        face = self._camera.face
        chips: dict[int, Chip] = {}
        for cell in range(face.deck.rows * len(face.deck.columns)):
            if scene.marked >> cell & 1 and not face.deck.free >> cell & 1:
                thrown = np.random.default_rng([self._seed, 6, scene.game, who, cell])
                chips[cell] = _chip(who).thrown(thrown, face.middle(cell), face.cell, 0.0)
        frame = self._camera.take(scene.card, chips, _view(random), random)
        return np.array(frame.picture, np.uint8), np.array(frame.corners, np.float32)

    def _table(self, game: int, who: int) -> Picture:
        """Draw the table before a person, which stays the same for a game."""
        key = game, who
        with self._drawing:
            if key not in self._tables:
                random = np.random.default_rng([self._seed, 9, game, who])
                table = np.clip(background(*SIZE, random) * 255 * 0.8, 0, 255).astype(np.uint8)
                self._tables[key] = _with_napkin(table, random)
                while len(self._tables) > len(self._people):
                    del self._tables[next(iter(self._tables))]
            return self._tables[key]

    def prepare(self, game: int, who: int, card: int) -> None:
        """Draw the slowest parts in advance: the face of a card, and the table under it."""
        random = np.random.default_rng([self._seed, who])
        self._table(game, who)
        self._camera.take(card, {}, _view(random), random)

    def _face(self, scene: HeadScene) -> list[Picture]:
        """Draw a person in front of the room, in several images."""
        behind = self._window(90)
        x, y = (SIZE[0] - FACE) // 2, 130
        inner = np.zeros((FACE, FACE), np.float32)
        inner[20:-20, 20:-20] = 1
        fade = cv2.GaussianBlur(inner, (0, 0), 8)[..., None]
        pictures: list[Picture] = []
        for number in range(FACE_PICTURES):
            drawn = drawn_face(self._faces[scene.person], FIRST_PICTURE + number, size=FACE)
            picture = behind.copy()
            box = np.s_[y : y + FACE, x : x + FACE]
            picture[box] = (picture[box] * (1 - fade) + drawn * fade).astype(np.uint8)
            pictures.append(picture)
        return pictures

    def _room(self, scene: HeadScene) -> list[Picture]:
        return [self._window(scene.heading)]

    def _dark(self, _: HeadScene) -> list[Picture]:
        return [np.full((SIZE[1], SIZE[0], 3), 6, np.uint8)]

    def _window(self, heading: int) -> Picture:
        """Cut the view in a direction (degrees) out of the room's panorama."""
        left = (-heading * DEGREE) % (360 * DEGREE)
        seen = self._around[:, left : left + SIZE[0]]
        more = SIZE[0] - seen.shape[1]
        return np.hstack((seen, self._around[:, :more])) if more else seen.copy()

    @cached_property
    def _around(self) -> Picture:
        """Draw the panorama of the room: walls with windows and pictures, a floor."""
        random = np.random.default_rng([self._seed, 7])
        across = 360 * DEGREE
        wall = np.array(random.uniform(130, 190, 3))
        around = np.empty((SIZE[1], across, 3), np.float32)
        around[:] = wall
        around[470:] = wall * 0.55
        around *= 1 + 0.1 * np.sin(np.linspace(0, 2 * np.pi, across))[None, :, None]
        for number in range(18):
            x = int(number * across / 18 + random.uniform(0, 90))
            y, wide, high = (int(v) for v in random.uniform((90, 60, 60), (220, 150, 200)))
            tone = [float(v) for v in random.uniform(50, 240, 3)]
            cv2.rectangle(around, (x, y), (x + wide, y + high), tone, -1)
            cv2.rectangle(around, (x, y), (x + wide, y + high), [60.0, 60.0, 60.0], 5)
        return np.asarray(np.clip(around, 0, 255), np.uint8)


def _view(random: np.random.Generator) -> View:
    """Return the view of a camera over a mat on a card."""
    return View(
        pixels=float(random.uniform(27, 34)),
        tilt=float(random.uniform(5, 25)),
        tilted_to=float(random.uniform(-180, 180)),
        spin=float(random.uniform(-12, 12)),
        wide=1.1 * SIZE[0] / MAT,
        light=float(random.uniform(0.72, 0.92)),
        slope=float(random.uniform(0, 0.15)),
        warm=float(random.uniform(-0.06, 0.1)),
        blur=0.5,
        noise=0.0,
        quality=100,
        bend=float(random.uniform(0, 0.4)),
        size=(MAT, MAT),
    )


def _with_napkin(picture: Picture, random: np.random.Generator) -> Picture:
    """Add a checked napkin, whose edges show that the camera is in focus."""
    check, across, down = 26, 18, 9
    x = int(random.uniform(40, SIZE[0] - check * across - 40))
    y = int(random.uniform(20, 180))
    cv2.rectangle(picture, (x, y), (x + check * across, y + check * down), [235.0] * 3, -1)
    for row in range(down):
        for column in range(row % 2, across, 2):
            corner = x + check * column, y + check * row
            end = corner[0] + check - 1, corner[1] + check - 1
            cv2.rectangle(picture, corner, end, [60.0, 60.0, 190.0], -1)
    return picture


def _chip(seat: int) -> Chip:
    """Return the chips at a seat: of one colour, 18 mm wide."""
    tone = tone_of(CHIPS[seat % len(CHIPS)], 0.85, 0.75)
    return Chip(radius=9.0, tone=tone, clear=0.0, thick=1.5, rim=-0.15)


def _packed(picture: Any, quality: int) -> bytes:
    return cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, quality])[1].tobytes()
