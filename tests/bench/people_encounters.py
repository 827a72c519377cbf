"""People who set off, or turn round, beside a robot that drives past them: how fast they meet.

Run by hand: `python -m tests.bench.people_encounters --seed 1`. Such meetings are rare among people
who wander, so here each drive has one: a person stands beside the robot's way, and walks at it
once it has come near; or walks at it, goes away, and comes back. The robot and the counting of
touches are as in `people_drives`. No real person or base took part.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from itertools import product
from math import atan2, pi

import numpy as np

from tangy_hw.device_protocols import Pose
from tests.bench.people_simulation import Drive, Kind, Person

START, GOAL, MEETS = Pose(3.2, 2.2, 0.0), Pose(7.5, 2.2, 0.0), 5.0  # m; the last: along the way
SECONDS = 9.0  # of a drive
ASIDE = (-0.95, 0.6, 0.75)  # m of the person from the straight line
PACES = (0.5, 0.7, 0.9, 1.1, 1.3)  # m/s
GAPS = {"sets off": (0.3, 0.36, 0.42, 0.5, 0.6), "turns round": (0.2, 0.3, 0.45, 0.6, 0.8)}
"""Metres between robot and person when they set off, or come back."""
NEAR, CLOSE = 1.2, 0.3  # m between them at which a person walks at the robot, and turns away

Step = Callable[[Person, Drive], None]


def sets_off(gap: float, pace: float) -> Step:
    """Return the steps of a person who walks to where the robot is once it is this near."""
    heading: float | None = None

    def step(person: Person, drive: Drive) -> None:
        nonlocal heading
        if heading is None and person.gap(drive.pose, drive.away) < gap:
            heading = _towards(person, drive.pose)
        if heading is not None:
            person.walk(heading, pace)

    return step


def turns_round(gap: float, pace: float, aside: float) -> Step:
    """Return the steps of a person who walks at the robot, away from it, and back at it."""
    away: float | None = None
    comes, back = False, False

    def step(person: Person, drive: Drive) -> None:
        nonlocal away, comes, back
        far = person.gap(drive.pose, drive.away)
        comes |= far < NEAR
        if comes and away is None and far < CLOSE:
            away = _towards(person, drive.pose) + pi + aside
        back |= away is not None and far > gap
        if away is not None and not back:
            person.walk(away, pace)
        elif comes:
            person.walk(_towards(person, drive.pose), pace)

    return step


def _towards(person: Person, pose: Pose) -> float:
    return atan2(pose.y - person.y, pose.x - person.x)


def meeting(kind: str, gap: float, pace: float, aside: float, seed: int) -> Drive:
    """Drive past one person who sets off, or turns round."""
    number = [int(100 * one) for one in (gap, pace, abs(aside))]
    rng = np.random.default_rng([seed, *number])
    steps = sets_off(gap, pace) if kind == "sets off" else turns_round(
        gap, pace, rng.uniform(-0.9, 0.9))  # fmt: skip
    person = Person(MEETS, GOAL.y + aside, rng.uniform(-pi, pi), steps)
    return Drive(START, GOAL, [person], rng, longest=SECONDS)


def meetings(kind: str, seed: int) -> list[Drive]:
    """Drive past each person of a kind once."""
    each = product(GAPS[kind], PACES, ASIDE)
    return [meeting(kind, *one, seed).run() for one in each]


def row(name: str, found: Sequence[Drive]) -> str:
    """Return a row that sums up meetings."""
    touches = [touch for drive in found for touch in drive.touches]
    kinds: tuple[Kind, ...] = ("ahead", "behind")
    speeds = {kind: [t.speed for t in touches if t.kind == kind] for kind in kinds}
    told = ", ".join(
        f"{kind} {len(fast)}" + (f" at {max(fast):.2f} m/s" if fast else "")
        for kind, fast in speeds.items()
    )
    way = np.mean([drive.pose.x - START.x for drive in found])
    return f"{name}: {len(found)} drives; touched {told}; drove {way:.2f} m along the way"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    for kind in GAPS:
        print(row(kind, meetings(kind, options.seed)), flush=True)


if __name__ == "__main__":
    main()
