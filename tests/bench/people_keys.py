"""Drives by keys held down, towards people and walls: whom and what the robot touches.

Run by hand: `python -m tests.bench.people_keys --drives 100`. The driver steers at the
nearest person or at a wall, at full speed, and never lets go; people and the counting of touches
are as in `people_drives`. With `--encounters`, a person stands straight ahead instead, and walks
at the robot when it has come near. No real person or base took part.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from math import atan2, hypot, pi

import numpy as np

from tangy_hw.device_protocols import STILL, Odometry, Pose, Scan, Twist
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.navigator import Navigator
from tangy_hw.navigation.people_tracker import PeopleTracker
from tangy_hw.navigation.poses import wrap
from tangy_hw.robot_process.hand_drive import HandDrive
from tangy_sim.device_simulator.lidar import cast
from tests.bench.people_scenes import SCENES
from tests.bench.people_simulation import (
    LATE,
    MAP,
    MOVES,
    NO_SCAN,
    ROBOT,
    TICK,
    WALLS,
    Drive,
    Person,
    disc,
    followed,
)
from tests.hw.raycast import Wheels

AMONG = ("standing", "walking", "wandering", "steps in", "group", "wheelchair")
SECONDS, AIMS = 30.0, 4.0  # s: of a drive, and until the driver steers at another target
KNOWN = 2.0  # s after which the robot knows that a person stands
PACES = (0.3, 0.5, 0.7, 0.9, 1.0, 1.1, 1.2)  # m/s at which they set off
GAPS = np.arange(0.1, 1.3, 0.06)  # m between them and the robot when they set off
ROUND = np.linspace(-pi, pi, 72, endpoint=False)


def by_keys(number: int, seed: int) -> tuple[Drive, bool]:
    """Drive by keys among people; return the drive, and whether a wall or an object was touched."""
    rng = np.random.default_rng([seed, 1000, number])
    drive = SCENES[AMONG[number % len(AMONG)]](rng)
    limits = MotionLimits()
    navigator, hand = Navigator(MAP, rng, drive.start), HandDrive(limits)
    wheels, sent, scan, touched = Wheels(rng), [STILL] * LATE, None, False
    aim, until = 0.0, 0.0
    while drive.time < SECONDS:
        if drive.time >= until:
            aim, until = rng.uniform(-pi, pi), drive.time + AIMS
        if scan is None or rng.random() >= NO_SCAN:
            scan = drive.look()
        navigator.tick(Odometry(wheels.pose, drive.twist), scan, TICK)
        hand.tell(Twist(limits.max_speed, _steers(drive, aim)), drive.time)
        told = _commanded(hand, navigator, scan, drive.time)
        sent.append(told)
        drive.twist = followed(drive.twist, sent.pop(0))
        wheels.turn(drive.twist, TICK)
        drive.move()
        near = cast(drive.pose.x, drive.pose.y, ROUND, WALLS, np.zeros((0, 3)))
        touched |= bool(near.min() < ROBOT)
    return drive, touched


def _steers(drive: Drive, aim: float) -> float:
    """Return the driver's rate of turn: towards the nearest person, or a random place."""
    people = [(hypot(p.x - drive.pose.x, p.y - drive.pose.y), p) for p in drive.people]
    far, person = min(people, key=lambda found: found[0])
    if far < 2.5:
        aim = atan2(person.y - drive.pose.y, person.x - drive.pose.x)
    return float(np.clip(2.0 * wrap(aim - drive.pose.heading), -0.6, 0.6))


def _commanded(hand: HandDrive, navigator: Navigator, scan: Scan, now: float) -> Twist:
    told = hand.command(scan, now, navigator.unseen, navigator.tracks)
    return STILL if told is None else told


def speed_when_met(gap: float, walks: float, seed: int = 5) -> float:
    """Drive at a standing person; return the robot's speed when they met, in m/s.

    The person walks at the robot, `walks` m/s fast, once it is within `gap` m.
    """
    person, start, limits = Person(5.0, 1.5, 0.5), Pose(2.9, 1.5, 0.0), MotionLimits()
    drive = Drive(start, start, [person], np.random.default_rng(seed))
    hand, tracker, late = HandDrive(limits), PeopleTracker(), STILL
    while drive.time < SECONDS:
        scan = drive.look()
        tracks = tracker.update(drive.pose, scan, TICK)
        if drive.time > KNOWN:
            hand.tell(Twist(limits.max_speed, 0.0), drive.time)
        around = [one.seen_from(drive.pose) for one in tracks]
        told = hand.command(scan, drive.time, None, around) or STILL
        drive.twist, late = followed(drive.twist, late), told
        drive.move()
        stands = drive.time > KNOWN + 1.0 and drive.twist.forward < MOVES
        if person.gap(drive.pose, disc) < gap or stands:
            person.step = lambda one, _: one.walk(pi, walks)
        for touch in drive.touches:
            return 0.0 if touch.kind == "stood" else touch.speed
    raise AssertionError("they never met")


def encounters(seed: int) -> str:
    """Let people set off at several speeds and distances; count those who met a driving robot."""
    met = [speed_when_met(gap, walks, seed) for walks in PACES for gap in GAPS]
    drove = [speed for speed in met if speed]
    return (
        f"{len(met)} people set off: {len(drove)} met the robot while it drove, "
        f"at {max(drove, default=0.0):.2f} m/s at most"
    )


def row(found: Sequence[tuple[Drive, bool]]) -> str:
    """Return a row that sums up drives."""
    ahead = [t.speed for drive, _ in found for t in drive.touches if t.kind == "ahead"]
    speeds = f" at {max(ahead):.2f} m/s" if ahead else ""
    return (
        f"{len(found)} drives by keys: touched ahead {sum(d.count('ahead') for d, _ in found)}"
        f"{speeds}, behind {sum(d.count('behind') for d, _ in found)}; walked into it "
        f"{sum(d.count('stood') for d, _ in found)}; touched a wall {sum(t for _, t in found)}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--drives", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--encounters", action="store_true")
    options = parser.parse_args()
    if options.encounters:
        print(encounters(options.seed))
        return
    print(row([by_keys(number, options.seed) for number in range(options.drives)]))


if __name__ == "__main__":
    main()
