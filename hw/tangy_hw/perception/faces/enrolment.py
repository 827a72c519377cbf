"""Selects enrolment images: faces of good quality that differ from one another."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tangy_hw.perception.faces.gallery import LEAST
from tangy_hw.perception.faces.reader import NO_FACE

if TYPE_CHECKING:
    from tangy_hw.perception.faces.face_embedding import Vector
    from tangy_hw.perception.faces.reader import FaceReader, FaceReading
    from tangy_hw.perception.pictures import Picture

ADVISED = 10
"""Recommended number of images of a person."""
MOST = 40
"""Maximum number of images; more add nothing."""
SECOND = 0.6  # size ratio from which a second face may be the one that is meant
SAME = 0.95  # cosine similarity from which two images are redundant
ODD = 5.0  # mean absolute deviations below the median: an image of another person
LEAST_ODD = 0.08
FEWEST = 2  # images per cluster
APART = 0.06
"""Difference between the cosine similarity within two clusters and between them from which they may
be two people. Of 6 to 16 images of one of ten people, 3 % of draws exceeded it (none for the half
of the people that it was not chosen on), of images of two or three people mixed, 77 % (89 %)."""


class Enrolment:
    """Enrols one person from images; `vectors` are the stored features."""

    def __init__(self, reader: FaceReader) -> None:
        """Start without images."""
        self._reader = reader
        self._vectors: list[Vector] = []
        self._offered: list[int] = []  # number of the image of each vector; -1: stored before
        self._seen = 0

    def take(self, vectors: Any) -> None:
        """Add stored features (None: none)."""
        rows = [] if vectors is None else list(vectors)
        self._vectors += rows
        self._offered += [-1] * len(rows)

    def __len__(self) -> int:
        return len(self._vectors)

    def offer(self, picture: Picture) -> str:
        """Add an image (BGR); return why it was rejected, "" if it was not."""
        self._seen += 1
        problem, vector = one_face(self._reader.read(picture))
        if vector is None:
            return problem
        if len(self._vectors) >= MOST:
            return f"there are {MOST} already, and more say nothing new"
        if any(float(other @ vector) >= SAME for other in self._vectors):
            return "it shows what another one shows: move the head a little"
        self._vectors.append(vector)
        self._offered.append(self._seen - 1)
        return ""

    def drop_odd(self) -> list[int]:
        """Remove the images that seem to show another person.

        Returns:
            Their numbers among the offered images (from 0).
        """
        odd = self._odd()
        dropped = [self._offered[number] for number in odd if self._offered[number] >= 0]
        keep = [number for number in range(len(self._vectors)) if number not in odd]
        self._vectors = [self._vectors[number] for number in keep]
        self._offered = [self._offered[number] for number in keep]
        return dropped

    def _odd(self) -> list[int]:
        import numpy as np

        if len(self._vectors) <= LEAST:
            return []
        rows = np.array(self._vectors)
        similar = rows @ rows.T
        np.fill_diagonal(similar, -1)
        own = np.sort(similar, axis=1)[:, -2:].mean(axis=1)
        middle = float(np.median(own))
        spread = float(np.median(np.abs(own - middle)))
        low = middle - max(ODD * spread, LEAST_ODD)
        return [int(number) for number in np.flatnonzero(own < low)]

    def several(self) -> bool:
        """Return whether the images may show more than one person, because they form two clusters.

        They are divided along the first principal component; similarity within the clusters is then
        compared with that between them.
        """
        import numpy as np

        count = len(self._vectors)
        if count < 2 * FEWEST:
            return False
        rows = np.array(self._vectors, np.float64)
        similar = rows @ rows.T
        centred = rows - rows.mean(axis=0)
        side = np.linalg.eigh(centred @ centred.T)[1][:, -1] > 0
        if min(side.sum(), count - side.sum()) < FEWEST:
            return False
        same = side[:, None] == side[None, :]
        pairs = np.triu(np.ones_like(same), 1)
        return bool(similar[pairs & same].mean() - similar[pairs & ~same].mean() > APART)

    def added(self) -> list[Vector]:
        """Return the features of the offered images, without those stored before."""
        return [
            vector
            for vector, offered in zip(self._vectors, self._offered, strict=True)
            if offered >= 0
        ]

    def vectors(self) -> Any:
        """Return the features, a row for each image."""
        import numpy as np

        return np.array(self._vectors, np.float32)


def one_face(faces: list[FaceReading]) -> tuple[str, Vector | None]:
    """Choose the face of an image: the only one, or by far the largest.

    Returns:
        Why there is none ("" if there is one), and its features.
    """
    if not faces:
        return NO_FACE, None
    first = faces[0]
    rivals = [face for face in faces[1:] if face.box[2] >= SECOND * first.box[2]]
    if any(face.vector is not None for face in rivals):
        if first.vector is not None:
            return "more than one face is seen", None
        first = next(face for face in rivals if face.vector is not None)
    return first.problem, first.vector
