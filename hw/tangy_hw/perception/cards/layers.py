"""Layers of a rectified grid: its pixels relative to the card's paper and print."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from tangy_hw.perception.cards.rectification import RIM, RectifiedGrid

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Real = NDArray[Any]


@dataclass(frozen=True)
class CardLayers:
    """A rectified grid relative to its paper; each layer (rows, columns), 1 for paper.

    `shown` (rows, columns, 3) is the colour, `light` its brightness and `tint` its difference from
    grey, relative to the paper `near` each pixel (rows, columns, 3); `full_light` and `full_tint`
    are relative to `paper` (3,), the median over the card. `expected` is the blurred print, 0 to 1,
    `lighter` the brightness above it in this card's ink, `dye` (rows, columns, 2) two colour
    differences. `overexposed` pixels have no colour.
    """

    shown: Real
    light: Real
    tint: Real
    near: Real
    paper: Real
    full_light: Real
    full_tint: Real
    expected: Real
    lighter: Real
    dye: Real
    overexposed: Real


def layers_of(flat: RectifiedGrid) -> CardLayers:
    """Measure the pixels of a rectified grid."""
    import cv2
    import numpy as np

    smooth = cv2.GaussianBlur(flat.picture, (3, 3), 0)
    colour = smooth.astype(np.float32) + 1
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (25, 25))
    near = cv2.GaussianBlur(cv2.dilate(smooth, kernel).astype(np.float32) + 1, (0, 0), 8)
    shown = colour / near
    light, tint = _light_and_tint(shown)
    paper = np.median(near[RIM:-RIM:4, RIM:-RIM:4].reshape(-1, 3), 0)
    full_light, full_tint = _light_and_tint(colour / paper)
    blurred = cv2.GaussianBlur(flat.expected, (0, 0), min(2.5, 0.55 / flat.scale))
    expected = blurred.astype(np.float32) / 255
    inked = light[(expected < 0.25)]
    ink = float(np.clip(np.percentile(inked, 30), 0.02, 0.7)) if inked.size else 0.3
    lighter = light - (ink + (1 - ink) * expected)
    dye = shown[..., (2, 0)] - shown[..., 1:2]
    dye -= np.median(dye[RIM:-RIM:4, RIM:-RIM:4].reshape(-1, 2), 0)
    least = cv2.min(cv2.min(*cv2.split(flat.picture)[:2]), flat.picture[..., 2])
    return CardLayers(
        shown, light, tint, near, paper, full_light, full_tint, expected, lighter, dye, least > 250
    )


def half_maps(layers: CardLayers) -> Real:
    """Return half-size maps: (rows, columns, 10).

    They are: difference from grey, change of brightness, brightness, red and blue; difference from
    grey and brightness relative to the whole card; overexposure, and two squares for deviations.
    """
    import cv2
    import numpy as np

    shown, light, tint = layers.shown, layers.light, layers.tint
    whole = [
        tint, np.abs(layers.lighter), light,
        shown[..., 2] - shown[..., 1], shown[..., 0] - shown[..., 1],
        layers.full_light, layers.full_tint, layers.overexposed, tint**2, light**2,
    ]  # fmt: skip
    size = light.shape[1] // 2, light.shape[0] // 2
    halved = [cv2.resize(x.astype(np.float32), size, interpolation=cv2.INTER_AREA) for x in whole]
    return np.stack(halved, -1)


def _light_and_tint(picture: Real) -> tuple[Real, Real]:
    """Return the brightness of each pixel, and its difference from grey."""
    import cv2

    blue, green, red = cv2.split(picture)
    light = (blue + green + red) / 3
    return light, cv2.max(cv2.max(blue, green), red) - cv2.min(cv2.min(blue, green), red)
