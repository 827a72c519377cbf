"""Delays of a robot's data: recorded on a bench in real time into a file that tests replay.

Run by hand: `python -m tests.bench.jitter record FILE [--seconds N] [--load N] [--hold S]...`, and
`python -m tests.bench.jitter report FILE...`. A robot drives up and down on the bench; each beat of
its process is kept with the ages of its driving data. `--load` runs busy processes beside it;
`--hold` stops the link for S s, again and again, with equally long rests in between.
"""

from __future__ import annotations

import argparse
import csv
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from statistics import quantiles
from tempfile import TemporaryDirectory

from tangy_hw.device_protocols import DeviceError
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_hw.robot_process.pause_watch import PauseWatch
from tangy_hw.watchdogs import DRIVES_BY
from tangy_profiles.health import Reading
from tangy_profiles.robot import Robot, load_robot
from tangy_profiles.state import FRONT
from tangy_tui.app.robot_opening import open_bench
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.app.workspace import Workspace

RESTS = 4.0  # s between two hold-ups


@dataclass(frozen=True)
class Beat:
    """The time of a beat, in s, and the age of each device's data, in s."""

    at: float
    ages: dict[str, float]


def read_beats(path: Path) -> list[Beat]:
    """Read a recording."""
    with path.open(newline="") as file:
        rows = list(csv.reader(file))
    names = rows[0][1:]
    return [
        Beat(float(at), {n: float(a) for n, a in zip(names, ages, strict=True)})
        for at, *ages in rows[1:]
    ]


@dataclass(frozen=True)
class Replayed:
    """The summary of a recording: pauses, s lost to them, and the faults by device."""

    pauses: int
    seconds: float
    longest: float
    faults: tuple[str, ...]
    level: str


def replay(beats: Sequence[Beat], robot: Robot) -> Replayed:
    """Replay a recording with the limits of a robot's profile."""
    now = [beats[0].at]
    watch = PauseWatch(robot.liveness, MotionLimits(), clock=lambda: now[0])
    watch.begin()
    faults: list[str] = []
    lost: set[str] = set()
    for beat in beats[1:]:
        now[0] = beat.at
        devices = {name: robot.devices[name] for name in beat.ages}
        late = {n: a for n, a in beat.ages.items() if a > devices[n].stale_after}
        watch.look(beat.ages, late)
        gone = {n for n, a in beat.ages.items() if a > devices[n].lost_after}
        faults += sorted(gone - lost)
        lost = gone
    return Replayed(watch.count, watch.seconds, watch.longest, tuple(faults), watch.level)


@contextmanager
def busy(count: int) -> Iterator[None]:
    """Run a number of busy processes."""
    command = [sys.executable, "-c", "while True: pass"]
    loops = [subprocess.Popen(command) for _ in range(count)]  # noqa: S603
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()


def drive_on(world: LiveWorld, over: threading.Event) -> None:
    places = (*world.people, FRONT)
    while not over.is_set():
        for place in places:
            if over.is_set():
                return
            with suppress(DeviceError):
                world.drive(place)


def _hold(world: BenchedWorld, holds: Sequence[float], over: threading.Event) -> None:
    while holds and not over.is_set():
        for seconds in holds:
            if over.wait(RESTS):
                return
            world.bench.do("inject", kind="link-lost")
            over.wait(seconds)
            world.bench.do("lift", kind="link-lost")


def record(path: Path, seconds: float, load: int, holds: Sequence[float]) -> None:
    """Record beats for some s."""
    over = threading.Event()
    with (
        TemporaryDirectory() as folder,
        closing(Workspace(Path(folder))) as workspace,
        open_bench(workspace, seed=1, stepped=False, kind=BenchedWorld) as world,
        busy(load),
        path.open("w", newline="") as file,
    ):
        rows = csv.writer(file)
        rows.writerow(["at", *DRIVES_BY])
        beside = [
            threading.Thread(target=drive_on, args=(world, over)),
            threading.Thread(target=_hold, args=(world, holds, over)),
        ]
        for thread in beside:
            thread.start()
        began, number = time.monotonic(), world.link.state.number
        while (now := time.monotonic()) < began + seconds:
            state = world.link.beat()
            if state.number != number:
                number = state.number
                told: dict[str, Reading] = {r.device: r for r in state.health}
                ages = [f"{min(told[name].age, 99):.2f}" for name in DRIVES_BY]
                rows.writerow([f"{now - began:.2f}", *ages])
        over.set()
        print(f"pauses {world.link.state.pauses}")
        for thread in beside:
            thread.join()


def report(path: Path) -> None:
    """Print the summary of a recording."""
    beats, robot = read_beats(path), load_robot()
    ages = [max(beat.ages.values()) for beat in beats]
    cuts = quantiles(ages, n=1000)
    print(
        f"{path.name}: {len(beats)} beats in {beats[-1].at:.0f} s; oldest data p50 {cuts[499]:.2f} "
        f"p99 {cuts[989]:.2f} p99.9 {cuts[998]:.2f} most {max(ages):.2f} s; {replay(beats, robot)}"
    )


def main() -> None:
    """Record or report."""
    parser = argparse.ArgumentParser()
    parser.add_argument("what", choices=("record", "report"))
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--load", type=int, default=0)
    parser.add_argument("--hold", type=float, action="append", default=[])
    given = parser.parse_args()
    for file in given.files:
        if given.what == "record":
            record(file, given.seconds, given.load, given.hold)
        report(file)


if __name__ == "__main__":
    main()
