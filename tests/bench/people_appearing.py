"""A person appears before a robot that drives: how soon it is told to drive slower.

Run by hand: `python -m tests.bench.people_appearing --seed 1 --meetings 100`. The person comes into
view at once, as from behind a door, while the robot drives at full speed, and stands there or walks
at it. The robot and the counting of touches are as in `people_drives`. Scans come every .1 s, so
the times have that step. No real person or base took part.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, cos, inf, pi, sin

import numpy as np

from tangy_hw.device_protocols import Odometry, Pose, Scan, Twist
from tangy_hw.navigation.navigator import Navigator
from tests.bench.people_simulation import BRAKE, LATE, MAP, ROBOT, TICK, TORSO, Drive, Person

START, GOAL = Pose(1.5, 2.2, 0.0), Pose(8.0, 2.2, 0.0)
FULL = 0.45  # m/s from which the robot counts as driving at full speed
GAPS, BEARING = (0.35, 0.9), 0.6  # m between robot and torso; rad off its heading, at most
PACES = {"stands": (0.0, 0.0), "walks at it": (0.5, 1.4)}  # m/s
SECONDS = 9.0  # of a drive
SLOWER = 0.02  # m/s below the command before


@dataclass
class Meeting:
    """One drive, and how soon it slowed down."""

    drive: Drive
    gap: float
    pace: float
    speed: float = 0.0
    """The robot's speed as the person appeared, in m/s."""
    appeared: float = inf
    slower: float = inf
    """The time of the first slower command, in s."""

    @property
    def seconds(self) -> float:
        """From the appearance to the first slower command."""
        return self.slower - self.appeared

    @property
    def in_time(self) -> bool:
        """Whether a robot that brakes from the first scan on stands before they meet.

        Both move for a tick before the first scan, and for `LATE` more until it brakes.
        """
        late = (1 + LATE) * TICK
        stands = late + self.speed / BRAKE
        way = late * self.speed + self.speed**2 / (2 * BRAKE)
        return self.gap > way + self.pace * stands


def walks_at(pace: float) -> Person:
    """Return a person out of sight who will walk at the robot."""

    def step(person: Person, drive: Drive) -> None:
        if pace and drive.people:
            towards = atan2(drive.pose.y - person.y, drive.pose.x - person.x)
            person.walk(towards, pace)

    return Person(0.0, 0.0, 0.0, step)


def meet(kind: str, number: int, seed: int) -> Meeting:
    """Drive, and let a person appear."""
    rng = np.random.default_rng([seed, list(PACES).index(kind), number])
    drive = Drive(START, GOAL, [], rng, longest=SECONDS)
    meeting = Meeting(drive, float(rng.uniform(*GAPS)), float(rng.uniform(*PACES[kind])))
    person, after = walks_at(meeting.pace), float(rng.uniform(3.0, 5.0))
    bearing = float(rng.uniform(-BEARING, BEARING))
    navigator = Navigator(MAP, rng, START)
    tick, told = navigator.tick, 0.0

    def ticked(odometry: Odometry, scan: Scan | None, dt: float) -> Twist:
        nonlocal told
        twist = tick(odometry, scan, dt)
        if drive.people and twist.forward < told - SLOWER:
            meeting.slower = min(meeting.slower, drive.time)
        if not drive.people:
            told = twist.forward
            if drive.time > after and drive.twist.forward > FULL:  # in view from the next scan on
                far = meeting.gap + ROBOT + TORSO
                person.x = drive.pose.x + far * cos(drive.pose.heading + bearing)
                person.y = drive.pose.y + far * sin(drive.pose.heading + bearing)
                person.heading = drive.pose.heading + pi
                drive.people.append(person)
                meeting.appeared, meeting.speed = drive.time + TICK, drive.twist.forward
        return twist

    navigator.tick = ticked  # type: ignore[method-assign, assignment]
    drive.run(navigator)
    return meeting


def row(kind: str, found: Sequence[Meeting]) -> str:
    """Return a row that sums up meetings."""
    met = [one for one in found if one.appeared < inf]
    seconds = np.array([one.seconds for one in met])
    slowed = seconds[np.isfinite(seconds)]
    rows = [
        f"{kind}: {len(met)} met at full speed, {len(slowed)} slowed down, after "
        f"{np.median(slowed):.1f} s (median; p95 {np.percentile(slowed, 95):.1f}, at most "
        f"{slowed.max():.1f})"
    ]
    for name, some in {
        "time to stand": [one for one in met if one.in_time],
        "no time": [one for one in met if not one.in_time],
    }.items():
        touches = [touch for one in some for touch in one.drive.touches]
        ahead = sorted(touch.speed for touch in touches if touch.kind == "ahead")
        speeds = (
            f" at {np.median(ahead):.2f} m/s (median), {ahead[-1]:.2f} at most" if ahead else ""
        )
        rows.append(f"  {name}: {len(some)}; touched ahead {len(ahead)}{speeds}")
    return "\n".join(rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--meetings", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    for kind in PACES:
        found = [meet(kind, number, options.seed) for number in range(options.meetings)]
        print(row(kind, found), flush=True)


if __name__ == "__main__":
    main()
