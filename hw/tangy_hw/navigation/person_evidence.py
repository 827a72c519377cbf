"""Tells people from furniture by how a track moves and how its legs look.

It serves only what staff are told: the robot keeps its distance from every track, because a scan
cannot tell for sure a person who stands from a chair.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from itertools import pairwise
from math import hypot

from tangy_hw.navigation.leg_detection import LegSighting

WINDOW = 2.0  # seconds that are looked at
WALKED, WALKED_SECONDS = 0.8, 0.8  # metres and seconds of walking that make a track a person
STRAIGHT = 1.4  # metres of path for each metre gone, above which a track only wavers
HOPS = 0.25  # metres off the prediction: such a track may have taken legs of something else
SEEN_SECONDS = 1.8  # seconds of the window that have passed before legs are judged
SHARE = 0.7  # share of the window in which a person who stands shows two legs
ANKLE = 0.07  # metres, the least mean width of the narrower leg: legs of chairs are thinner
OTHERS = 0.3  # the most other legs close by, on average: a chair has four legs, and no person has


@dataclass
class PersonEvidence:
    """What speaks for a track being a person; `person` is the verdict so far."""

    person: bool = False
    _walk: deque[tuple[float, float, float]] = field(default_factory=deque)
    _legs: deque[tuple[float, LegSighting | None]] = field(default_factory=deque)

    def note(
        self, age: float, place: tuple[float, float], sighting: LegSighting | None, off: float
    ) -> None:
        """Update with a scan.

        Args:
            age: of the track, in s.
            place: its filtered position, x and y in m, in a frame that does not move.
            sighting: what it was matched with in the scan, if anything.
            off: the distance between that and its predicted position, in m.
        """
        if sighting is not None:
            if off > HOPS:
                self._walk.clear()
            self._walk.append((age, *place))
        self._legs.append((age, sighting if sighting is not None and sighting.legs else None))
        for past in (self._walk, self._legs):
            while past and age - past[0][0] > WINDOW:
                past.popleft()
        self.person |= self._walked() or self._stands()

    def _walked(self) -> bool:
        past = list(self._walk)
        if not past or past[-1][0] - past[0][0] < WALKED_SECONDS:
            return False
        gone = hypot(past[-1][1] - past[0][1], past[-1][2] - past[0][2])
        path = sum(hypot(b[1] - a[1], b[2] - a[2]) for a, b in pairwise(past))
        return gone >= WALKED and path <= STRAIGHT * gone

    def _stands(self) -> bool:
        pairs = [pair for _, pair in self._legs if pair is not None]
        seconds = self._legs[-1][0] - self._legs[0][0]
        if seconds < SEEN_SECONDS or len(pairs) < SHARE * len(self._legs):
            return False
        width = sum(pair.width for pair in pairs) / len(pairs)
        others = sum(pair.others for pair in pairs) / len(pairs)
        return width >= ANKLE and others <= OTHERS
