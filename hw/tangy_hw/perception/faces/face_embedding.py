"""Describes a face by features that change little with light: HOG and LBP of its relief."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from tangy_hw.perception.faces.face_detector import Grey, Point

    Vector: TypeAlias = NDArray[np.float32]

WIDTH, HEIGHT = 80, 104  # pixels of an aligned face
EYES_APART, EYES_DOWN = 40.0, 32.0  # pixels between the eyes, and from the top to the eyes
CELL = 8  # pixels of a HOG cell
RADIUS = 2  # pixels of LBP
ROWS, COLUMNS = 8, 7  # LBP cells
HOG_SHARE = 0.3125  # weight that makes both equally discriminative: LBP varies less


def align(grey: Grey, eyes: tuple[Point, Point]) -> Grey:
    """Rotate, scale and crop a face so that its eyes are at fixed positions."""
    import cv2
    import numpy as np

    (ax, ay), (bx, by) = eyes
    dx, dy = bx - ax, by - ay
    apart = max(float(np.hypot(dx, dy)), 1e-3)
    scale = EYES_APART / apart
    cos, sin = dx / apart * scale, dy / apart * scale
    x, y = (ax + bx) / 2, (ay + by) / 2
    turn = np.array(
        [[cos, sin, WIDTH / 2 - cos * x - sin * y], [-sin, cos, EYES_DOWN + sin * x - cos * y]]
    )
    smooth: Any = grey
    if scale < 0.7:  # several pixels become one
        smooth = cv2.GaussianBlur(grey, (0, 0), 0.45 / scale)
    how = cv2.INTER_LINEAR if scale < 1 else cv2.INTER_CUBIC
    face: Any = cv2.warpAffine(
        smooth, turn, (WIDTH, HEIGHT), flags=how, borderMode=cv2.BORDER_REPLICATE
    )
    return face  # type: ignore[no-any-return]


def describe(face: Grey) -> Vector:
    """Return the features of an aligned face, as a vector of length 1."""
    import numpy as np

    relief = _relief(face)
    hog, lbp = _hog(relief), _lbp(relief)
    hog *= np.sqrt(HOG_SHARE) / max(float(np.linalg.norm(hog)), 1e-9)
    lbp *= np.sqrt(1 - HOG_SHARE) / max(float(np.linalg.norm(lbp)), 1e-9)
    return np.concatenate((hog, lbp))


def symmetry(face: Grey) -> float:
    """Return the cosine similarity (a ratio up to 1) of an aligned face and its mirror image."""
    import numpy as np

    relief = _relief(face)
    a, b = _hog(relief), _hog(np.ascontiguousarray(relief[:, ::-1]))
    return float(a @ b / max(float(np.linalg.norm(a) * np.linalg.norm(b)), 1e-9))


def _relief(face: Grey) -> Grey:
    """Normalise the illumination of a face (after Tan and Triggs, 2010)."""
    import cv2
    import numpy as np

    bright: Any = ((face.astype(np.float32) + 1) / 256) ** 0.2
    edges = cv2.GaussianBlur(bright, (0, 0), 1.0) - cv2.GaussianBlur(bright, (0, 0), 2.0)
    edges /= np.mean(np.abs(edges) ** 0.1) ** 10 + 1e-6
    edges /= np.mean(np.minimum(np.abs(edges), 10) ** 0.1) ** 10 + 1e-6
    relief: Grey = np.clip(128 + 120 * np.tanh(edges / 10), 0, 255).astype(np.uint8)
    return relief


def _hog(relief: Grey) -> Vector:
    return _hog_descriptor().compute(relief).ravel()  # type: ignore[no-any-return]


@cache
def _hog_descriptor() -> Any:
    import cv2

    block, cell = (2 * CELL, 2 * CELL), (CELL, CELL)
    return cv2.HOGDescriptor(
        (WIDTH, HEIGHT), block, cell, cell, 9, 1, -1, cv2.HOGDESCRIPTOR_L2HYS, 0.2, True, 64, True
    )


def _lbp(relief: Grey) -> Vector:
    """Return the square root of the share of each uniform pattern in each cell."""
    import cv2
    import numpy as np

    light: Any = relief.astype(np.float32)
    height, width = light.shape
    r, d = RADIUS, RADIUS * 0.7071
    middle = light[r:-r, r:-r]
    codes = np.zeros(middle.shape, np.uint8)
    ring = ((0, r), (d, d), (r, 0), (d, -d), (0, -r), (-d, -d), (-r, 0), (-d, d))
    for bit, (down, right) in enumerate(ring):
        shift = np.array([[1, 0, right], [0, 1, down]], np.float32)
        there = cv2.warpAffine(
            light, shift, (width, height), flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
        )
        codes |= (there[r:-r, r:-r] >= middle - 0.01).astype(np.uint8) << bit
    numbers, kinds = _uniform()
    rows = np.minimum(np.arange(codes.shape[0]) * ROWS // codes.shape[0], ROWS - 1)
    columns = np.minimum(np.arange(codes.shape[1]) * COLUMNS // codes.shape[1], COLUMNS - 1)
    cells = rows[:, None] * COLUMNS + columns[None, :]
    counts = np.bincount(
        (cells * kinds + numbers[codes]).ravel(), minlength=ROWS * COLUMNS * kinds
    ).reshape(-1, kinds)
    shares = counts / counts.sum(axis=1, keepdims=True)
    return np.sqrt(shares).astype(np.float32).ravel()  # type: ignore[no-any-return]


@cache
def _uniform() -> tuple[Any, int]:
    """Number the uniform patterns (at most two changes around the ring); others share one."""
    import numpy as np

    numbers = np.zeros(256, np.int64)
    kinds = 0
    for code in range(256):
        bits = [code >> bit & 1 for bit in range(8)]
        if sum(bits[i] != bits[i - 1] for i in range(8)) <= 2:
            numbers[code] = kinds
            kinds += 1
        else:
            numbers[code] = -1
    numbers[numbers < 0] = kinds
    return numbers, kinds + 1
