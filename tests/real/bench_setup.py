"""A bench for one test, and the setup of a robot process that drives on it."""

from __future__ import annotations

from tangy_hw.robot_setup import RobotSetup
from tangy_tui.app.device_simulator import DeviceSimulator

FRONT = (5.0, 1.2, 1.5708)


def setup_on(bench: DeviceSimulator, *, stepped: bool = False, eyes: bool = False) -> RobotSetup:
    """Name the devices of a bench; without eyes no camera opens, which saves two processes."""
    at = bench.wires.rosbridge
    drivers = {name: {"kind": "rosbridge", "at": at} for name in ("base", "stop_button", "voice")}
    return RobotSetup(
        robot="tangy",
        activity="bingo",
        people=tuple(bench.wires.faces),
        drivers={**drivers, "laser": {"kind": "scip", "at": bench.wires.scip}},
        cameras={"camera": bench.wires.head} if eyes else {},
        requests=f"signs:{bench.wires.infrared}" if eyes else "",
        corners=bench.wires.corners,
        start=FRONT,
        stepped=stepped,
    )
