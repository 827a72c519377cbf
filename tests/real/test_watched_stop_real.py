"""A STOP from a watching console stops the wheels of the robot."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
from websockets.sync.client import connect

from tangy_tui.app.watching import Guest
from tests.support.processes import Family
from tests.support.terminal import TANGY, Terminal
from tests.support.wheels import Wheels, rosbridge

STOPS = 0.5  # s from the STOP until the wheels stand
DRIVES = 0.25  # m/s, from which it counts as driving
STANDS = 1e-3  # m/s
PATIENCE = 60.0

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("robot")]


@pytest.mark.parametrize("seed", [5, 6, 7])
def test_a_stop_from_a_second_console_stops_the_wheels_at_once(folder: Path, seed: int) -> None:
    family = Family()
    game = ["live", "--bench", "--begin", "--pace", "5", "--seed", str(seed), "--data", str(folder)]
    terminal = Terminal([TANGY, *game], environment=family.environment)
    try:
        terminal.until("Now")
        (bench,) = (pid for pid, run in family.there().items() if "tangy_sim.device" in run)
        with connect(rosbridge(bench)) as link:
            wheels = Wheels(link)
            if "Is all well now?" in terminal.until(
                lambda text: "greet everyone" in text or "well" in text
            ):
                terminal.type("y")
            terminal.until("call number")
            terminal.type("h")
            terminal.until("Who needs help?")
            terminal.type("\r")
            ends = time.monotonic() + PATIENCE
            while wheels.speed < DRIVES and time.monotonic() < ends:
                terminal.read(0.1)
            guest = Guest(folder)
            guest.look()
            assert wheels.speed >= DRIVES
            begun = time.monotonic()
            guest.stop("Ann")
            terminal.until("STOPPED")
            while wheels.speed > STANDS and time.monotonic() < begun + 5.0:
                terminal.read(0.02)
            assert wheels.speed <= STANDS
            print(wheels.still_since() - begun)
            assert wheels.still_since() - begun <= STOPS
            guest.close()
    finally:
        terminal.end()
