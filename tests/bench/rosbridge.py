"""The cost of the link by rosbridge: processor time for each message, and latency.

Run by hand: `python -m tests.bench.rosbridge [--messages N]`. Server and drivers share one process
and one event loop, with nothing else between them; costs include both ends,
latencies are of a loopback without other traffic.

`CPU ms`: processor time for one message, from `publish` to the driver's newest value. `step`: one
service call after a scan and two odometries were published, as a bench in lock-step
does ten times per simulated second. `stop`: from `RosBase.stop` until the simulator receives it,
with a thousand other messages waiting to be sent.
"""

from __future__ import annotations

import argparse
import asyncio
import time
from collections.abc import Mapping
from typing import Any

import numpy as np

from tangy_hw.device_protocols import Pose, Twist
from tangy_hw.drivers.ros_base import RosBase
from tangy_hw.drivers.ros_laser import RosLaser
from tangy_hw.drivers.ros_messages import pose_message, twist_message
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_sim.servers.rosbridge_server import RosbridgeServer

BEAMS = 360


def scan() -> dict[str, Any]:
    """Return a scan with a tenth of the beams without a return."""
    rng = np.random.default_rng(7)
    ranges = np.round(rng.uniform(0.3, 5, BEAMS), 3)
    ranges[rng.random(BEAMS) < 0.1] = np.inf
    shape = {"angle_min": -2.35, "angle_increment": 0.0131, "range_min": 0.1, "range_max": 5.0}
    return {**shape, "ranges": ranges}


def odometry() -> dict[str, Any]:
    """Return an odometry as robots send it, with its covariances."""
    return {
        "header": {"stamp": {"secs": 1, "nsecs": 2}, "frame_id": "odom"},
        "pose": {"pose": pose_message(Pose(1.2345, 2.3456, 0.5)), "covariance": [0.0] * 36},
        "twist": {"twist": twist_message(Twist(0.3, 0.1)), "covariance": [0.0] * 36},
    }


async def measure(messages: int) -> None:
    """Print the table."""
    server = RosbridgeServer()
    await server.start()
    bridge = Rosbridge(server.url)
    base, laser = RosBase(bridge, repeat=0), RosLaser(bridge)
    await base.start()
    await laser.start()
    await server.subscribed("/odom", "/scan")

    async def nothing(_: Mapping[str, Any]) -> dict[str, Any]:
        return {}

    async def advance(_: Mapping[str, Any]) -> dict[str, Any]:
        server.publish("/scan", "", scan_message)
        server.publish("/odom", "", odometry_message)
        server.publish("/odom", "", odometry_message)
        return {}

    server.provide("/nothing", nothing)
    server.provide("/bench/advance", advance)
    scan_message, odometry_message = scan(), odometry()

    print("                 CPU ms   latency ms p50   p95")
    for name, topic, message in (
        ("scan, 360 beams", "/scan", scan_message),
        ("odometry", "/odom", odometry_message),
    ):
        began = time.process_time()
        for _ in range(messages // 10):
            for _ in range(10):
                server.publish(topic, "", message)
            await bridge.call("/nothing", {})
        spent = time.process_time() - began
        print(f"{name:16} {1000 * spent / messages:6.3f}")

    for name, service in (("service", "/nothing"), ("step", "/bench/advance")):
        took = []
        began = time.process_time()
        for _ in range(messages):
            then = time.perf_counter()
            await bridge.call(service, {"seconds": 0.1})
            took.append(time.perf_counter() - then)
        spent = time.process_time() - began
        print(f"{name:16} {1000 * spent / messages:6.3f} {_percentiles(took)}")

    heard = asyncio.Event()
    server.on_message("/cmd_vel", lambda _: heard.set())
    for waiting in (0, 1_000):
        took = []
        for _ in range(100):
            await bridge.call("/nothing", {})
            heard.clear()
            for number in range(waiting):
                bridge.publish("/load", {"n": number})
            then = time.perf_counter()
            await base.stop()
            await heard.wait()
            took.append(time.perf_counter() - then)
        print(f"stop, {waiting:4} wait {'':7}{_percentiles(took)}")
    await base.close()
    await laser.close()
    await bridge.close()
    await server.close()


def _percentiles(took: list[float]) -> str:
    middle, late = np.percentile(took, (50, 95))
    return f"{1000 * middle:14.2f} {1000 * late:6.2f}"


def main() -> None:
    """Measure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--messages", type=int, default=2_000)
    asyncio.run(measure(parser.parse_args().messages))


if __name__ == "__main__":
    main()
