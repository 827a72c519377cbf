"""Every card in a picture is noticed. If there are several, none is taken for the person's."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest

from tangy_hw.perception.cards.card_detection import project
from tangy_hw.perception.cards.reader import NO_TAGS, CardReader
from tangy_hw.perception.cards.tags import is_printed, tags_in
from tangy_profiles.activity import Activity
from tangy_profiles.card_face import HEIGHT, TAGS, WIDTH, Box
from tangy_sim.rendering.card_backgrounds import background
from tangy_sim.rendering.card_frames import CardCamera, RenderedFrame, View

VIEW = View(pixels=30, noise=2, quality=92, size=(620, 700))
WHOLE = Box(-3, -3, WIDTH + 3, HEIGHT + 3)
UPPER, LOWER = TAGS[:2], TAGS[2:]
SLEEVE = (172, 188, 214)


@pytest.fixture(scope="module")
def reader(activity: Activity) -> CardReader:
    return CardReader(activity.deck)


@pytest.fixture(scope="module")
def camera(activity: Activity) -> CardCamera:
    return CardCamera(activity.deck, title=activity.title)


def taken(camera: CardCamera, card: int, seed: int = 1, view: View = VIEW) -> RenderedFrame:
    random = np.random.default_rng([seed, card])
    return camera.take(card, camera.chips(random, 0b10000_00100_01010), view, random)


def covered(camera: CardCamera, frame: RenderedFrame, *boxes: Box) -> RenderedFrame:
    """Lay a sleeve on parts of a card, in mm."""
    grid = camera.face.grid
    ends = [(grid.left, grid.top), (grid.right, grid.top)]
    ends += [(grid.right, grid.bottom), (grid.left, grid.bottom)]
    here, there = np.array(ends, np.float32), np.array(frame.corners, np.float32)
    plane = np.asarray(cv2.getPerspectiveTransform(here, there), float)
    picture = frame.picture.copy()
    for box in boxes:
        left, top, right, bottom = box.left - 4, box.top - 4, box.right + 4, box.bottom + 4
        outline = np.array([(left, top), (right, top), (right, bottom), (left, bottom)], float)
        cv2.fillPoly(picture, [np.round(project(plane, outline)).astype(np.int32)], SLEEVE)
    return replace(frame, picture=picture)


def beside(*frames: RenderedFrame) -> np.ndarray:
    return np.hstack([frame.picture for frame in frames])


@pytest.mark.parametrize("order", [(17, 31), (31, 17)])
def test_two_cards_in_sight_are_named_and_neither_is_read(
    reader: CardReader, camera: CardCamera, order: tuple[int, int]
) -> None:
    reading = reader.read(beside(*(taken(camera, card) for card in order)))
    assert reading.card is None and reading.cards == (17, 31)
    assert reading.problem == "two cards in sight: 17 and 31"
    assert reading.marked == 0 and reading.hidden.bit_count() == 25


@pytest.mark.parametrize(
    "hidden",
    [UPPER, LOWER, TAGS[:3], (TAGS[0], TAGS[2], TAGS[3]), TAGS[1:]],
    ids=["upper", "lower", "all but the last", "all but the second", "all but the first"],
)
def test_a_card_with_hidden_tags_is_noticed_beside_another_card(
    reader: CardReader, camera: CardCamera, hidden: tuple[Box, ...]
) -> None:
    own = covered(camera, taken(camera, 17), *hidden)
    reading = reader.read(beside(own, taken(camera, 31)))
    assert reading.card is None and reading.cards == (17, 31)


def test_one_visible_tag_is_enough_to_notice_a_card(reader: CardReader, camera: CardCamera) -> None:
    corner = np.array(taken(camera, 17).corners)
    left = int(corner[:, 0].max()) - 44  # only its right tags are in sight, one of them covered
    own = covered(camera, taken(camera, 17), TAGS[1]).picture[:, left:]
    reading = reader.read(np.hstack([own, taken(camera, 31).picture]))
    assert reading.card is None and reading.cards == (17, 31)


@pytest.mark.slow
def test_two_copies_of_a_card_count_as_two(reader: CardReader, camera: CardCamera) -> None:
    both = beside(taken(camera, 17, 1), taken(camera, 17, 2, replace(VIEW, spin=20, pixels=27)))
    reading = reader.read(both)
    assert reading.card is None and reading.cards == (17, 17)
    assert reading.problem == "two copies of card 17 in sight"
    half = covered(camera, taken(camera, 17, 1), *UPPER)
    assert reader.read(beside(half, taken(camera, 17, 2))).cards == (17, 17)


def test_three_cards_are_counted(reader: CardReader, camera: CardCamera) -> None:
    view = replace(VIEW, size=(420, 560), pixels=24)
    three = beside(*(taken(camera, card, view=view) for card in (9, 101, 44)))
    assert reader.read(three).problem == "three cards in sight: 9, 44 and 101"


@pytest.mark.slow
def test_a_single_card_is_read_and_named(reader: CardReader, camera: CardCamera) -> None:
    for tilt in (0.0, 45.0):
        reading = reader.read(taken(camera, 17, view=replace(VIEW, tilt=tilt)).picture)
        assert reading.card == 17 and reading.cards == (17,)
    hidden = reader.read(covered(camera, taken(camera, 17), camera.face.grid, *UPPER).picture)
    assert hidden.card is None and hidden.cards == (17,)
    nothing = reader.read(covered(camera, taken(camera, 17), WHOLE).picture)
    assert nothing.cards == () and nothing.problem == NO_TAGS


@pytest.mark.slow
def test_a_bent_card_is_one(reader: CardReader, camera: CardCamera) -> None:
    for seed in range(6):
        view = replace(VIEW, bend=1.2, tilt=30.0 + 5 * seed, spin=40.0 * seed)
        assert reader.read(taken(camera, 17, seed, view).picture).cards == (17,)


@pytest.mark.slow
def test_background_details_are_not_mistaken_for_tags() -> None:
    """Rooms and tables are full of detail; hardly any of it is black on white."""
    for number in range(12):
        random = np.random.default_rng([77, number])
        room = background(960, 540, random) + random.normal(0, 0.02, (540, 960, 3))
        grey = cv2.cvtColor(np.clip(room * 255, 0, 255).astype(np.uint8), cv2.COLOR_BGR2GRAY)
        assert not [tag for tag in tags_in(grey) if is_printed(grey, tag)]
    noise = np.random.default_rng(2).integers(0, 256, (540, 960), np.uint8)
    assert not [tag for tag in tags_in(noise) if is_printed(noise, tag)]
