"""Tracks people and other objects from scan to scan: positions and velocities.

Each track is a Kalman filter of constant velocity (Y. Bar-Shalom et al., "Estimation with
applications to tracking and navigation", 2001, ch. 6) in the odometry frame, which never jumps as
the map frame does. A scan cannot tell a standing person from a chair, so that all objects are
tracked; `person` is only a word for staff.
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
from tangy_hw.navigation.poses import HERE, between, compose, wrap

ACCELERATION = 3.0  # m/s^2, the deviation of how people change their pace
MEASURED = 0.07  # metres, the deviation of a person's middle as a scan shows it
MEASURED_LEG = 0.15  # the same where one leg is seen alone, which swings to and fro
FIRST_SPEED = 1.0  # m/s, the deviation of the speed of a person who has just appeared
GATE = 0.55  # metres from where a person is expected within which a sighting is of them
STRIDE, BETWEEN = 0.9, 0.3  # metres between legs at most, and off where a person is expected
SURE = 3  # sightings from which on a track counts
DROPPED, DROPPED_HIDDEN = 0.5, 1.5  # seconds unseen; hidden behind something, or out of view
SETTLED, SETTLED_WAY, SETTLED_SECONDS = 1.0, 0.15, 0.9  # s of age, metres in so many s: it stands
RUNS = 0.5  # m/s from which on it does not stand, however little way it has made
SLOWS = 1.0  # m/s^2 by which somebody who walked is less and less expected to go on so
WALKED, WALKED_SECONDS = 0.8, 0.8  # metres and seconds of walking that make a person
LEGS_SHARE, LEGS_SECONDS = 0.7, 2.0  # of so many s with two legs that make a person


@dataclass(frozen=True)
class Track:
    """Somebody or something around: its middle in m, velocity in m/s, in one frame.

    `half` is how far it reaches out from its middle, in m; `age` and `stood` are since when it has
    been followed, and has stood still, in s. `hidden` says that it is not seen just now.
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
    """How fast it has moved lately, in m/s: so fast it may come towards the robot at once."""

    @property
    def speed(self) -> float:
        """How fast it moves, in m/s."""
        return hypot(self.vx, self.vy)

    def seen_from(self, pose: Pose) -> Track:
        """Transform it into the frame of a pose given in the current frame."""
        there = between(pose, Pose(self.x, self.y, 0.0))
        vx, vy = turned(self.vx, self.vy, -pose.heading)
        return Track(there.x, there.y, vx, vy, self.half, self.age, self.stood, self.person,
                     self.hidden, self.pace)  # fmt: skip


@dataclass
class _Followed:
    """One track as it is followed; x and y share a covariance of place and velocity."""

    state: NDArray[np.float64]  # (2, 2): place and velocity, x and y
    half: float
    covariance: NDArray[np.float64] = field(
        default_factory=lambda: np.diag([MEASURED**2, FIRST_SPEED**2])
    )
    hits: int = 1
    age: float = 0.0
    unseen: float = 0.0
    stood: float = 0.0
    hidden: bool = False
    person: bool = False
    pace: float = 0.0
    past: deque[tuple[float, float, float, bool]] = field(default_factory=deque)

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
        self.state = self.state + np.outer(gain, (sighting.x, sighting.y) - self.state[0])
        self.covariance = self.covariance - np.outer(gain, self.covariance[0])
        self.half += 0.3 * (sighting.half - self.half)
        self.hits += 1
        self.unseen = 0.0
        self.hidden = False

    def note(self, legs: bool, dt: float) -> None:
        """Record its position, and judge from that whether it stands, and its kind."""
        x, y = self.state[0]
        self.past.append((self.age, float(x), float(y), legs))
        while self.age - self.past[0][0] > LEGS_SECONDS:
            self.past.popleft()
        strays = self._strays(SETTLED_SECONDS)
        if self.age > SETTLED and strays < SETTLED_WAY and self._fast < RUNS:
            self.stood += dt
        else:
            self.stood = 0.0
        walked = self.age >= WALKED_SECONDS and self._way(LEGS_SECONDS) >= WALKED
        slower = max(0.0, self.pace - SLOWS * dt)
        self.pace = 0.0 if self.stood > 0 else max(self._fast, slower)
        pairs = sum(one[3] for one in self.past)
        stands = self.age >= LEGS_SECONDS and pairs >= LEGS_SHARE * len(self.past)
        self.person |= walked or stands

    def _way(self, seconds: float) -> float:
        x, y = self.state[0]
        then = next(one for one in self.past if self.age - one[0] <= seconds)
        return hypot(x - then[1], y - then[2])

    def _strays(self, seconds: float) -> float:
        """Return how far off its place it was at most: who goes to and fro does not stand."""
        x, y = self.state[0]
        lately = (one for one in self.past if self.age - one[0] <= seconds)
        return max(hypot(x - one[1], y - one[2]) for one in lately)

    @property
    def _fast(self) -> float:
        return float(np.hypot(*self.state[1]))

    @property
    def track(self) -> Track:
        (x, y), (vx, vy) = self.state
        if self.stood > 0:
            vx = vy = 0.0
        return Track(float(x), float(y), float(vx), float(vy), self.half, self.age, self.stood,
                     self.person, self.hidden, self.pace)  # fmt: skip


class PeopleTracker:
    """Follows everybody and everything that a scanner sees and a map does not have."""

    def __init__(self, laser: Pose = HERE) -> None:
        """Begin, with the scanner at a pose on the robot."""
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
            odometry: where the wheels count the robot.
            scan: the scan from there.
            dt: seconds since the scan before.
            unmapped: (n,) for each beam, whether it ends off all that is on the map; None: all do.
        """
        for one in self._followed:
            one.predict(dt)
        found = [_placed(one, odometry) for one in sightings(scan, self._laser, unmapped)]
        found = self._joined(found)
        matched = self._matched(found)
        for number, one in enumerate(self._followed):
            sighting = matched.get(number)
            if sighting is not None:
                one.correct(found[sighting])
            else:
                one.hidden = _hidden(one, scan, compose(odometry, self._laser))
            one.note(sighting is not None and found[sighting].legs, dt)
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
        """The confirmed tracks, in the odometry frame."""
        return tuple(one.track for one in self._followed if one.hits >= SURE)

    def _joined(self, found: list[LegSighting]) -> list[LegSighting]:
        """Put two legs that are far apart together where a person is expected between them."""
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
        """Return which sighting belongs to which track: to sure ones first, then the nearest."""
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
    """Say whether a track could not be seen: something is before it, or no beam looks there."""
    x, y = one.state[0]
    there = between(eye, Pose(float(x), float(y), 0.0))
    beam = round((wrap(atan2(there.y, there.x) - scan.first)) % (2 * np.pi) / scan.step)
    if not 0 <= beam < len(scan.ranges):
        return True
    return bool(scan.ranges[beam] < hypot(there.x, there.y) - 0.3)
