"""Furniture that counts as people, people who do not, and the tracker's time for each scan.

Run by hand: `python -m tests.bench.people_mistaken --seed 1 --drives 60`. The robot drives through
the simulated room of `people_simulation`: empty, with eight things that are not on its map (chairs,
walking frames, empty wheelchairs, armchairs, tables, lamps, plants and boxes), or with people. A
false person is a track in view that counts as a person further than .5 m from everybody, each time
that it begins to. People are looked for within 3.5 m, once they have been tracked for 2.5 s.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from math import cos, hypot, inf, pi, sin
from time import process_time

import numpy as np
from numpy.random import Generator

from tangy_hw.device_protocols import Pose
from tangy_hw.navigation.navigator import Navigator
from tangy_hw.navigation.people_tracker import PeopleTracker, Track
from tangy_hw.navigation.poses import compose
from tests.bench.people_scenes import group, inside, standing, walking, wandering, way
from tests.bench.people_simulation import CHAIR, MAP, Drive, Person

PIECES = 8
APART, FREE = 0.9, 0.8  # m between the middles of two things; from a start or goal
NEAR = 0.5  # m from a person within which a track is theirs
LOOKED, TRACKED = 3.5, 2.5  # m within which people are looked for, s of tracking before

Circle = tuple[float, float, float]
"""Place of a leg or an edge before and beside the middle of a thing, and its radius, in m."""


def feet(length: float, width: float, radius: float) -> list[Circle]:
    """Return four legs at the corners of a rectangle."""
    return [(x * length / 2, y * width / 2, radius) for x in (-1, 1) for y in (-1, 1)]


def solid(length: float, width: float) -> list[Circle]:
    """Return the four sides of a box, as circles that touch each other."""
    xs, ys = np.arange(-length / 2, length / 2 + 0.01, 0.04), np.arange(-width / 2, width / 2, 0.04)
    rows = [(float(x), side * width / 2, 0.02) for x in xs for side in (-1, 1)]
    return rows + [(side * length / 2, float(y), 0.02) for y in ys for side in (-1, 1)]


KINDS: dict[str, list[Circle]] = {
    "chair": feet(0.42, 0.40, 0.02),
    "chair with thick legs": feet(0.45, 0.45, 0.035),
    "walking frame": feet(0.45, 0.55, 0.015),
    "wheeled walker": [*feet(0.55, 0.50, 0.04)],
    "wheelchair": [one for one in Person(0.0, 0.0, 0.0, radius=CHAIR).circles() if one[2] < 0.05],
    "armchair": solid(0.75, 0.8),
    "table": feet(0.7, 0.7, 0.03),
    "lamp": [(0.0, 0.0, 0.14)],
    "plant": [(0.0, 0.0, 0.18)],
    "box": solid(0.4, 0.3),
}


@dataclass
class Thing(Person):
    """A thing that stands; `shape` are its circles, as in `Circle`."""

    shape: tuple[Circle, ...] = ()

    def circles(self) -> Iterator[tuple[float, float, float]]:
        """Yield the circles that a laser sees: centre and radius, in m."""
        c, s = cos(self.heading), sin(self.heading)
        for along, aside, radius in self.shape:
            yield self.x + along * c - aside * s, self.y + along * s + aside * c, radius


def furnished(rng: Generator, drive: Drive) -> Drive:
    """Put things into the room of a drive, none near its ends or near people."""
    things: list[Person] = []
    while len(things) < PIECES:
        x, y = rng.uniform(0.6, 9.4), rng.uniform(0.6, 4.4)
        taken = [(one.x, one.y) for one in (*things, *drive.people)]
        ends = [(drive.start.x, drive.start.y), (drive.goal.x, drive.goal.y)]
        if (
            inside(x, y)
            and min((hypot(x - px, y - py) for px, py in taken), default=inf) > APART
            and min(hypot(x - px, y - py) for px, py in ends) > FREE
        ):
            kind = str(rng.choice(list(KINDS)))
            things.append(Thing(x, y, rng.uniform(-pi, pi), radius=0.4, shape=tuple(KINDS[kind])))
    drive.people += things
    return drive


ROOMS: dict[str, Callable[[Generator], Drive]] = {
    "empty": lambda rng: Drive(*way(rng), [], rng),
    "furnished": lambda rng: furnished(rng, Drive(*way(rng), [], rng)),
    "two walkers": walking,
    "two wander": wandering,
    "three stand": standing,
    "four stand together": group,
}


class Counter:
    """Counts the false persons of a drive, and the people told as such; times its tracker."""

    def __init__(self, drive: Drive) -> None:
        """Begin with a drive."""
        self.drive, self.false, self.seconds = drive, 0, list[float]()
        self.looked, self.told = 0, 0
        self._before: list[tuple[float, float]] = []

    def update(self, tracks: tuple[Track, ...]) -> None:
        """Compare tracks, given in the robot's frame, with the truth."""
        pose = self.drive.pose
        people = [(one.x, one.y) for one in self.drive.people if not isinstance(one, Thing)]
        seen = [(transform(pose, one), one) for one in tracks if not one.hidden]
        false = [at for at, one in seen if one.person and nobody(at, people)]
        self.false += sum(nobody(at, self._before) for at in false)
        self._before = false
        for x, y in people:
            theirs = [one for at, one in seen if hypot(at[0] - x, at[1] - y) < NEAR]
            near = hypot(pose.x - x, pose.y - y) < LOOKED
            if near and max((one.age for one in theirs), default=0.0) > TRACKED:
                self.looked += 1
                self.told += any(one.person for one in theirs)


def transform(pose: Pose, track: Track) -> tuple[float, float]:
    """Return where a track is in the room, x and y in m."""
    at = compose(pose, Pose(track.x, track.y, 0.0))
    return at.x, at.y


def nobody(at: tuple[float, float], people: Sequence[tuple[float, float]]) -> bool:
    """Return whether none of these is near a place."""
    return all(hypot(at[0] - x, at[1] - y) > NEAR for x, y in people)


def watched(drive: Drive) -> Counter:
    """Drive, and count."""
    counter, update = Counter(drive), PeopleTracker.update

    def timed(tracker: PeopleTracker, *args: object, **names: object) -> tuple[Track, ...]:
        began = process_time()
        found = update(tracker, *args, **names)  # type: ignore[arg-type]
        counter.seconds.append(process_time() - began)
        return found

    navigator = Navigator(MAP, drive.rng, drive.start)
    move = drive.move

    def moved() -> None:
        counter.update(navigator.tracks)
        move()

    drive.move = moved  # type: ignore[method-assign]
    PeopleTracker.update = timed  # type: ignore[method-assign, assignment]
    try:
        drive.run(navigator)
    finally:
        PeopleTracker.update = update  # type: ignore[method-assign]
    return counter


def row(room: str, drives: int, seed: int, first: int = 0) -> str:
    """Return a row that sums up the drives through a room."""
    number = list(ROOMS).index(room)
    found = [
        watched(ROOMS[room](np.random.default_rng([seed, number, one])))
        for one in range(first, first + drives)
    ]
    minutes = sum(one.drive.time for one in found) / 60
    false = sum(one.false for one in found)
    times = 1000 * np.concatenate([one.seconds for one in found])
    arrived = sum(one.drive.arrived for one in found)
    blocked = sum(one.drive.told == "blocked" and not one.drive.arrived for one in found)
    told, looked = sum(one.told for one in found), sum(one.looked for one in found)
    people = f"{told} of {looked} sightings of people told; " if looked else ""
    return (
        f"{room:<20} {false} false persons in {minutes:.1f} minutes "
        f"({false / minutes:.2f} a minute); "
        f"{people}arrived {arrived} of {drives} ({blocked} told as blocked); "
        f"tracker {np.median(times):.2f} ms a scan, "
        f"p95 {np.percentile(times, 95):.2f} ms"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("rooms", nargs="*", help=f"of {', '.join(ROOMS)}; default: all")
    parser.add_argument("--drives", type=int, default=60)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    for room in options.rooms or ROOMS:
        print(row(room, options.drives, options.seed), flush=True)


if __name__ == "__main__":
    main()
