"""Delay until camera trouble, and its end, is reported: real processes, a loopback stream.

Run by hand: `python -m tests.bench.camera_latency [--rounds N]`. An MJPEG server (see
`tests.real.camera_server`) is live, freezes, is covered, hangs, breaks off, is unplugged, and comes
back; the camera's process is stopped and killed. Each must be reported, and its end, within 2 s.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import random
import signal
import time
from statistics import median

from tangy_hw.drivers.camera import Camera
from tangy_hw.drivers.camera_source import find_camera
from tangy_hw.drivers.camera_state import State
from tests.real.camera_server import CameraServer

WANTED = 2.0
TROUBLE: dict[str, State] = {
    "frozen": "FROZEN",
    "covered": "COVERED",
    "dark": "DARK",
    "blurred": "BLURRED",
    "hang": "DISCONNECTED",
    "half": "DISCONNECTED",
    "rubbish": "DISCONNECTED",
    "close": "DISCONNECTED",
    "unplug": "DISCONNECTED",
}


async def until(camera: Camera, state: State) -> float:
    """Return the time in s until a camera reaches a state."""
    began = time.monotonic()
    while camera.sight.state != state:
        await asyncio.sleep(0.01)
        if time.monotonic() - began > 20:
            return float("inf")
    return time.monotonic() - began


async def measure(rounds: int, lasts: float) -> None:
    """Print the table; each trouble lasts this long after it was reported."""
    rng = random.Random(1)
    print("                named s   (longest)   over s   (longest)")
    with CameraServer() as server:
        async with Camera(find_camera(server.url)) as camera:
            await until(camera, "OK")
            for mode, state in TROUBLE.items():
                named, over = [], []
                for _ in range(rounds):
                    await asyncio.sleep(rng.uniform(0.5, 1.0))
                    if mode == "unplug":
                        server.unplug()
                    server.mode = "close" if mode == "unplug" else mode
                    named.append(await until(camera, state))
                    await asyncio.sleep(rng.uniform(0, lasts))
                    server.mode = "live"
                    if mode == "unplug":
                        server.listen()
                    over.append(await until(camera, "OK"))
                _row(mode, named, over)
            for what in (signal.SIGKILL, signal.SIGSTOP):
                over = []
                for _ in range(rounds):
                    await asyncio.sleep(rng.uniform(0.5, 1.0))
                    if camera.pid is None:
                        continue
                    os.kill(camera.pid, what)
                    began = time.monotonic()
                    while (frame := await camera.frame(wait=20)) and frame.stamp < began:
                        pass
                    over.append(time.monotonic() - began)
                longest = f"{median(over):>9.2f}{max(over):>12.2f}"
                print(f"{what.name:<34}{longest}   until the next picture")


def _row(mode: str, named: list[float], over: list[float]) -> None:
    worst = max(*named, *over)
    late = "" if worst <= WANTED else "   LATE"
    print(
        f"{mode:<12}{median(named):>10.2f}{max(named):>12.2f}"
        f"{median(over):>9.2f}{max(over):>12.2f}{late}"
    )


def main() -> None:
    """Measure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--lasts", type=float, default=4.0, help="s for which trouble lasts")
    asked = parser.parse_args()
    asyncio.run(measure(asked.rounds, asked.lasts))


if __name__ == "__main__":
    main()
