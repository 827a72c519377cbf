"""A drive by the keys that records scans, and the map drawn from them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from math import hypot
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_setup import RobotSetup
from tangy_tui.app.device_simulator import DeviceSimulator
from tangy_tui.app.robot_opening import BENCH_LOG, LOG, Opening, check_drivers, start_of

if TYPE_CHECKING:
    from tangy_hw.cancellation import Cancellation
    from tangy_hw.navigation.occupancy import OccupancyMap
    from tangy_tui.app.workspace import Workspace

COARSE = 0.1
"""Cell size in m of the map shown during the drive: odometry drifts, so finer cells would not help.
"""
DRIVES_BY = ("base", "stop_button")
"""The devices that a drive on the bench reaches by rosbridge; the scanner has its own connection.
"""


class SoFar(NamedTuple):
    """The record of a drive so far: number of scans, metres driven, and a map by odometry alone."""

    scans: int
    metres: float
    map: OccupancyMap


def opening_for_map(
    workspace: Workspace, record: Path, *, bench: bool, seed: int
) -> Opening[RobotLink]:
    """Return what switches a robot on for a drive by the keys, without a map.

    Args:
        workspace: gives the robot and the room.
        record: file for the scans; it must not exist yet.
        bench: simulate the devices.
        seed: seeds the bench.

    Raises:
        DeviceError: the robot's file names no drivers.
    """
    if not bench:
        check_drivers(workspace.robot)

    @contextmanager
    def opening(stepped: bool, cancellation: Cancellation) -> Iterator[RobotLink]:
        setup = RobotSetup(
            robot=str(workspace.robot.file),
            activity=workspace.profile,
            people=tuple(workspace.names),
            room=workspace.room.name,
            start=start_of(workspace.room, tuple(workspace.names)),
            record=str(record),
            log=str(workspace.store.folder / LOG),
        )
        if not bench:
            with _linked(setup, workspace, cancellation) as link:
                yield link
            return
        simulator = DeviceSimulator(
            seed=seed,
            people=workspace.names,
            stepped=stepped,
            activity=workspace.profile,
            robot=setup.robot,
            room=setup.room,
            log=workspace.store.folder / BENCH_LOG,
            cancellation=cancellation,
        )
        try:
            with _linked(_on_bench(setup, simulator), workspace, cancellation) as link:
                yield link
        finally:
            simulator.close()

    return opening


def _on_bench(setup: RobotSetup, simulator: DeviceSimulator) -> RobotSetup:
    from dataclasses import replace

    wires = simulator.wires
    drivers = {name: {"kind": "rosbridge", "at": wires.rosbridge} for name in DRIVES_BY}
    return replace(setup, drivers={**drivers, "laser": {"kind": "scip", "at": wires.scip}})


@contextmanager
def _linked(
    setup: RobotSetup, workspace: Workspace, cancellation: Cancellation
) -> Iterator[RobotLink]:
    link = RobotLink(setup, log=workspace.store.folder / LOG, cancellation=cancellation)
    try:
        link.start()
        link.beat()
        yield link
    finally:
        link.close()


def map_so_far(record: Path) -> SoFar | None:
    """Draw the map of a drive so far; None if there is nothing to draw yet.

    A line that is still being written counts as nothing; the next call reads it whole.
    """
    from tangy_hw.navigation.mapping import MapError, PlacedScan, map_of_scans, sparse
    from tangy_hw.navigation.scan_log import LogError, read_log

    try:
        logged = read_log(record)
        scans = sparse(PlacedScan(one.scan, one.odometry) for one in logged)
        drawn = map_of_scans(scans, COARSE)
    except (LogError, MapError):
        return None
    way = pairwise(one.odometry for one in logged)
    return SoFar(len(logged), sum(hypot(b.x - a.x, b.y - a.y) for a, b in way), drawn)
