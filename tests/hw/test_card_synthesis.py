"""A cell is compared with its print under the light of the scene, so light changes no contrast."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tangy_hw.perception.cards.card_detection import find_cards
from tangy_hw.perception.cards.rectification import RectifiedGrid, flatten
from tangy_hw.perception.cards.synthesis import NAMES, compared
from tangy_profiles.activity import load_activity
from tangy_sim.rendering.card_chips import Chip
from tangy_sim.rendering.card_frames import CardCamera, View
from tangy_sim.rendering.card_odd_chips import odd_chip

VIEW = View(pixels=34, noise=1, quality=97, blur=0.4, size=(700, 560))
RED, WHITE = (0.2, 0.2, 0.9), (0.95, 0.95, 0.95)


@cache
def camera() -> CardCamera:
    return CardCamera(load_activity("bingo").deck, title="Bingo")


@cache
def seen(clear: float | None = None, tone: tuple[float, float, float] = RED) -> RectifiedGrid:
    """See card 17 straight on, with a chip of this transparency on cell 6, or none."""
    random = np.random.default_rng(4)
    chips = {}
    if clear is not None:
        chip = Chip(9.5, tone, clear, 0.05, 0.0, washed=True, sheer=True)
        chips[6] = chip.at(*camera().face.middle(6))
    picture = camera().take(17, chips, VIEW, random).picture
    grey = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY).astype(np.uint8)
    [card] = find_cards(grey)
    flat = flatten(picture, card, camera().face, 1)
    assert flat is not None
    return flat


def column(flat: RectifiedGrid, name: str) -> NDArray[Any]:
    expected = cv2.GaussianBlur(flat.expected, (0, 0), 0.55 / flat.scale).astype(np.float32) / 255
    told: NDArray[Any] = compared(flat, expected)[:, NAMES.index(name)]
    return told


def test_a_bare_number_keeps_the_contrast_of_its_print() -> None:
    flat = seen()
    for name in ("contrast of usual", "middle of usual"):
        assert np.abs(column(flat, name) - 1).max() < 0.2
    assert column(flat, "alike").min() > 0.9


@pytest.mark.slow
@given(light=st.floats(0.35, 1.0), lift=st.floats(0, 60), slope=st.floats(-0.3, 0.3))
@settings(max_examples=15, deadline=None)
def test_light_shade_and_haze_change_no_contrast(light: float, lift: float, slope: float) -> None:
    flat = seen(0.5)
    across = np.linspace(1 - abs(slope), 1, flat.picture.shape[1])[:: 1 if slope < 0 else -1]
    lit = np.clip(flat.picture * (0.7 * light * across)[None, :, None] + lift, 0, 255)
    changed = replace(flat, picture=lit.astype(np.uint8))
    assert np.abs(column(changed, "middle of usual") - column(flat, "middle of usual")).max() < 0.12


@pytest.mark.slow
@pytest.mark.parametrize("tone", [RED, WHITE])
def test_a_more_transparent_chip_shows_more_of_its_number(
    tone: tuple[float, float, float],
) -> None:
    for clear in (0.0, 0.3, 0.6, 0.8):
        found = column(seen(clear, tone), "middle of usual")[6]
        assert found == pytest.approx(clear, abs=0.12)
    others = np.delete(column(seen(0.5, tone), "middle of usual"), 6)
    assert others.min() > 0.75


@pytest.mark.slow
def test_odd_objects_are_drawn_at_their_cells() -> None:
    random = np.random.default_rng(8)
    empty = camera().take(17, {}, replace(VIEW, noise=0), np.random.default_rng(1)).picture
    for _ in range(12):
        thing = odd_chip(random).at(*camera().face.middle(12))
        taken = camera().take(17, {12: thing}, replace(VIEW, noise=0), np.random.default_rng(1))
        assert taken.marked == 1 << 12
        assert np.abs(taken.picture.astype(int) - empty).max() > 10
