"""Reading cards: uncertain cells are reported as hidden, and cards of other decks refused."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from importlib import resources
from pathlib import Path

import cv2
import numpy as np
import pytest

from tangy_hw.perception.cards import classifier
from tangy_hw.perception.cards.reader import (
    NO_TAGS,
    OTHER_NUMBERS,
    TOO_LITTLE,
    CardReader,
    CardReading,
)
from tangy_profiles.activity import Activity, load_activity, read_activity
from tangy_profiles.card_face import numbers_of
from tangy_sim.rendering.card_chips import Chip
from tangy_sim.rendering.card_frames import CardCamera, RenderedFrame, View
from tangy_sim.rendering.card_odd_chips import odd_chip, sheer_chip

TESTS = Path(__file__).parents[1]
CLEAN = View(pixels=36, noise=1, quality=95)
ALL = (1 << 25) - 1


@cache
def camera(name: str = "bingo", deck_seed: int = 1) -> CardCamera:
    activity = load_activity(name) if name == "bingo" else read_activity(TESTS / f"{name}.toml")
    return CardCamera(activity.deck, deck_seed=deck_seed, title=activity.title)


@pytest.fixture(scope="module")
def reader(activity: Activity) -> CardReader:
    return CardReader(activity.deck)


def taken(marked: int, view: View = CLEAN, *, card: int = 17, seed: int = 5) -> RenderedFrame:
    random = np.random.default_rng(seed)
    return camera().take(card, camera().chips(random, marked), view, random)


@pytest.mark.slow
@pytest.mark.parametrize("tilt", [0, 35, 60])
@pytest.mark.parametrize("marked", [0, 0b00100_01010_10001_00000_11111])
def test_a_clean_card_is_read_at_any_tilt(reader: CardReader, tilt: int, marked: int) -> None:
    frame = taken(marked, replace(CLEAN, tilt=float(tilt), spin=200.0, size=(800, 600)))
    reading = reader.read(frame.picture)
    assert (reading.card, reading.marked, reading.hidden) == (17, frame.marked, 0)
    assert reading.confidence > 0.9 and reading.problem == ""
    assert np.abs(np.array(reading.corners) - np.array(frame.corners)).max() < 2  # pixels


@pytest.mark.slow
def test_rendered_frames_are_never_read_wrongly(reader: CardReader) -> None:
    for frame in camera().frames(31, 8, size=(720, 560)):
        reading = reader.read(frame.picture)
        assert reading.card in (frame.card, None)
        assert not (reading.marked ^ frame.marked) & ~reading.hidden


@pytest.mark.slow
@pytest.mark.parametrize("sort", [odd_chip, sheer_chip])
def test_odd_objects_on_a_number_are_not_read_as_bare_paper(
    reader: CardReader, sort: Callable[[np.random.Generator], Chip]
) -> None:
    odd = CardCamera(reader.deck, title="Bingo", straddling=0.0, odd=1.0, oddity=sort)
    told = 0
    for frame in odd.frames(47, 4, size=(640, 520), pixels=30.0, hand="", glare=0.0):
        reading = reader.read(frame.picture)
        assert reading.card in (frame.card, None)
        assert not (reading.marked ^ frame.marked) & ~reading.hidden
        told += (reading.marked & frame.marked).bit_count()
    assert told > 5  # else every cell was hidden


def test_the_classifier_is_small_and_refuses_other_features() -> None:
    path = resources.files(classifier.__package__) / "classifier.json"
    assert len(path.read_bytes()) < 1_000_000
    told = json.loads(path.read_text(encoding="utf-8"))
    assert classifier.read_classifier(told).alone.nets
    with pytest.raises(RuntimeError, match="train it again"):
        classifier.read_classifier({**told, "features": told["features"][1:]})


def test_cells_under_a_hand_are_hidden_and_the_others_are_read(reader: CardReader) -> None:
    frame = taken(0b1111100000, replace(CLEAN, hand="finger", size=(800, 600)), seed=2)
    covered = frame.unknown(0.8)
    assert covered  # else this frame tests nothing
    reading = reader.read(frame.picture)
    assert reading.card == 17
    assert reading.hidden & covered == covered
    assert not (reading.marked ^ frame.marked) & ~reading.hidden
    assert reading.hidden.bit_count() < 20


@pytest.mark.slow
def test_a_card_of_another_deck_is_refused(reader: CardReader) -> None:
    random = np.random.default_rng(1)
    picture = camera(deck_seed=2).take(17, {}, CLEAN, random).picture
    reading = reader.read(picture)
    assert (reading.card, reading.marked, reading.hidden) == (None, 0, ALL)
    assert reading.problem == OTHER_NUMBERS
    assert CardReader(reader.deck, 2).read(picture).card == 17


@pytest.mark.parametrize("bare", [0, 0b1, 0b10000_00000_00000_00010_00000])
def test_a_fully_marked_card_is_read(reader: CardReader, bare: int) -> None:
    frame = taken(ALL & ~bare & ~reader.deck.free, card=42)
    reading = reader.read(frame.picture)
    assert reading.card == 42
    assert reading.hidden.bit_count() <= 2
    assert reading.marked | reading.hidden == frame.marked | reading.hidden


def test_a_bare_number_of_another_deck_shows_that_a_card_is_foreign(reader: CardReader) -> None:
    bare = 0b10000_00000_00000_00010_00000
    random = np.random.default_rng(5)
    other = camera(deck_seed=2)
    chips = other.chips(random, ALL & ~bare & ~reader.deck.free)
    frame = other.take(42, chips, CLEAN, random)
    assert reader.read(frame.picture).card is None


@pytest.mark.slow
def test_noise_and_covered_cards_are_not_read_as_cards(reader: CardReader) -> None:
    noise = np.random.default_rng(2).integers(0, 256, (240, 320, 3), np.uint8)
    assert reader.read(noise).problem == NO_TAGS
    covered = taken(0).picture.copy()
    bounds = np.array(taken(0).corners)
    low, high = bounds.min(0).astype(int) - 4, bounds.max(0).astype(int) + 4
    cv2.rectangle(covered, low.tolist(), high.tolist(), (90, 120, 200), -1)
    reading = reader.read(covered)
    assert reading.card is None and reading.problem == TOO_LITTLE


@pytest.mark.slow
def test_large_pictures_are_read_as_well(reader: CardReader) -> None:
    frame = taken(0b10101, replace(CLEAN, size=(500, 500)))
    large = cv2.resize(frame.picture, None, fx=5, fy=5, interpolation=cv2.INTER_CUBIC)
    reading = reader.read(np.asarray(large, np.uint8))
    assert (reading.card, reading.marked, reading.hidden) == (17, frame.marked, 0)


def test_cards_of_another_shape_are_read_with_their_free_cell(lanterns: Activity) -> None:
    random = np.random.default_rng(3)
    frame = camera("lanterns").take(9, camera("lanterns").chips(random, 0b100000011), CLEAN, random)
    reading = CardReader(lanterns.deck).read(frame.picture)
    assert (reading.card, reading.hidden) == (9, 0)
    assert reading.marked == frame.marked | lanterns.deck.free


def reading_of(
    reader: CardReader, card: int, parts: dict[int, tuple[float, float, float]]
) -> CardReading:
    rows = np.array([parts.get(cell, (0.999, 0.0005, 0.0005)) for cell in range(25)], np.float32)
    return reader.told(card, rows)


def test_an_uncertain_mark_counts_only_if_no_hand_is_in_sight(
    reader: CardReader,
) -> None:
    unsure = {2: (0.92, 0.0, 0.08), 6: (0.0, 0.98, 0.02)}
    reading = reading_of(reader, 3, unsure)
    assert (reading.marked, reading.hidden) == (1 << 6, 0)
    reading = reading_of(reader, 3, {**unsure, 7: (0.1, 0.1, 0.8)})
    assert (reading.marked, reading.hidden) == (0, 1 << 6 | 1 << 7)


def test_fused_frames_fill_in_cells_that_one_frame_hides(reader: CardReader) -> None:
    hidden, seen = (0.02, 0.02, 0.96), (0.0005, 0.999, 0.0005)
    first = reading_of(reader, 3, {0: hidden, 7: seen})
    second = reading_of(reader, 3, {0: seen, 7: seen, 8: hidden})
    assert first.hidden == 1 and second.hidden == 1 << 8
    fused = reader.fuse([first, second, reader.nothing(NO_TAGS)])
    assert (fused.card, fused.marked, fused.hidden) == (3, 1 << 0 | 1 << 7, 0)


def test_contradicting_frames_hide_the_cell_or_the_card(reader: CardReader) -> None:
    yes, no = (0.001, 0.998, 0.001), (0.998, 0.001, 0.001)
    fused = reader.fuse([reading_of(reader, 3, {4: yes}), reading_of(reader, 3, {4: no})])
    assert fused.hidden == 1 << 4
    other = reading_of(reader, 4, {})
    assert reader.fuse([reading_of(reader, 3, {}), other]).card is None
    assert reader.fuse([reader.nothing(OTHER_NUMBERS)]).problem == OTHER_NUMBERS


def test_a_hidden_cell_matters_only_where_it_could_change_the_state(
    reader: CardReader, activity: Activity
) -> None:
    numbers = numbers_of(activity.deck, 3)
    hidden, seen = (0.02, 0.02, 0.96), (0.0005, 0.999, 0.0005)
    states = activity.user_states
    row = dict.fromkeys(range(5), seen)
    called = set(numbers[:5])
    whole = reading_of(reader, 3, {**row, 12: hidden})
    assert reader.state(whole, states, called) == "bingo"
    assert reader.state(reading_of(reader, 3, {12: hidden}), states, called) == "occluded"
    assert reader.state(reading_of(reader, 3, {12: hidden}), states, set()) == "occluded"
    assert reader.state(reading_of(reader, 3, {}), states, called) == "missing numbers"
    assert reader.state(reader.nothing(NO_TAGS), states, called) == "occluded"


def test_a_card_state_uses_only_certain_cells(reader: CardReader, activity: Activity) -> None:
    numbers = numbers_of(activity.deck, 3)
    seen, covered = (0.0005, 0.999, 0.0005), (0.2, 0.0, 0.8)
    states, called = activity.user_states, set(numbers[:5])
    row = dict.fromkeys(range(5), seen)
    assert reader.state(reading_of(reader, 3, row), states, called) == "bingo"
    called |= set(numbers[5:10])
    bare = reading_of(reader, 3, {**row, 7: (0.98, 0.02, 0.0)})  # readable, but unreliable
    assert (bare.marked & 1 << 7, bare.hidden) == (0, 0)
    assert reader.state(bare, states, called) == "bingo"  # it changes nothing
    bare = reading_of(reader, 3, {7: (0.98, 0.02, 0.0)})
    assert reader.state(bare, states, {numbers[7]}) == "occluded"
    less = (0.012, 0.987, 0.001)
    assert reader.state(reading_of(reader, 3, {**row, 2: less}), states, called) == "bingo"
    reading = reading_of(reader, 3, {**row, 2: less, 20: covered})  # a hand is there
    assert reader.state(reading, states, called) == "occluded"
