"""Recognises faces with two ONNX models from the robot's profile, such as YuNet and SFace."""

from __future__ import annotations

import zlib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tangy_hw.perception.faces.face_detector import FaceError
from tangy_hw.perception.faces.quality import FaceQualityLimits
from tangy_hw.perception.faces.reader import NO_EYES, FaceReading
from tangy_profiles.given_file import read_given
from tangy_profiles.reading import plain

if TYPE_CHECKING:
    from tangy_hw.perception.pictures import Picture

SURE = 0.7  # detection threshold
LARGEST, SMALLEST = 1280, 240  # pixels: maximum of the longer side, minimum of the shorter
MOST_ENLARGED = 4.0
LARGEST_FILE = 500_000_000  # bytes; OpenCV's models have 0.2 and 39 million
LIMITS = FaceQualityLimits(contrast=12, evenness=0.15, symmetry=0.0)
"""These models tolerate turned faces and shadows better than the default reader."""


class OnnxReader:
    """A detector (as YuNet: boxes with five landmarks) and a recogniser (as SFace: a vector)."""

    def __init__(self, finder: Path, recogniser: Path, limits: FaceQualityLimits = LIMITS) -> None:
        """Load both models.

        Raises:
            FaceError: a file is missing, or not a model of this kind.
        """
        import cv2

        self.limits = limits
        _check(finder)
        self._finder: Any = _load(
            finder, "finds", lambda: cv2.FaceDetectorYN.create(str(finder), "", (320, 320), SURE)
        )
        self.kind = f"onnx{_check(recogniser):08x}"
        """Vectors of different recognisers are not comparable."""
        self._recogniser: Any = _load(
            recogniser, "tells apart", lambda: cv2.FaceRecognizerSF.create(str(recogniser), "")
        )

    def read(self, picture: Picture) -> list[FaceReading]:
        """Detect and describe the faces of an image (BGR), the largest first.

        Raises:
            FaceError: a model has unexpected inputs or outputs.
        """
        import cv2
        import numpy as np

        from tangy_hw.perception.faces.face_embedding import align
        from tangy_hw.perception.faces.quality import judge

        height, width = picture.shape[:2]
        scale = min(LARGEST / max(height, width), 1.0)
        if scale == 1.0:
            scale = max(1.0, min(MOST_ENLARGED, SMALLEST / min(height, width)))
        size = max(1, round(width * scale)), max(1, round(height * scale))
        how = cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC
        seen: Any = cv2.resize(picture, size, interpolation=how) if scale != 1 else picture
        grey: Any = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
        faces = []
        try:
            self._finder.setInputSize(size)
            rows = self._finder.detect(seen)[1]
            for row in sorted(rows if rows is not None else (), key=lambda row: -float(row[2])):
                x, y, w, h, ax, ay, bx, by = (float(value) / scale for value in row[:8])
                box = (x, y, w, h)
                if bx <= ax:
                    faces.append(FaceReading(box, NO_EYES))
                    continue
                quality = judge(grey, box, align(grey, ((ax, ay), (bx, by))))
                problem = quality.problem(self.limits)
                vector = None
                if not problem:
                    cut = self._recogniser.alignCrop(seen, row)
                    vector = np.array(self._recogniser.feature(cut), np.float32).ravel()
                    vector /= max(float(np.linalg.norm(vector)), 1e-9)
                faces.append(FaceReading(box, problem, quality, vector))
        except (cv2.error, ValueError, IndexError, TypeError):
            raise FaceError(
                "The ONNX files of the robot's profile do not do with a picture what "
                "YuNet and SFace do: name those."
            ) from None
        return faces


def _check(path: Path) -> int:
    """Return a checksum of a readable file."""
    shown = plain(str(path))
    if not path.exists():
        raise FaceError(f"{shown}: there is no such file, and the robot's profile names it.")
    content = read_given(path, LARGEST_FILE, FaceError)
    if not content:
        raise FaceError(f"{shown}: is no ONNX model: it is empty.")
    return zlib.crc32(content)


def _load(path: Path, does: str, load: Callable[[], object]) -> object:
    """Load a model, without OpenCV's messages for developers."""
    import cv2

    logging = cv2.utils.logging
    level = logging.getLogLevel()
    logging.setLogLevel(logging.LOG_LEVEL_SILENT)
    try:
        return load()
    except (cv2.error, AttributeError):
        raise FaceError(
            plain(f"{path}: is no ONNX model that {does} faces, or this OpenCV cannot read it.")
        ) from None
    finally:
        logging.setLogLevel(level)
