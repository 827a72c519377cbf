"""Where the faces are in a picture, and where their eyes are: the Haar cascades of OpenCV."""

from __future__ import annotations

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

LARGEST, SMALLEST = 720, 240  # pixels that the longer side is brought down to, the shorter up
MOST_ENLARGED = 4.0
LEAST_FACE = 28  # pixels across, of the picture as it is searched
FRONT = ("haarcascade_frontalface_alt2", "haarcascade_frontalface_default")
SIDE = "haarcascade_profileface"
EYES = (  # of the left and the right half of a face, as it is seen
    ("haarcascade_righteye_2splits", "haarcascade_eye"),
    ("haarcascade_lefteye_2splits", "haarcascade_eye"),
)
FACE = 200  # pixels that a face is brought to when its eyes are looked for
ROOM = ((20, 40, 110, 120), (90, 40, 180, 120))  # where they can be: left, top, right, bottom
APART = (0.28, 0.52)  # of the face's width
STEEPEST = 0.5  # rise of the line between them


class Found(NamedTuple):
    """A face: where it is, and its eyes, the one on the left of the picture first.

    Without eyes it is turned away, covered or no face.
    """

    box: Box
    eyes: tuple[Point, Point] | None


class FaceError(TangyError):
    """Faces cannot be told apart as things are; one sentence that says why."""


def find_faces(grey: Grey) -> list[Found]:
    """Find the faces in a grey picture, the largest first.

    Raises:
        FaceError: this OpenCV comes without cascades.
    """
    boxes = _boxes(grey)
    return [Found(box, find_eyes(grey, box)) for box in boxes]


def find_eyes(grey: Grey, box: Box) -> tuple[Point, Point] | None:
    """Find the eyes of a face; None unless both are there, as far apart as eyes are."""
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
                part, 1.08, 2, minSize=(28, 28), maxSize=(75, 75)
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
    middle = top + height / 2 - width / 2  # of what was cut out, which is square
    return (left + ax * scale, middle + ay * scale), (left + bx * scale, middle + by * scale)


def _boxes(grey: Grey) -> list[Box]:
    import cv2

    height, width = grey.shape
    scale = min(LARGEST / max(height, width), 1.0)
    if scale == 1.0:
        scale = max(1.0, min(MOST_ENLARGED, SMALLEST / min(height, width)))
    small = grey
    if scale != 1.0:
        how = cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC
        size = max(1, round(width * scale)), max(1, round(height * scale))
        small = cv2.resize(grey, size, interpolation=how)  # type: ignore[assignment]
    for name in FRONT:
        if boxes := _detect(name, small):
            break
    else:
        flat: Any = cv2.createCLAHE(3.0, (6, 6)).apply(small)  # of faces in shade
        boxes = _detect(FRONT[0], flat) or _detect(SIDE, flat)
        if not boxes:
            mirrored = _detect(SIDE, flat[:, ::-1].copy())
            boxes = [(small.shape[1] - x - w, y, w, h) for x, y, w, h in mirrored]
    boxes.sort(key=lambda box: -box[2])
    return [(x / scale, y / scale, w / scale, h / scale) for x, y, w, h in boxes]


def _detect(name: str, grey: Any) -> list[Box]:
    found = _cascade(name).detectMultiScale(grey, 1.1, 3, minSize=(LEAST_FACE, LEAST_FACE))
    return [(float(x), float(y), float(w), float(h)) for x, y, w, h in found]


def _cut(grey: Grey, x: float, y: float, side: float) -> Any:
    """Cut a square out of a picture, brought to the size at which eyes are looked for."""
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
    """Load a cascade; it keeps state while it searches, so a process searches one by one."""
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
