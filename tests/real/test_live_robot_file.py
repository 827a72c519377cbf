"""`tangy live --robot FILE`: a robot that is there, named by its file, and how the program ends.

The robot is a bench that runs beside the program and not under it, as a robot does.
"""

from __future__ import annotations

import re
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tangy_sim.device_simulator.tablet import Tablet
from tangy_tui.app.device_simulator import DeviceSimulator
from tests.real.test_robot_process import STOPS, seconds_to_stop, speed
from tests.support.terminal import TANGY, Terminal
from tests.support.waiting import wait_until

ROOT = Path(__file__).parents[2]
PROFILE = ROOT / "profiles/tangy_profiles/robots/tangy.toml"
PEOPLE = {f"user{number}": f"User {number}" for number in range(1, 5)}

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("robot")]


@pytest.fixture
def bench() -> Iterator[DeviceSimulator]:
    bench = DeviceSimulator(seed=3, people=PEOPLE, stepped=False, activity="bingo", robot="tangy")
    bench.do("begin")
    yield bench
    bench.close()


def robot_file(bench: DeviceSimulator, folder: Path) -> Path:
    """Write the file of the robot that the bench is, as docs/robots.md tells."""
    at = bench.wires.rosbridge
    drivers = [
        "[drivers]",
        *(f'{name} = {{ kind = "rosbridge", at = "{at}" }}' for name in ROSBRIDGE),
        f'laser = {{ kind = "scip", at = "{bench.wires.scip}" }}',
        'screen = { kind = "page", port = 0 }',
    ]
    text = PROFILE.read_text().replace('# source = "/dev/video0"', f'source = "{bench.wires.head}"')
    file = folder / "robot.toml"
    file.write_text(f"{text}\n" + "\n".join(drivers) + "\n")
    return file


ROSBRIDGE = ("base", "stop_button", "arms", "voice")


def program(bench: DeviceSimulator, folder: Path) -> Terminal:
    corners = ",".join(f"{x:g},{y:g}" for x, y in bench.wires.corners)
    command = [
        *(TANGY, "live", "--robot", str(robot_file(bench, folder)), "--begin", "--pace", "3"),
        *("--requests", f"signs:{bench.wires.infrared}", "--table", corners),
        *("--data", str(folder)),
    ]
    return Terminal(command)


def begin(terminal: Terminal) -> None:
    """Let the game begin: faults of the start are over when they are asked about."""
    if "Is all well now?" in terminal.until(
        lambda text: "greet everyone" in text or "well" in text
    ):
        terminal.settle()
        terminal.type("y")
    terminal.until("Now")


@pytest.mark.parametrize("ending", [signal.SIGKILL, signal.SIGSTOP, signal.SIGHUP])
def test_a_robot_of_a_file_plays_and_stands_when_the_program_ends_or_hangs(
    folder: Path, bench: DeviceSimulator, ending: signal.Signals
) -> None:
    terminal = program(bench, folder)
    try:
        begin(terminal)
        terminal.type("u")  # the steps in place of what staff see
        terminal.until("call number")
        bench.do("ask", person="user2")
        terminal.until("coming to you")
        wait_until(lambda: speed(bench) > 0.25, "the robot drives")

        terminal.process.send_signal(ending)
        assert seconds_to_stop(bench) <= STOPS
        stood = bench.do("truth")["truth"]["pose"]
        time.sleep(0.5)
        assert bench.do("truth")["truth"]["pose"] == pytest.approx(stood, abs=1e-3)
    finally:
        terminal.process.send_signal(signal.SIGCONT)
        terminal.end()


UP, DOWN = "\x1b[A", "\x1b[B"


def test_a_tablet_is_paired_by_what_the_live_screen_tells(
    folder: Path, bench: DeviceSimulator
) -> None:
    terminal = program(bench, folder)
    told = re.compile(r"(http://[\d.:]+/), code[^\d]+(\d{4}-\d{4})")
    tablet = None
    try:
        if "Is all well now?" in terminal.until(
            lambda text: "greet everyone" in text or "well" in text
        ):
            terminal.settle()
            terminal.type("y")
        terminal.until("No screen")  # nobody has paired a tablet yet
        terminal.type("7")
        terminal.until("chest screen")
        terminal.type(DOWN * 9 + UP)  # from the last one up
        found = told.search(terminal.until(lambda text: told.search(text) is not None))
        assert found is not None
        tablet = Tablet(found[1], found[2])
        wait_until(lambda: bool(tablet.picture.get("number")), "a number is shown")
        assert (folder / "tablets.json").exists()
    finally:
        if tablet is not None:
            tablet.close()
        terminal.end()
