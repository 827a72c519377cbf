"""Tracks people and other objects from scan to scan: positions and velocities.

Each track is a constant-velocity Kalman filter (Y. Bar-Shalom et al., "Estimation with applications
to tracking and navigation", 2001, ch. 6) in the odometry frame, which does not jump as the map
frame does. A scan cannot tell for sure a standing person from a chair, so all objects are tracked;
`person` only affects messages to staff.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from math import atan2, hypot

import numpy as np
from numpy.typing import NDArray

from tangy_hw.device_protocols import Pose, Scan
from tangy_hw.navigation.leg_detection import REACH, TORSO, LegSighting, sightings, turned
from tangy_hw.navigation.person_evidence import PersonEvidence
from tangy_hw.navigation.poses import IDENTITY, compose, relative_pose, wrap

ACCELERATION = 3.0  # m/s^2, standard deviation of changes of velocity
MEASURED = 0.07  # metres, standard deviation of a measured centre
MEASURED_LEG = 0.15  # the same for a single leg, which swings
FIRST_SPEED = 1.0  # m/s, standard deviation of the speed of a new track
GATE = 0.55  # metres from the predicted position within which a sighting matches
STRIDE, BETWEEN = 0.9, 0.3  # metres: between two legs; from their centre to the predicted position
SURE = 3  # sightings that confirm a track
DROPPED, DROPPED_HIDDEN = 0.5, 1.5  # seconds unseen until a track is dropped: visible, occluded
SETTLED, SETTLED_WAY, SETTLED_SECONDS = 1.0, 0.15, 0.9  # standing: age in s; less than m in s
RUNS = 0.25  # m/s above which a track does not count as standing
RESTS = 0.5  # seconds of standing after which a walker's pace is forgotten: a track may err
SLOWS = 0.2  # m/s^2, decrease of a walker's remembered pace


@dataclass(frozen=True)
class Track:
    """A tracked person or object: its centre in m, and velocity in m/s, in one frame.

    `half` is its radius in m; `age` and `stood` say for how many s it has been tracked and has
    stood still. `hidden` says that it is currently occluded or out of view.
    """

    x: float
    y: float
    vx: float
    vy: float
    half: float
    age: float
    stood: float
    person: bool
    hidden: bool
    pace: float = 0.0
    """Recent speed in m/s, at which it may approach the robot at any moment."""

    @property
    def speed(self) -> float:
        """Speed in m/s."""
        return hypot(self.vx, self.vy)

    def seen_from(self, pose: Pose) -> Track:
        """Transform it into the frame of a pose given in the current frame."""
        there = relative_pose(pose, Pose(self.x, self.y, 0.0))
        vx, vy = turned(self.vx, self.vy, -pose.heading)
        return Track(there.x, there.y, vx, vy, self.half, self.age, self.stood, self.person,
                     self.hidden, self.pace)  # fmt: skip


@dataclass
class _Followed:
    """State of a track; x and y share one covariance of position and velocity."""

    state: NDArray[np.float64]  # (2, 2): position and velocity, x and y
    half: float
    covariance: NDArray[np.float64] = field(
        default_factory=lambda: np.diag([MEASURED**2, FIRST_SPEED**2])
    )
    hits: int = 1
    age: float = 0.0
    unseen: float = 0.0
    stood: float = 0.0
    hidden: bool = False
    pace: float = 0.0
    evidence: PersonEvidence = field(default_factory=PersonEvidence)
    off: float = 0.0
    """Distance of the latest sighting from the predicted position, in m."""
    past: deque[tuple[float, float, float]] = field(default_factory=deque)

    def predict(self, dt: float) -> None:
        step = np.array([[1.0, dt], [0.0, 1.0]])
        drift = np.array([dt * dt / 2, dt])
        self.state = step @ self.state
        noise = np.outer(drift, drift) * ACCELERATION**2
        self.covariance = step @ self.covariance @ step.T + noise
        self.age += dt
        self.unseen += dt

    def correct(self, sighting: LegSighting) -> None:
        noise = (MEASURED if sighting.half > REACH or sighting.legs else MEASURED_LEG) ** 2
        gain = self.covariance[:, 0] / (self.covariance[0, 0] + noise)
        self.off = hypot(sighting.x - self.state[0, 0], sighting.y - self.state[0, 1])
        self.state = self.state + np.outer(gain, (sighting.x, sighting.y) - self.state[0])
        self.covariance = self.covariance - np.outer(gain, self.covariance[0])
        self.half += 0.3 * (sighting.half - self.half)
        self.hits += 1
        self.unseen = 0.0
        self.hidden = False

    def note(self, sighting: LegSighting | None, dt: float) -> None:
        """Record the position, and update whether it stands and whether it is a person."""
        x, y = float(self.state[0, 0]), float(self.state[0, 1])
        self.past.append((self.age, x, y))
        while self.age - self.past[0][0] > SETTLED_SECONDS:
            self.past.popleft()
        strays = self._strays()
        if self.age > SETTLED and strays < SETTLED_WAY and self._fast < RUNS:
            self.stood += dt
        else:
            self.stood = 0.0
        slower = max(0.0, self.pace - SLOWS * dt)
        self.pace = 0.0 if self.stood > RESTS else max(self._fast, slower)
        self.evidence.note(self.age, (x, y), sighting, self.off)

    def _strays(self) -> float:
        """Return its largest distance from its current position lately: pacing is not standing."""
        x, y = self.state[0]
        return max(hypot(x - one[1], y - one[2]) for one in self.past)

    @property
    def _fast(self) -> float:
        return float(np.hypot(*self.state[1]))

    @property
    def track(self) -> Track:
        (x, y), (vx, vy) = self.state
        if self.stood > 0:
            vx = vy = 0.0
        return Track(float(x), float(y), float(vx), float(vy), self.half, self.age, self.stood,
                     self.evidence.person, self.hidden, self.pace)  # fmt: skip


class PeopleTracker:
    """Tracks all people and objects that a scanner sees and a map lacks."""

    def __init__(self, laser: Pose = IDENTITY) -> None:
        """Start without tracks; `laser` is the pose of the scanner on the robot."""
        self._laser = laser
        self._followed: list[_Followed] = []

    def update(
        self,
        odometry: Pose,
        scan: Scan,
        dt: float,
        unmapped: NDArray[np.bool_] | None = None,
    ) -> tuple[Track, ...]:
        """Update the tracks with a scan, and return them in the odometry frame.

        Args:
            odometry: pose of the robot by wheel odometry.
            scan: the scan.
            dt: seconds since the previous scan.
            unmapped: (n,) for each beam, whether it ends away from everything on the map; None: all
                do.
        """
        for one in self._followed:
            one.predict(dt)
        seen = sightings(scan, self._laser, unmapped, self._expected(odometry))
        found = self._joined([_placed(one, odometry) for one in seen])
        matched = self._matched(found)
        for number, one in enumerate(self._followed):
            sighting = matched.get(number)
            if sighting is not None:
                one.correct(found[sighting])
            else:
                one.hidden = _hidden(one, scan, compose(odometry, self._laser))
            one.note(None if sighting is None else found[sighting], dt)
        self._followed = [
            one
            for one in self._followed
            if one.unseen <= (DROPPED_HIDDEN if one.hidden and one.hits >= SURE else DROPPED)
        ]
        taken = set(matched.values())
        for number, sighting_ in enumerate(found):
            if number not in taken:
                state = np.array([[sighting_.x, sighting_.y], [0.0, 0.0]])
                self._followed.append(_Followed(state, sighting_.half))
        return self.tracks

    @property
    def tracks(self) -> tuple[Track, ...]:
        """Confirmed tracks, in the odometry frame."""
        return tuple(one.track for one in self._followed if one.hits >= SURE)

    @property
    def unconfirmed(self) -> tuple[Track, ...]:
        """New tracks in the latest scan that are not confirmed yet, in the odometry frame."""
        new = (one for one in self._followed if one.hits < SURE and one.unseen == 0.0)
        return tuple(one.track for one in new)

    def _expected(self, odometry: Pose) -> list[tuple[float, float]]:
        """Return the predicted positions of confirmed tracks, in the robot's frame."""
        there = [
            relative_pose(odometry, Pose(float(one.state[0, 0]), float(one.state[0, 1]), 0.0))
            for one in self._followed
            if one.hits >= SURE
        ]
        return [(one.x, one.y) for one in there]

    def _joined(self, found: list[LegSighting]) -> list[LegSighting]:
        """Join two legs that are far apart if a track predicts a person between them."""
        for one in self._followed:
            if one.hits < SURE:
                continue
            legs = [leg for leg in found if not leg.legs and leg.half == REACH]
            pairs = [
                (hypot((a.x + b.x) / 2 - one.state[0, 0], (a.y + b.y) / 2 - one.state[0, 1]), a, b)
                for number, a in enumerate(legs)
                for b in legs[number + 1 :]
                if hypot(a.x - b.x, a.y - b.y) < STRIDE
            ]
            off, a, b = min(pairs, default=(BETWEEN, None, None), key=lambda pair: pair[0])
            if a is not None and b is not None and off < BETWEEN:
                found = [leg for leg in found if leg is not a and leg is not b]
                found.append(LegSighting((a.x + b.x) / 2, (a.y + b.y) / 2, TORSO, True))
        return found

    def _matched(self, found: Sequence[LegSighting]) -> dict[int, int]:
        """Match tracks with sightings (track -> sighting), confirmed tracks first."""
        if not found or not self._followed:
            return {}
        at = np.array([one.state[0] for one in self._followed])
        seen = np.array([(one.x, one.y) for one in found])
        apart = np.hypot(*(at[:, None] - seen[None]).transpose(2, 0, 1))
        unsure = np.array([one.hits < SURE for one in self._followed])
        matched: dict[int, int] = {}
        taken: set[int] = set()
        for number in np.argsort(apart + unsure[:, None] * GATE, axis=None):
            track, sighting = divmod(int(number), len(found))
            if apart[track, sighting] > GATE:
                continue
            if track not in matched and sighting not in taken:
                matched[track] = sighting
                taken.add(sighting)
        return matched


def _placed(one: LegSighting, pose: Pose) -> LegSighting:
    there = compose(pose, Pose(one.x, one.y, 0.0))
    return one._replace(x=there.x, y=there.y)


def _hidden(one: _Followed, scan: Scan, eye: Pose) -> bool:
    """Return whether a track is occluded or out of view."""
    x, y = one.state[0]
    there = relative_pose(eye, Pose(float(x), float(y), 0.0))
    beam = round((wrap(atan2(there.y, there.x) - scan.first)) % (2 * np.pi) / scan.step)
    if not 0 <= beam < len(scan.ranges):
        return True
    return bool(scan.ranges[beam] < hypot(there.x, there.y) - 0.3)
