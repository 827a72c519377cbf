"""Finds the faces in an image, each with its features, or with the reason why it has none."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from tangy_hw.perception.faces.quality import USUAL, FaceQualityLimits, Quality

if TYPE_CHECKING:
    from tangy_hw.perception.faces.face_detector import Box
    from tangy_hw.perception.faces.face_embedding import Vector
    from tangy_hw.perception.pictures import Picture
    from tangy_profiles.robot import FaceModels

NO_FACE = "no face is seen"
NO_EYES = "the eyes are not both seen: look at the camera"


@dataclass(frozen=True, slots=True, eq=False)
class FaceReading:
    """A face in an image: its box, its quality, and its features.

    `vector` is None if the quality is too low, and `problem` says why.
    """

    box: Box
    problem: str = ""
    quality: Quality | None = None
    vector: Vector | None = None


class FaceReader(Protocol):
    """Detects and describes faces. Vectors of different `kind` are not comparable."""

    @property
    def kind(self) -> str:
        """Its name, in letters and digits."""

    def read(self, picture: Picture) -> list[FaceReading]:
        """Find and describe the faces of a picture (BGR), the largest first."""


class HaarReader:
    """The reader that needs no files: Haar cascades, and HOG and LBP of the aligned face."""

    kind = "hoglbp1"

    def __init__(self, limits: FaceQualityLimits = USUAL) -> None:
        """Prepare a reader with these quality limits."""
        self.limits = limits

    def read(self, picture: Picture) -> list[FaceReading]:
        """Find and describe the faces of a picture (BGR or grey), the largest first."""
        import cv2

        from tangy_hw.perception.faces.face_detector import find_faces
        from tangy_hw.perception.faces.face_embedding import align, describe
        from tangy_hw.perception.faces.quality import judge

        grey: Any = picture
        if picture.ndim == 3:
            grey = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
        faces = []
        for box, eyes in find_faces(grey):
            if eyes is None:
                faces.append(FaceReading(box, NO_EYES))
                continue
            aligned = align(grey, eyes)
            quality = judge(grey, box, aligned)
            problem = quality.problem(self.limits)
            faces.append(FaceReading(box, problem, quality, None if problem else describe(aligned)))
        return faces


def open_reader(models: FaceModels | None = None) -> FaceReader:
    """Open the reader of the robot's profile: with its ONNX models, or the default one.

    Raises:
        FaceError: a model is missing or invalid.
    """
    if models is None:
        return HaarReader()
    from tangy_hw.perception.faces.onnx import OnnxReader

    return OnnxReader(models.finder, models.recogniser)
