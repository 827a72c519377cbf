"""Selection of enrolment pictures: faces of good quality that differ from one another."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tangy_hw.perception.faces.gallery import LEAST
from tangy_hw.perception.faces.reader import NO_FACE

if TYPE_CHECKING:
    from tangy_hw.perception.faces.face_embedding import Vector
    from tangy_hw.perception.faces.reader import FaceReader, FaceReading
    from tangy_hw.perception.pictures import Picture

ADVISED = 10
"""So many pictures make somebody known well."""
MOST = 40
"""More than these say nothing new."""
SECOND = 0.6  # of the size of the first: a second face that may be the one that is meant
SAME = 0.95  # similarity (a cosine) from which on two pictures are as good as one
ODD = 5.0  # mean deviations below the median: not the person that the others show
LEAST_ODD = 0.08
FEWEST = 2  # pictures on one side, where they are divided in two
APART = 0.06
"""So much more alike (a cosine) within two sides than between them: it may be two people. Of ten
people, half of whom this was set on, 6 to 16 pictures of one person were so in 3 % of draws (of the
other half in none), those of two or three people mixed in 77 % (89 %).
"""


class Enrolment:
    """Enrols one person from pictures; `vectors` are the stored features."""

    def __init__(self, reader: FaceReader) -> None:
        """Begin without a picture."""
        self._reader = reader
        self._vectors: list[Vector] = []
        self._offered: list[int] = []  # which picture each of them is of; -1: of one before
        self._seen = 0

    def take(self, vectors: Any) -> None:
        """Take over the stored features (None: none)."""
        rows = [] if vectors is None else list(vectors)
        self._vectors += rows
        self._offered += [-1] * len(rows)

    def __len__(self) -> int:
        return len(self._vectors)

    def offer(self, picture: Picture) -> str:
        """Take a picture (BGR); return why it is refused, "" if it is not."""
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
        """Leave out the pictures that show somebody else, it seems.

        Returns:
            Which of the pictures that were offered (from 0) they are.
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
        """Say whether the pictures may show more than one person: whether they fall in two.

        They are divided where they differ most; the sides are then less alike than each in itself.
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
        """Return the features of the pictures that were offered, without those from before."""
        return [
            vector
            for vector, offered in zip(self._vectors, self._offered, strict=True)
            if offered >= 0
        ]

    def vectors(self) -> Any:
        """Return the features, a row for each picture."""
        import numpy as np

        return np.array(self._vectors, np.float32)


def one_face(faces: list[FaceReading]) -> tuple[str, Vector | None]:
    """Choose the face that a picture is of: the only one, or by far the largest.

    Returns:
        Why there is none ("" if there is), and its features.
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
