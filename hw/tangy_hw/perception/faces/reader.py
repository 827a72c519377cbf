"""Faces in a picture, each with its features, or with the reason why it has none."""

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
    """A face in a picture: where, how it is seen, and what it looks like.

    `vector` is None where it is not seen well enough, and `problem` says why.
    """

    box: Box
    problem: str = ""
    quality: Quality | None = None
    vector: Vector | None = None


class FaceReader(Protocol):
    """What finds faces and describes them. Vectors of another `kind` cannot be compared."""

    @property
    def kind(self) -> str:
        """Its name, in letters and digits."""

    def read(self, picture: Picture) -> list[FaceReading]:
        """Find and describe the faces of a picture (BGR), the largest first."""


class HaarReader:
    """The reader that needs no files: Haar cascades, and HOG and LBP of the aligned face."""

    kind = "hoglbp1"

    def __init__(self, limits: FaceQualityLimits = USUAL) -> None:
        """Read faces that are seen as well as `limits` say."""
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
    """Open the reader that the robot's profile asks for: that of its ONNX files, or the usual.

    Raises:
        FaceError: one of the files is missing, or no such model.
    """
    if models is None:
        return HaarReader()
    from tangy_hw.perception.faces.onnx import OnnxReader

    return OnnxReader(models.finder, models.recogniser)
