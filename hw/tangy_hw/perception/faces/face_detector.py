"""Detects faces and their eyes with OpenCV's Haar cascades."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from tangy_profiles.errors import TangyError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Grey: TypeAlias = NDArray[np.uint8]

Point = tuple[float, float]
Box = tuple[float, float, float, float]
"""Left, top, width and height, in pixels."""

LARGEST, SMALLEST = 720, 240  # pixels: maximum of the longer side, minimum of the shorter
MOST_ENLARGED = 4.0
GLANCE = 480  # pixels of the longer side in a first search for near faces
LEAST_FACE = 22, 24  # pixels across in the searched image: thorough, coarse
FRONT = ("haarcascade_frontalface_alt2", "haarcascade_frontalface_default")
SIDE = "haarcascade_profileface"
EYES = (  # for the left and right half of a face, as seen
    ("haarcascade_righteye_2splits", "haarcascade_eye"),
    ("haarcascade_lefteye_2splits", "haarcascade_eye"),
)
FACE = 120  # pixels of a face in which eyes are searched
ROOM = ((12, 24, 66, 72), (54, 24, 108, 72))  # regions of the eyes: left, top, right, bottom
EYE = 20, 46  # pixels across of eye detections
APART = (0.28, 0.52)  # of the face's width
STEEPEST = 0.5  # slope of the line between them


class DetectedFace(NamedTuple):
    """A face: its box, and its eyes, the left one in the image first.

    Without eyes it is turned away, covered, or not a face.
    """

    box: Box
    eyes: tuple[Point, Point] | None


class FaceError(TangyError):
    """Faces cannot be recognised; one sentence that says why."""


def find_faces(grey: Grey) -> list[DetectedFace]:
    """Find the faces in a grey image, the largest first.

    Raises:
        FaceError: this OpenCV has no cascades.
    """
    first: list[DetectedFace] = []
    for boxes in _searches(grey):
        found = [DetectedFace(box, find_eyes(grey, box)) for box in sorted(boxes, key=_smaller)]
        if any(face.eyes is not None for face in found):
            return found
        first = first or found
    return first


def find_eyes(grey: Grey, box: Box) -> tuple[Point, Point] | None:
    """Find the eyes of a face; None unless both are found at a plausible distance."""
    import numpy as np

    left, top, width, height = box
    face = _cut(grey, left + width / 2, top + height / 2, width)
    eyes: list[Point] = []
    for names, (x0, y0, x1, y1) in zip(EYES, ROOM, strict=True):
        part = np.ascontiguousarray(face[y0:y1, x0:x1])
        seen = [
            (x + w / 2 + x0, y + h / 2 + y0)
            for name in names
            for x, y, w, h in _cascade(name).detectMultiScale(
                part, 1.08, 2, minSize=(EYE[0], EYE[0]), maxSize=(EYE[1], EYE[1])
            )
        ]
        if not seen:
            return None
        x, y = np.median(np.array(seen), axis=0)
        eyes.append((float(x), float(y)))
    (ax, ay), (bx, by) = eyes
    if not APART[0] * FACE < bx - ax < APART[1] * FACE or abs(by - ay) > STEEPEST * (bx - ax):
        return None
    scale = width / FACE
    middle = top + height / 2 - width / 2  # of the square that was cut out
    return (left + ax * scale, middle + ay * scale), (left + bx * scale, middle + by * scale)


def _searches(grey: Grey) -> Iterator[list[Box]]:
    """Search an image in several ways, the quickest and usually sufficient first."""
    import cv2

    if max(grey.shape) > 1.25 * GLANCE:
        yield _detect(FRONT[0], *_sized(grey, GLANCE), coarse=True)
    closely = _detect(FRONT[0], *_sized(grey, LARGEST))
    yield closely
    if closely:
        return
    small, scale = _sized(grey, GLANCE)
    yield _detect(FRONT[1], small, scale)
    flat = cv2.createCLAHE(3.0, (6, 6)).apply(small)  # for faces in shadow
    yield _detect(FRONT[0], flat, scale)
    yield _detect(SIDE, flat, scale)
    mirrored = _detect(SIDE, flat[:, ::-1].copy(), scale)
    yield [(grey.shape[1] - x - w, y, w, h) for x, y, w, h in mirrored]


def _sized(grey: Grey, largest: int) -> tuple[Any, float]:
    """Limit the longer side of an image to `largest` pixels, and enlarge small images."""
    import cv2

    height, width = grey.shape
    scale = min(largest / max(height, width), 1.0)
    if scale == 1.0:
        scale = max(1.0, min(MOST_ENLARGED, SMALLEST / min(height, width)))
    if scale == 1.0:
        return grey, scale
    how = cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC
    size = max(1, round(width * scale)), max(1, round(height * scale))
    return cv2.resize(grey, size, interpolation=how), scale


def _detect(name: str, grey: Any, scale: float, *, coarse: bool = False) -> list[Box]:
    step, times, least = (1.2, 2, LEAST_FACE[1]) if coarse else (1.1, 3, LEAST_FACE[0])
    found = _cascade(name).detectMultiScale(grey, step, times, minSize=(least, least))
    boxes: list[Box] = []
    for x, y, w, h in found:
        boxes.append((float(x) / scale, float(y) / scale, float(w) / scale, float(h) / scale))
    return boxes


def _smaller(box: Box) -> float:
    """Return the sort key of boxes, largest first."""
    return -box[2]


def _cut(grey: Grey, x: float, y: float, side: float) -> Any:
    """Cut out a square, scaled for the search for eyes."""
    import cv2
    import numpy as np

    scale = FACE / side
    turn = np.array([[scale, 0, FACE / 2 - scale * x], [0, scale, FACE / 2 - scale * y]])
    smooth: Any = cv2.GaussianBlur(grey, (0, 0), 0.4 / scale) if scale < 0.5 else grey
    return cv2.warpAffine(
        smooth, turn, (FACE, FACE), flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )


@cache
def _cascade(name: str) -> Any:
    """Load a cascade; it is stateful, so use it from one thread at a time."""
    import cv2

    data = getattr(cv2, "data", None)
    if hasattr(cv2, "CascadeClassifier") and data is not None:
        path = Path(data.haarcascades) / f"{name}.xml"
        if path.is_file():
            cascade = cv2.CascadeClassifier(str(path))
            if not cascade.empty():
                return cascade
    raise FaceError(
        f"This OpenCV ({cv2.__version__}) comes without {name}: install "
        f"opencv-python-headless 4, or name two ONNX files in the robot's profile."
    )
