"""A hanging screen stops the robot, although the rest of the program runs."""

from __future__ import annotations

import time

import pytest

from tangy_hw.robot_client.client import HANGS_SECONDS, RobotLink
from tangy_hw.robot_process.stop_latch import Preempted
from tangy_tui.app.device_simulator import DeviceSimulator
from tests.support.waiting import wait_until

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("robot")]
FAR = [9.0, 1.2, 1.57]  # some ten seconds away
STOPS = 0.6  # s


def moves(bench: DeviceSimulator) -> bool:
    return bool(bench.do("truth")["truth"]["moving"])


def test_the_robot_stops_without_a_heartbeat_of_the_screen(
    bench: DeviceSimulator, link: RobotLink
) -> None:
    drive = link.ask("go", to=FAR)
    wait_until(lambda: moves(bench))
    link.alive()
    said = time.monotonic()
    wait_until(lambda: "the program says nothing" in link.state.hazard)
    wait_until(lambda: not moves(bench))
    assert HANGS_SECONDS - 0.1 < time.monotonic() - said < HANGS_SECONDS + STOPS
    with pytest.raises(Preempted):
        drive.result(10)

    link.alive()
    wait_until(lambda: link.state.hazard == "")


def test_a_program_without_a_screen_needs_no_heartbeat(
    bench: DeviceSimulator, link: RobotLink
) -> None:
    link.ask("go", to=FAR)
    wait_until(lambda: moves(bench))
    time.sleep(HANGS_SECONDS + 1.0)
    assert moves(bench) and link.state.hazard == ""
