"""Identifies a face among enrolled people; "unknown" is a possible answer.

The enrolled images alone calibrate the threshold: each is compared with the other images of its
person, and with those of other people. On the scale of `likeness`, 0 is the mean similarity of
different people, and a face with .4 or more is recognised.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tangy_hw.perception.faces.face_embedding import Vector

ENOUGH = 0.4
"""Likeness from which a face is recognised; 1 is the median similarity to oneself."""
SPREAD = 2.0  # standard deviations between the threshold and other people
AHEAD = 0.1
"""Required lead in likeness over everybody else."""
BEST = 2  # most similar images of a person that count
LEAST = 3
"""Minimum images of a person from which their variation can be estimated."""
ALONE = 0.1  # share of one's own images below the threshold if nobody else is enrolled
LEAST_GAP = 0.01  # between others and the threshold: images may be identical


@dataclass(frozen=True, slots=True)
class FaceMatch:
    """An identification: None is unknown; `nearest` is the most similar person."""

    person: str | None
    nearest: str | None
    likeness: float
    likenesses: Mapping[str, float] = field(default_factory=dict)


class Gallery:
    """Enrolled faces: for each person rows of unit feature vectors of one kind."""

    def __init__(self, faces: Mapping[str, Any]) -> None:
        """Calibrate the threshold from the enrolled images."""
        import numpy as np

        self.people = tuple(sorted(faces))
        rows = [np.asarray(faces[person], np.float32) for person in self.people]
        ends = np.cumsum([0, *(len(row) for row in rows)])
        self._spans = list(zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True))
        self._all = np.concatenate(rows) if rows else np.zeros((0, 1), np.float32)
        self.stranger, self.threshold = self._scale()
        """Mean cosine similarity to another person, and the threshold."""

    def compare(self, vector: Vector) -> FaceMatch:
        """Identify a face; unknown if no person matches clearly."""
        if not self.people:
            return FaceMatch(None, None, 0.0)
        similar = self._all @ vector
        unit = (self.threshold - self.stranger) / ENOUGH
        likenesses = {
            person: (_most(similar[a:b]) - self.stranger) / unit
            for person, (a, b) in zip(self.people, self._spans, strict=True)
        }
        return decide(likenesses)

    def _scale(self) -> tuple[float, float]:
        """Compare each enrolled image with those of its person, and of other people."""
        import numpy as np

        similar = self._all @ self._all.T
        own: list[float] = []
        others: list[float] = []
        for a, b in self._spans:
            for row in range(a, b):
                rest = np.delete(similar[row, a:b], row - a)
                if len(rest):
                    own.append(_most(rest))
                apart = [_most(similar[row, c:d]) for c, d in self._spans if c != a and d > c]
                if apart:
                    others.append(max(apart))
        if not own:
            return 0.0, 1.0
        oneself = float(np.median(own))
        if others:
            stranger = float(np.mean(others))
            enough = stranger + ENOUGH * (oneself - stranger)
            enough = max(enough, stranger + SPREAD * float(np.std(others)))
        else:
            enough = min(float(np.quantile(own, ALONE)), oneself - LEAST_GAP)
            stranger = oneself - (oneself - enough) / (1 - ENOUGH)
        return min(stranger, enough - LEAST_GAP), enough


def decide(likenesses: Mapping[str, float]) -> FaceMatch:
    """Identify a face by its likeness (a score) to each enrolled person."""
    ranked = sorted(likenesses, key=lambda person: -likenesses[person])
    if not ranked:
        return FaceMatch(None, None, 0.0)
    first = likenesses[ranked[0]]
    ahead = len(ranked) < 2 or first - likenesses[ranked[1]] >= AHEAD
    sure = first >= ENOUGH and ahead
    return FaceMatch(ranked[0] if sure else None, ranked[0], first, dict(likenesses))


def _most(similar: Any) -> float:
    """Return the mean of the best few."""
    import numpy as np

    return float(np.sort(similar)[-BEST:].mean())
