"""How well a robot keeps its place if a lossy network delays odometry and scans.

Run by hand: `python -m tests.bench.late_scans [--loss SHARE]... [--delay S] [--seeds N]
[--newest]`. A robot drives to every seat and back to the front of the common room, in simulated
time. Its base and its scanner have a connection each; a lost message arrives later, and so do
the messages behind it. The robot stands while the newest scan or odometry is older than its profile
allows. With --newest a scan is matched with the newest odometry instead of that of its own time.
"""

from __future__ import annotations

import argparse
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field
from math import hypot
from random import Random
from typing import Generic, TypeVar

from tangy_hw.device_protocols import STILL, Odometry, Scan, Stamped, Twist
from tangy_hw.drivers.source_clock import SourceClock
from tangy_hw.navigation.odometry_history import OdometryHistory
from tangy_hw.navigation.poses import wrap
from tangy_profiles.robot import load_robot
from tangy_sim.servers.link_relay import LinkQuality
from tests.bench.stalls import spread
from tests.hw.navigated import FRONT, ROOM, DrivenRobot, at_seat
from tests.hw.raycast import driven, look, room_sides

Value = TypeVar("Value")

TICK, SCANS = 0.05, 0.1  # s
LONGEST = 120.0  # s, of a drive
LOST = 0.5  # metres of error from which an estimate is wrong


class Line(Generic[Value]):
    """A connection that delivers each message at its due time, in order."""

    def __init__(self, quality: LinkQuality, chance: Random) -> None:
        self._quality, self._chance = quality, chance
        self._due, self._clock = 0.0, SourceClock()
        self._coming: deque[tuple[float, float, Value]] = deque()
        self.newest: Stamped[Value] | None = None
        """The last message that arrived."""

    def send(self, now: float, what: Value) -> None:
        """Send a message of one packet."""
        self._due = max(self._due, now + self._quality.late(1, self._chance))
        self._coming.append((self._due, now, what))

    def receive(self, now: float) -> Iterator[Stamped[Value]]:
        """Take the messages that have arrived; their time is on a clock that is 1000 s ahead."""
        while self._coming and self._coming[0][0] <= now + 1e-9:
            _, sent, value = self._coming.popleft()
            measured = self._clock.measured(sent + 1000.0, now)
            self.newest = Stamped(value, now, 0, measured)
            yield self.newest


@dataclass
class Kept:
    """The robot's errors in metres and radians, and how drives ended."""

    metres: list[float] = field(default_factory=list)
    radians: list[float] = field(default_factory=list)
    drives: int = 0
    arrived: int = 0
    lost: int = 0
    spins: int = 0


class LateRobot(DrivenRobot):
    """A robot with late data."""

    def __init__(self, quality: LinkQuality, seed: int, *, matched: bool) -> None:
        super().__init__(seed=seed)
        chance = Random(f"{seed}/lines")
        self.base: Line[Odometry] = Line(quality, chance)
        self.laser: Line[Scan] = Line(quality, chance)
        self.history = OdometryHistory()
        profile = load_robot().devices
        self.ages = profile["base"].stale_after, profile["laser"].stale_after
        self.next_scan = 0.0
        self.matched = matched

    def go(self, kept: Kept) -> None:
        """Drive to the navigator's goal."""
        began, was_lost = self.time, False
        sides = room_sides(ROOM, *self.boxes)
        kept.drives += 1
        while self.time < began + LONGEST and self.navigator.state not in ("arrived", "failed"):
            self.base.send(self.time, Odometry(self.wheels.pose, self.twist))
            if self.time >= self.next_scan - 1e-9:
                self.laser.send(self.time, look(sides, self.true, self.rng, beams=240))
                self.next_scan = self.time + SCANS
            for _ in (*self.base.receive(self.time), *self.laser.receive(self.time)):
                pass  # only the newest counts
            told = self.tick()
            newest = self.base.newest, self.laser.newest
            late = any(
                one is None or self.time - one.stamp > age
                for one, age in zip(newest, self.ages, strict=True)
            )
            if late:
                self.navigator.held()
            self.twist = STILL if late else told
            self.wheels.turn(self.twist, TICK)
            self.true = driven(self.true, self.twist, TICK)
            self.time += TICK
            if (estimate := self.navigator.estimate) is not None:
                off = hypot(estimate.pose.x - self.true.x, estimate.pose.y - self.true.y)
                kept.metres.append(off)
                kept.radians.append(abs(wrap(estimate.pose.heading - self.true.heading)))
                was_lost |= off > LOST
                kept.spins += self.navigator.state == "spinning"
        kept.lost += was_lost
        kept.arrived += self.navigator.state == "arrived"

    def tick(self) -> Twist:
        """Pass on the known poses, as the robot's control does."""
        odometry, scan = self.base.newest, self.laser.newest
        if odometry is None:
            return STILL
        self.history.note(odometry)
        if scan is None:
            return self.navigator.tick(odometry.value, None, TICK)
        at_scan = self.history.at(scan.time) if self.matched else None
        return self.navigator.tick(odometry.value, scan.value, TICK, at_scan)


def main() -> None:
    """Drive, and print the errors of the place."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--loss", type=float, action="append")
    parser.add_argument("--delay", type=float, default=0.0)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--newest", action="store_true", help="match scans with newest odometry")
    given = parser.parse_args()
    for loss in given.loss or [0.0, 0.03, 0.1]:
        kept, quality = Kept(), LinkQuality(given.delay, loss)
        for seed in range(given.first_seed, given.first_seed + given.seeds):
            robot = LateRobot(quality, seed, matched=not given.newest)
            for goal in (*(at_seat(n) for n in range(4)), FRONT):
                robot.navigator.go(goal)
                robot.go(kept)
        print(
            f"loss {loss:.0%}: {kept.drives} drives, {kept.arrived} arrived, {kept.lost} lost, "
            f"{kept.spins * TICK:.0f} s of turning to find its place;\n  off by "
            f"{spread(kept.metres, 'm')}; {spread(kept.radians, 'rad')}",
            flush=True,
        )


if __name__ == "__main__":
    main()
