"""`tangy live --robot FILE`: a running robot, named by its file, and how the program ends.

The robot is a bench that runs beside the program and not under it, as a robot does.
"""

from __future__ import annotations

import re
import signal
import time
from pathlib import Path

import pytest

from tangy_sim.device_simulator.tablet import Tablet
from tangy_tui.app.device_simulator import DeviceSimulator
from tests.real.robot_beside import begin, program
from tests.real.test_robot_process import STOPS, seconds_to_stop, speed
from tests.support.waiting import wait_until

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("robot")]


@pytest.mark.parametrize("ending", [signal.SIGKILL, signal.SIGSTOP, signal.SIGHUP])
def test_a_robot_from_a_file_plays_and_stops_if_the_program_ends_or_hangs(
    folder: Path, robot_beside: DeviceSimulator, ending: signal.Signals
) -> None:
    terminal = program(robot_beside, folder)
    try:
        begin(terminal)
        terminal.type("u")  # the steps in place of the staff view
        terminal.until("call number")
        robot_beside.do("ask", person="user2")
        terminal.until("coming to you")
        wait_until(lambda: speed(robot_beside) > 0.25, "the robot drives")

        terminal.process.send_signal(ending)
        assert seconds_to_stop(robot_beside) <= STOPS
        stood = robot_beside.do("truth")["truth"]["pose"]
        time.sleep(0.5)
        assert robot_beside.do("truth")["truth"]["pose"] == pytest.approx(stood, abs=1e-3)
    finally:
        terminal.process.send_signal(signal.SIGCONT)
        terminal.end()


UP, DOWN = "\x1b[A", "\x1b[B"


def test_a_tablet_is_paired_with_the_code_of_the_live_screen(
    folder: Path, robot_beside: DeviceSimulator
) -> None:
    terminal = program(robot_beside, folder)
    told = re.compile(r"(http://[\d.:]+/), code[^\d]+(\d{4}-\d{4})")
    tablet = None
    try:
        if "Is all well now?" in terminal.until(
            lambda text: "greet everyone" in text or "well" in text
        ):
            terminal.settle()
            terminal.type("y")
        terminal.until("No screen")  # no tablet is paired yet
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
