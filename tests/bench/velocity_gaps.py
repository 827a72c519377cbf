"""Gaps between velocity commands: the shortest possible time to live of a command.

Run by hand: `python -m tests.bench.velocity_gaps [--seconds N] [--load N]`. A robot drives up and
down on the bench in real time, with N busy processes beside it. The arrivals at its base are
recorded; a gap counts from a command to drive to the next command of any kind. A command that
expires before the next one comes makes the robot stutter.
"""

from __future__ import annotations

import argparse
import asyncio
import threading
import time
from contextlib import closing
from itertools import pairwise
from pathlib import Path
from statistics import quantiles
from tempfile import TemporaryDirectory

from tangy_hw.device_protocols import STILL
from tangy_hw.drivers.ros_messages import Message, twist_of
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_tui.app.robot_opening import open_bench
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.app.workspace import Workspace
from tests.bench.jitter import busy, drive_on

LIVES = (0.1, 0.15, 0.2, 0.25, 0.3, 0.5)  # s


def gaps(arrivals: list[tuple[float, bool]]) -> list[float]:
    """Return the s from each command to drive to the next; each arrival says whether it drives."""
    return [after - at for (at, drives), (after, _) in pairwise(arrivals) if drives]


async def listen(url: str, seconds: float) -> list[tuple[float, bool]]:
    """Return when each velocity command arrived, and whether it drives."""
    arrivals: list[tuple[float, bool]] = []

    def hear(message: Message) -> None:
        arrivals.append((time.monotonic(), twist_of(message) != STILL))

    bridge = Rosbridge(url)
    bridge.subscribe("/cmd_vel", "geometry_msgs/Twist", hear)
    await bridge.start()
    await asyncio.sleep(seconds)
    await bridge.close()
    return arrivals


def main() -> None:
    """Drive, listen, and print."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=120.0)
    parser.add_argument("--load", type=int, default=0)
    given = parser.parse_args()
    over = threading.Event()
    with (
        TemporaryDirectory() as folder,
        closing(Workspace(Path(folder))) as workspace,
        open_bench(workspace, seed=1, stepped=False, kind=BenchedWorld) as world,
        busy(given.load),
    ):
        driving = threading.Thread(target=drive_on, args=(world, over))
        driving.start()
        url = world.bench.wires.rosbridge
        found = gaps(asyncio.run(listen(url, given.seconds)))
        over.set()
        pauses = world.link.state.pauses
        driving.join()
    cuts = quantiles(found, n=1000)
    expired = {life: sum(gap > life for gap in found) for life in LIVES}
    print(
        f"{len(found)} commands to drive; the next came after p50 {cuts[499]:.3f} p99 "
        f"{cuts[989]:.3f} p99.9 {cuts[998]:.3f} most {max(found):.3f} s; pauses {pauses}"
    )
    print("expired before the next one, by time to live (s):", expired)


if __name__ == "__main__":
    main()
