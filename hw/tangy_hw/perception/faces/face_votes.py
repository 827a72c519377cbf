"""Identifies a face by a vote of several frames; "unknown" is a possible answer."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from tangy_hw.perception.faces.gallery import FaceMatch

FRAMES = 5
"""Number of frames with a face of sufficient quality in a vote."""
SHARE = 0.6  # share of the votes that a person needs


@dataclass(frozen=True, slots=True)
class Vote:
    """Outcome of a vote: None is unknown. `votes` of `frames` are for the person."""

    person: str | None
    votes: int
    frames: int
    likeness: float


def vote(matches: Iterable[FaceMatch]) -> Vote:
    """Count votes: a person needs three in five, and at least two frames.

    `likeness` (a score) is the mean for the chosen person, or for the nearest.
    """
    cast = list(matches)
    counts = Counter(match.person for match in cast if match.person is not None)
    chosen: str | None = None
    votes = 0
    if counts:
        (first, votes), *others = counts.most_common(2)
        ahead = not others or others[0][1] < votes
        if ahead and votes >= 2 and votes >= SHARE * len(cast):
            chosen = first
        else:
            votes = 0
    nearest = Counter(match.nearest for match in cast if match.nearest is not None)
    about = chosen if chosen is not None else (nearest.most_common(1)[0][0] if nearest else None)
    likenesses = [match.likenesses.get(about, 0.0) for match in cast] if about is not None else []
    mean = sum(likenesses) / len(likenesses) if likenesses else 0.0
    return Vote(chosen, votes, len(cast), mean)
