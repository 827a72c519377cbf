"""A mark that is unlike the card's other marks counts as hidden, not as a mark."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from tangy_hw.perception.cards.features import NAMES, CellFeatures
from tangy_hw.perception.cards.likeness import MUDDLED, unlike_others
from tangy_hw.perception.cards.reader import CardReader
from tangy_profiles.activity import Activity
from tangy_sim.rendering.card_frames import CardCamera
from tests.bench.card_harsh import CHOSEN, TROUBLES, HarshCamera

MARKED, UNMARKED, HIDDEN = (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.1, 0.9)
UNSURE = (0.6, 0.4, 0.0)

RED = {"dyed": 0.5, "red": 0.5, "blue": 0.02, "print": 0.4}
BLUE = {"dyed": 0.4, "red": -0.2, "blue": 0.4, "print": 0.4}
BROWN = {"dyed": 0.35, "red": 0.3, "blue": -0.25, "print": 0.4}
WHITE = {"dyed": 0.01, "red": 0.0, "blue": 0.0, "print": 0.4}
CROSSED = {"dyed": 0.01, "red": 0.0, "blue": 0.0, "print": 0.7}
SHADOW = CROSSED
FINGER = {"dyed": 0.2, "red": 0.15, "blue": -0.1, "print": 0.3}

Cell = Mapping[str, float]


def doubted(
    marks: Mapping[int, Cell],
    others: Mapping[int, tuple[float, float, float]] | None = None,
) -> set[int]:
    """Return which of these marks are doubted; the other cells are bare by default."""
    rows = np.zeros((25, len(NAMES)), np.float32)
    parts = np.array([UNMARKED] * 25, np.float32)
    for cell, features in marks.items():
        parts[cell] = MARKED
        for name, value in features.items():
            rows[cell, NAMES.index(name)] = value
    for cell, part in (others or {}).items():
        parts[cell] = part
    told = (parts[:, :2].max(1) > 0.9) & (parts[:, 2] < 0.1)
    found = unlike_others(CellFeatures(rows, rows[:, :2], rows[:, 0]), parts, told, 5)
    return {int(cell) for cell in np.flatnonzero(found)}


@pytest.mark.parametrize("chip", [RED, BLUE, BROWN])
@pytest.mark.parametrize("odd", [SHADOW, WHITE])
def test_a_colourless_mark_among_coloured_marks_is_hidden(chip: Cell, odd: Cell) -> None:
    assert doubted({2: chip, 9: chip, 17: chip, 21: odd}) == {21}
    assert doubted({2: chip, 9: chip}) == set()


@pytest.mark.parametrize("mark", [WHITE, CROSSED])
def test_marks_without_any_colour_are_all_kept(mark: Cell) -> None:
    cells = {2: mark, 9: mark, 17: mark}
    assert doubted(cells) == set()
    assert doubted({**cells, 21: RED}) == set()  # one chip of another kind changes nothing


def test_chips_of_several_colours_are_as_good_as_of_one() -> None:
    assert doubted({2: RED, 9: BLUE, 17: BROWN, 20: RED, 3: BLUE}) == set()


def test_dark_numbers_among_many_unsure_cells_are_hidden() -> None:
    muddle = dict.fromkeys(range(10, 10 + MUDDLED), UNSURE)
    assert doubted({2: SHADOW, 4: SHADOW}, muddle) == {2, 4}
    assert doubted({2: SHADOW, 4: SHADOW, 5: RED}, muddle) == {2, 4}
    assert doubted({2: WHITE, 4: WHITE}, muddle) == set()  # their numbers are not in sight
    del muddle[10]
    assert doubted({2: SHADOW, 4: SHADOW}, muddle) == set()


@pytest.mark.parametrize("chip", [RED, BLUE, BROWN])
def test_a_fingertip_among_chips_of_any_colour_is_hidden(chip: Cell) -> None:
    assert doubted({2: chip, 9: chip, 17: FINGER}) == {17}


def test_a_single_mark_that_looks_like_a_fingertip_is_hidden() -> None:
    hand = {18: HIDDEN, 23: HIDDEN}
    assert doubted({17: FINGER}, hand) == {17}
    assert doubted({17: FINGER}) == set()
    assert doubted({17: RED}, hand) == set()
    assert doubted({17: BROWN, 2: BROWN}, hand) == set()  # there are brown chips elsewhere


@pytest.mark.slow
@pytest.mark.parametrize(
    ("trouble", "number"),
    [
        ("blinds", 19),
        ("blinds", 36),
        ("moved and glaring", 8),
        ("fingertips, glaring", 13),
        ("fingertips, glaring", 22),
    ],
)
def test_stripes_blur_and_fingers_are_not_read_as_marks(
    activity: Activity, trouble: str, number: int
) -> None:
    """Each of these frames had bare cells that were read as marked."""
    at, kind = next((n, one) for n, one in enumerate(TROUBLES) if one.name == trouble)
    harsh = HarshCamera(CardCamera(activity.deck, title=activity.title), CHOSEN)
    frame = harsh.frame(kind, np.random.default_rng([CHOSEN.seed, at, number]))
    reading = CardReader(activity.deck).read(frame.picture)
    assert reading.card == frame.card
    assert not reading.marked & ~reading.hidden & ~frame.marked & ~activity.deck.free


@pytest.mark.slow
@pytest.mark.parametrize("marks", ["coloured", "colourless", "pen"])
def test_marks_of_one_uniform_kind_are_read(activity: Activity, marks: str) -> None:
    harsh = HarshCamera(CardCamera(activity.deck, title=activity.title), CHOSEN, marks)
    reader, read, there = CardReader(activity.deck), 0, 0
    for frame in harsh.frames(TROUBLES[0], 3):
        reading = reader.read(frame.picture)
        assert not (reading.marked ^ frame.marked) & ~reading.hidden
        read += (reading.marked & ~reading.hidden & frame.marked).bit_count()
        there += frame.marked.bit_count()
    assert read >= 0.8 * there > 5
