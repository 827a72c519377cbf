"""Runs a robot process with a gripper whose driver blocks: `python blocking_robot.py STEP PID`.

STEP is `open`, `start` or `read`. The base writes a line for each command to drive to a file
beside the robot's file.
"""

from __future__ import annotations

import sys
from pathlib import Path

from tangy_hw.drivers import registry
from tangy_hw.drivers.registry import DriverKind, DriverSettings, Wiring
from tangy_hw.robot_process import process
from tests.hw.blocking_drivers import Blocks
from tests.hw.live_bodies import ToldBase, ToldLaser


class Commands(list[object]):
    """Commands to the base, also in a file."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._path = path

    def append(self, told: object) -> None:
        with self._path.open("a") as file:
            print(told, file=file)


def main() -> None:
    """Run the robot process with these drivers."""
    step = sys.argv.pop(1)

    def opens(wiring: Wiring, settings: DriverSettings) -> Blocks | ToldBase | ToldLaser:
        told = Commands(wiring.robot.file.with_name("told.txt"))
        match settings.device:
            case "base":
                return ToldBase("base", told)
            case "laser":
                return ToldLaser("laser", told)
            case device:
                return Blocks(device, step)

    registry.DRIVERS = {"told": DriverKind(("base", "laser", "gripper"), opens)}
    process.main()


if __name__ == "__main__":
    main()
