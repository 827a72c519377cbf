"""Context from a card's other cells: hands are large, chips alike, numbers from the deck."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tangy_hw.perception.cards.classifier import TURNS, load_classifier, turned
from tangy_hw.perception.cards.context import LOOKS, NAMES, context_of
from tangy_hw.perception.cards.extent import NAMES as REACHING
from tangy_hw.perception.cards.extent import same_ways
from tangy_hw.perception.cards.features import NAMES as FEATURES
from tangy_hw.perception.cards.features import SEEN, SPOTS
from tangy_hw.perception.cards.reader import CardReader
from tangy_profiles.activity import Activity

BARE, CHIP, HAND = (0.998, 0.001, 0.001), (0.001, 0.998, 0.001), (0.001, 0.001, 0.998)


def around(parts: NDArray[Any], looks: NDArray[Any] | None = None) -> dict[str, NDArray[Any]]:
    """Return the context of each of a card's 5 x 5 cells, by name of the feature."""
    seen = np.zeros((25, len(LOOKS))) if looks is None else looks
    rows = context_of(parts[None], seen[None], np.zeros((1, 25)), 5)[0]
    return {name: rows[:, place] for place, name in enumerate(NAMES)}


def test_the_context_of_a_cell_includes_a_hand_beside_it() -> None:
    parts = np.array([BARE] * 25)
    parts[12] = HAND
    told = around(parts)
    near = {6, 7, 8, 11, 13, 16, 17, 18}
    assert {int(cell) for cell in np.flatnonzero(told["near hidden most"] > 0.9)} == near
    assert set(np.flatnonzero(told["beside hidden most"] > 0.9)) == {7, 11, 13, 17}
    assert told["any hidden"][12] < 0.1 < told["any hidden"][0]  # it does not count itself


def test_a_cell_is_compared_with_chips_and_paper_of_its_card() -> None:
    parts = np.array([CHIP] * 5 + [BARE] * 20)
    looks = np.where(np.arange(25)[:, None] < 5, 2.0, 0.0) * np.ones(len(LOOKS))
    looks[24] = 2.0  # looks like a chip, but was taken for paper
    told = around(parts, looks)
    assert abs(told["unlike marked"][24]) < 0.2 < 1.5 < told["unlike unmarked"][24]
    assert told["unlike marked"][10] > 1.5
    assert np.isclose(told["marks"][10], 5 / 24, atol=0.01)
    assert np.isclose(told["marks"][0], 4 / 24, atol=0.01)


def test_a_finger_reaches_beyond_its_cell_and_a_chip_does_not() -> None:
    v, u = np.mgrid[0:80, 0:80]
    tones = np.zeros((80, 80, 3), np.float32)
    tones[..., 0] = 1.0  # paper
    skin = np.array([0.6, 0.25, -0.1], np.float32)
    tones[np.hypot(v - 40, u - 20) < 6] = skin
    tones[(np.abs(u - 60) < 6) & (v < 46)] = skin  # it comes from above
    y, x = np.array([40, 40]), np.array([20, 60])
    columns = same_ways(tones, y, x, np.stack([skin, skin]), 16)
    told = dict(zip(REACHING, np.array(columns), strict=True))
    assert told["same way far"].tolist() == pytest.approx([1.0, 0.0], abs=1e-3)
    assert told["same ways"][0] == 0 < told["same ways"][1] < 0.3
    assert told["same longest"].tolist() == [0.0, 1.0]


def test_the_context_marks_the_cells_at_the_rim_of_any_grid() -> None:
    rows = context_of(
        np.full((2, 12, 3), 1 / 3), np.zeros((2, 12, len(LOOKS))), np.zeros((2, 12)), 4
    )
    assert rows.shape == (2, 12, len(NAMES)) and np.isfinite(rows).all()
    assert rows[0, :, NAMES.index("rim")].tolist() == [1] * 5 + [0, 0] + [1] * 5


@pytest.mark.slow
def test_the_features_of_a_cell_do_not_depend_on_its_rotation() -> None:
    features = len(FEATURES) + len(SEEN) * SPOTS**2
    ways = {tuple(turned(turn)) for turn in range(TURNS)}
    assert len(ways) == TURNS
    assert all(sorted(way) == list(range(features)) for way in ways)
    random = np.random.default_rng(2)
    classifier = load_classifier()
    rows = classifier.alone.centre + random.normal(0, 1, (25, features)) * classifier.alone.spread
    beside = np.zeros(25)
    parts = classifier.probabilities(rows.astype(np.float32), beside, 5)
    assert np.allclose(parts.sum(1), 1, atol=1e-5)
    other = classifier.probabilities(rows[:, turned(5)].astype(np.float32), beside, 5)
    assert np.allclose(parts, other, atol=1e-4)


@pytest.mark.parametrize(
    ("own", "legible", "agree"),
    [(4, 4, True), (3, 3, False), (9, 17, True), (11, 23, True), (7, 15, False), (5, 24, False)],
)
def test_some_numbers_of_a_card_agree_by_chance_but_not_many(
    activity: Activity, own: int, legible: int, agree: bool
) -> None:
    assert CardReader(activity.deck).agree(own, legible) is agree
