"""Training frames for the classifier of card cells: typical rooms, and difficult scenes.

Their seeds are reserved for training: the bench of cards quotes its figures on others.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import count, islice
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tangy_profiles.activity import load_activity
from tangy_sim.rendering.card_chips import Chip
from tangy_sim.rendering.card_frames import HANDS, CardCamera, RenderedFrame, some_view
from tangy_sim.rendering.card_odd_chips import odd_chip, sheer_chip
from tests.bench.cards import Bench

Real: TypeAlias = NDArray[Any]

TIPS = ("finger", "finger", "finger", "bar", "thumb", "blob", "flat")
TIP, MOST_TIP = 0.12, 3  # of a cell that a tip covers, of at most this many cells
LYING = ("blob", "bar", "blob", "thing", "blob", "bar", "flat", "thumb")
MOST_LYING = 9  # cells
STEEP = (44.0, 64.0)  # degrees, of one frame in this many:
ONE_STEEP = 3
SMALL = (660, 540)
ROOMS = (101_000, 102_000, 103_000, 104_000)


def some_frames(camera: CardCamera, seed: int, frames: int) -> Iterator[RenderedFrame]:
    """Yield frames of typical rooms, and more of difficult scenes: steep, dark, behind hands."""
    yield from camera.frames(seed, frames * 6 // 10, size=SMALL)
    hard: list[dict[str, Any]] = [
        *({"tilt": tilt} for tilt in (52.0, 56.0, 60.0, 64.0)),
        *({"light": light} for light in (0.25, 0.35)),
        *({"hand": hand} for hand in (*HANDS, "finger", "finger")),
        *({"glare": glare} for glare in (0.3, 0.6)),
    ]
    for number, given in enumerate(hard):
        yield from camera.frames(
            seed + 1 + number, frames * 4 // 10 // len(hard), size=SMALL, **given
        )
    yield from camera.frames(seed + 50, frames // 10, size=SMALL, hand="thing")


def faint_frames(camera: CardCamera, seed: int, frames: int) -> Iterator[RenderedFrame]:
    """Yield frames of chips that are hard to see, half of them in glare."""
    hard: list[dict[str, Any]] = [
        {}, {}, {}, *({"glare": glare} for glare in (0.25, 0.45, 0.7, 1.0)), {"hand": "finger"},
    ]  # fmt: skip
    for number, given in enumerate(hard):
        yield from camera.frames(seed + number, frames // len(hard), size=SMALL, **given)


def odd_frames(camera: CardCamera, seed: int, frames: int) -> Iterator[RenderedFrame]:
    """Yield frames of other objects on cards in the place of chips."""
    hard: list[dict[str, Any]] = [
        {}, {}, {}, {}, {"glare": 0.35}, {"glare": 0.7}, {"hand": "finger"}, {"hand": "blob"},
    ]  # fmt: skip
    for number, given in enumerate(hard):
        yield from camera.frames(seed + number, frames // len(hard), size=SMALL, **given)


def room_frames(camera: CardCamera, seed: int, frames: int) -> Iterator[RenderedFrame]:
    """Yield the bench's frames of typical rooms."""
    yield from camera.frames(seed, frames)


def scene_frames(camera: CardCamera, seed: int, frames: int) -> Iterator[RenderedFrame]:
    """Yield five frames of each of the bench's scenes."""
    for scene in Bench(load_activity("bingo"), camera).scenes(seed, frames // 5, 5):
        yield from scene


def tip_frames(camera: CardCamera, seed: int, frames: int) -> Iterator[RenderedFrame]:
    """Yield frames with only the tip of a hand on the grid: it looks like a chip."""

    def tried() -> Iterator[RenderedFrame]:
        for number in count():
            random = np.random.default_rng([seed, number])
            view = some_view(random, hand=TIPS[number % len(TIPS)], size=SMALL)
            try:
                yield camera.some_frame(random, view)
            except NoTip:
                continue

    yield from islice(tried(), frames)


def line_frames(camera: CardCamera, seed: int, frames: int) -> Iterator[RenderedFrame]:
    """Yield frames of chips that lie near lines, some of them in glare or beside hands."""
    hard: list[dict[str, Any]] = [
        {}, {}, {}, {"hand": ""}, {"glare": 0.6}, {"glare": 0.9, "hand": ""},
        {"tilt": 48.0}, {"tilt": 60.0, "hand": ""},
    ]  # fmt: skip
    for number, given in enumerate(hard):
        yield from camera.frames(seed + number, frames // len(hard), size=SMALL, **given)


def lying_frames(camera: CardCamera, seed: int, frames: int) -> Iterator[RenderedFrame]:
    """Yield frames with the end of something larger than a chip: fists, arms and objects."""

    def tried() -> Iterator[RenderedFrame]:
        for number in count():
            random = np.random.default_rng([seed, number])
            steep = {"tilt": float(random.uniform(*STEEP))} if number % ONE_STEEP == 0 else {}
            view = some_view(random, hand=LYING[number % len(LYING)], size=SMALL, **steep)
            try:
                yield camera.some_frame(random, view)
            except NoTip:
                continue

    yield from islice(tried(), frames)


class NoTip(Exception):
    """The object on a card is no tip."""


class TipCamera(CardCamera):
    """Takes only frames of hands that cover few cells."""

    most = MOST_TIP

    def _covered(self, mask: Real, scale: float) -> Real:
        covered = super()._covered(mask, scale)
        if not 1 <= (covered > TIP).sum() <= self.most:
            raise NoTip
        return covered


class LyingCamera(TipCamera):
    """Takes only frames of objects that leave most of the card in sight."""

    most = MOST_LYING


@dataclass(frozen=True)
class Kind:
    """Frames of one kind: how they are made, how many, and their seeds."""

    frames: Callable[[CardCamera, int, int], Iterator[RenderedFrame]]
    straddling: float
    faint: float
    odd: float
    learnt: dict[int, int]
    chosen: dict[int, int] = field(default_factory=dict)
    oddity: Callable[[np.random.Generator], Chip] = odd_chip
    taken: type[CardCamera] = CardCamera

    def camera(self) -> CardCamera:
        """Return the camera that takes them."""
        deck = load_activity("bingo").deck
        return self.taken(
            deck,
            title="Bingo",
            straddling=self.straddling,
            faint=self.faint,
            odd=self.odd,
            oddity=self.oddity,
        )


KINDS = (
    Kind(some_frames, 0.2, 0.0, 0.0, {1000: 2000}),
    Kind(tip_frames, 0.2, 0.0, 0.0, {4000: 1000, 4500: 400}, taken=TipCamera),
    Kind(lying_frames, 0.2, 0.0, 0.0, {9000: 400, 9001: 400}, taken=LyingCamera),
    Kind(line_frames, 0.6, 0.15, 0.0, {12_000: 800}),
    Kind(faint_frames, 0.1, 0.85, 0.0, {5000: 800}),
    Kind(odd_frames, 0.1, 0.15, 0.85, {8000: 640}),
    Kind(odd_frames, 0.1, 0.0, 0.9, {8500: 400}, oddity=sheer_chip),
    Kind(room_frames, 0.06, 0.0, 0.0, dict.fromkeys(ROOMS, 1000)),
    Kind(scene_frames, 0.06, 0.0, 0.0, {}, {101_002: 500}),
)
"""The frames of training, and of the choice of the temperature."""
