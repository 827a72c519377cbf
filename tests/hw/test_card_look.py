"""A wrong mark or a win is reported only if pictures of two moments show it."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cache
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from tangy_hw.drivers.camera import Frame as Picture
from tangy_hw.perception.camera_hub import CameraHub
from tangy_hw.perception.card_and_face_perception import CardAndFacePerception, CardSeen
from tangy_hw.perception.cards.look import MOMENT, CardLook
from tangy_hw.perception.cards.reader import CardReader, CardReading
from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.card_face import numbers_of
from tangy_sim.rendering.card_frames import CardCamera, View

BINGO = load_activity("bingo")
CARD = 17
NUMBERS = numbers_of(BINGO.deck, CARD)
ROW = 0b11111
HIDDEN, SEEN, BARE = (0.02, 0.02, 0.96), (0.0005, 0.999, 0.0005), (0.999, 0.0005, 0.0005)
APART = 0.12  # s


@cache
def reader() -> CardReader:
    return CardReader(BINGO.deck)


def reading(marked: int = 0, *, hidden: int = 0, card: int = CARD) -> CardReading:
    cells = range(25)
    parts = [HIDDEN if hidden >> c & 1 else SEEN if marked >> c & 1 else BARE for c in cells]
    return reader().told(card, np.array(parts, np.float32))


def looked(
    readings: Iterable[CardReading], called: Iterable[int] = (), *, identify: bool = False
) -> CardLook:
    """Look until the look is over."""
    look = CardLook(reader(), BINGO.user_states, set(called), identify=identify)
    for one in readings:
        if not look.is_over:
            look.add(one)
    return look


ACCUSING: list[tuple[str, int, Sequence[int]]] = [
    ("incorrectly marked", 1 << 7, ()),
    ("missing numbers", 0, NUMBERS[7:8]),
    ("bingo", ROW, NUMBERS[:5]),
]


@pytest.mark.parametrize(("state", "marked", "called"), ACCUSING)
def test_a_wrong_or_winning_state_needs_pictures_of_two_moments(
    state: str, marked: int, called: Sequence[int]
) -> None:
    once = looked([reading(marked)], called)
    assert once.state == "occluded" and not once.is_over
    twice = looked([reading(marked)] * 2, called)
    assert twice.state == state and twice.is_over and twice.pictures == 2


@pytest.mark.parametrize(("state", "marked", "called"), ACCUSING)
def test_one_misread_picture_among_right_ones_says_nothing(
    state: str, marked: int, called: Sequence[int]
) -> None:
    right = reading(sum(1 << c for c, n in enumerate(NUMBERS) if n in called and c >= 5))
    if state == "missing numbers":
        right = reading(1 << 7)
    elif state == "bingo":
        right = reading(ROW & ~1)  # in the other picture, one of them is a finger
    for at in range(5):
        shown = [right] * 5
        shown[at] = reading(marked)
        assert looked(shown, called).state != state


def test_a_correct_card_needs_one_picture() -> None:
    look = looked([reading(1 << 7)], [NUMBERS[7]])
    assert look.state == "correctly marked" and look.is_over and not look.sure
    look = looked([reading(1 << 7)] * 2, [NUMBERS[7]], identify=True)
    assert look.is_over and look.sure and look.pictures == 2


def test_pictures_with_different_hidden_cells_complete_each_other() -> None:
    """A line is seen twice though no picture shows all of it."""
    shown = [reading(ROW, hidden=1), reading(ROW, hidden=2), reading(ROW, hidden=4)]
    assert looked(shown[:2], NUMBERS[:5]).state == "occluded"
    assert looked(shown, NUMBERS[:5]).state == "bingo"


def test_a_second_card_in_any_picture_ends_the_look() -> None:
    look = looked([reading(1 << 7), reading(1 << 7, card=31)])
    assert look.is_over and look.state == "occluded"
    assert look.reading.card is None and look.reading.cards == (CARD, 31)
    look = looked([reader().several((CARD, CARD))])
    assert look.is_over and look.reading.problem == "two copies of card 17 in sight"


def test_a_repeated_or_too_early_picture_is_no_new_moment() -> None:
    look = looked([])
    assert look.is_another(b"a", 5.0)
    assert not look.is_another(b"b", 5.0 + MOMENT / 2)
    assert not look.is_another(b"a", 6.0)
    assert look.is_another(b"b", 6.0)


# ---------------------------------------------------------------------------- with a camera


class Filmed:
    """Stands in for `CameraHub`: gives pictures of these chips at an interval in s."""

    card_device = "camera"

    def __init__(self, pictures: Sequence[np.ndarray], apart: float) -> None:
        self.pictures, self.apart = pictures, apart
        self.first = time.monotonic() + 1.0

    async def frame(self, _: str, *, after: int = -1) -> Picture | None:
        seq = after + 1
        if seq >= len(self.pictures):
            return None
        picture = self.pictures[seq]
        height, width = picture.shape[:2]
        stamp = self.first + seq * self.apart
        sight = cast(Any, SimpleNamespace())
        return Picture(seq, stamp, width, height, picture.tobytes(), sight)


@cache
def picture(marked: int, noise: int) -> np.ndarray:
    camera, view = CardCamera(BINGO.deck, title=BINGO.title), View(pixels=28, size=(560, 640))
    chips = camera.chips(np.random.default_rng(4), marked)
    bare = camera.take(CARD, chips, replace(view, noise=0.0), np.random.default_rng(9)).picture
    grain = np.random.default_rng(noise).normal(0, 2, bare.shape)
    return np.clip(bare + grain, 0, 255).astype(np.uint8)


async def seen_in(
    pictures: Sequence[np.ndarray],
    activity: Activity,
    *,
    apart: float = APART,
    called: Iterable[int] = (),
) -> CardSeen:
    senses = CardAndFacePerception(cast(CameraHub, Filmed(pictures, apart)), activity)
    try:
        return await senses.read_card(set(called))
    finally:
        senses.close()


@pytest.mark.slow
async def test_a_look_stops_after_two_pictures_show_a_wrong_mark(
    activity: Activity,
) -> None:
    shown = [picture(1 << 7, noise) for noise in range(4)]
    seen = await seen_in(shown, activity)
    assert (seen.state, seen.pictures, seen.cards, seen.sure) == (
        "incorrectly marked", 2, (CARD,), True,
    )  # fmt: skip
    assert seen.to_json()["cards"] == (CARD,)


@pytest.mark.slow
async def test_a_mark_in_a_single_picture_is_not_reported(activity: Activity) -> None:
    shown = [picture(1 << 7, 0), *(picture(0, noise) for noise in range(1, 5))]
    seen = await seen_in(shown, activity)
    assert seen.state in ("occluded", "correctly marked")


@pytest.mark.slow
async def test_a_frozen_picture_counts_as_one_moment(activity: Activity) -> None:
    seen = await seen_in([picture(1 << 7, 0)] * 5, activity)
    assert (seen.state, seen.pictures) == ("occluded", 1)


@pytest.mark.slow
async def test_pictures_in_quick_succession_count_as_one_moment(activity: Activity) -> None:
    shown = [picture(1 << 7, noise) for noise in range(4)]
    seen = await seen_in(shown, activity, apart=0.01)
    assert (seen.state, seen.pictures) == ("occluded", 1)
    quick = await seen_in([picture(1 << 7, noise) for noise in range(7)], activity, apart=0.034)
    assert (quick.state, quick.pictures) == ("incorrectly marked", 2)


async def test_a_look_without_pictures_reads_occluded(activity: Activity) -> None:
    seen = await seen_in([], activity)
    assert (seen.card, seen.state, seen.pictures) == (None, "occluded", 0)
