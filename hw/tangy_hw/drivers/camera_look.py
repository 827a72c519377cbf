"""Measures an image: brightness, contrast and sharpness, each from 0 to 1."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Image: TypeAlias = NDArray[np.uint8]

SIDE = 640  # pixels of width at which sharpness is measured: averages sensor noise out
FINE, COARSE = 1.0, 4.0  # pixels: sigma of the two blurs that are compared
EDGES = 0.99  # quantile of the differences that counts as the strongest edges
NOISE = 3.0  # ratio of noise between this quantile and the median; 3.8 for pure Gaussian noise
WEAKEST = 6  # of 255: below this, there are no edges
SOFT = 5  # of 255: above this change over a tenth of the image, there should be edges
SOFTEST = 4  # scale factor of the smaller image for this check
SMALLEST = 32  # pixels: smaller images have no sharpness


class Look(NamedTuple):
    """Measures of one frame.

    `stamp` is of the monotonic clock, in s; `fingerprint` is a checksum of the pixels. `sharpness`
    is None if nothing in the frame could be sharp.
    """

    seq: int
    stamp: float
    brightness: float
    contrast: float
    sharpness: float | None
    fingerprint: int
    width: int
    height: int


def measure(image: Image, seq: int, stamp: float) -> Look:
    """Measure an image (BGR or grey) taken at a time in s."""
    import zlib

    import cv2

    height, width = image.shape[:2]
    grey: Any = image if image.ndim == 2 else cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
    if width > SIDE:
        size = (SIDE, max(1, round(height * SIDE / width)))
        grey = cv2.resize(grey, size, interpolation=cv2.INTER_AREA)
    mean, spread = cv2.meanStdDev(grey)
    return Look(
        seq,
        stamp,
        float(mean[0, 0]) / 255,
        float(spread[0, 0]) / 255,
        _sharpness(grey),
        zlib.crc32(image.data if image.flags.c_contiguous else image.tobytes()),
        width,
        height,
    )


def _sharpness(grey: Any) -> float | None:
    """Compare fine with coarse differences at the strongest edges.

    A ratio depends little on the scene; measured at strong edges with the noise subtracted, it also
    depends little on noise.
    """
    import cv2

    if min(grey.shape) < SMALLEST:
        return None
    middle, fine = _differs(grey, FINE)
    _, coarse = _differs(grey, COARSE)
    noise = NOISE * middle  # most of an image is not edges
    if coarse >= WEAKEST + noise:
        return min(1.0, math.sqrt(max(0.0, fine**2 - noise**2) / (coarse**2 - noise**2)))
    small = cv2.resize(grey, None, fx=1 / SOFTEST, fy=1 / SOFTEST, interpolation=cv2.INTER_AREA)
    return 0.0 if _differs(small, COARSE)[1] >= SOFT else None


def _differs(grey: Any, blur: float) -> tuple[float, float]:
    """Return the median and edge quantile of the differences between an image and its blur."""
    import cv2
    import numpy as np

    difference: Any = cv2.absdiff(grey, cv2.GaussianBlur(grey, (0, 0), blur))
    counts = cv2.calcHist([difference], [0], None, [256], [0, 256])[:, 0]
    total = np.concatenate(([0.0], np.cumsum(counts) / difference.size))
    most, edges = np.interp((0.5, EDGES), total, np.arange(257.0))
    return float(most), float(edges)
