"""Calls on a terminal: a failed one, and late, immediate and chest screen's answers."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest

from tangy_sim.device_simulator.tablet import Tablet
from tangy_tui.app.device_simulator import DeviceSimulator
from tests.real.robot_beside import begin, program
from tests.support.terminal import TANGY, Terminal
from tests.support.waiting import wait_until

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("robot")]

COMMAND = """#!/bin/sh
# Stands for a telephone: the first call fails, the second is answered late, others at once.
cd "$(dirname "$0")" && cat >> messages && echo >> calls
case "$(wc -l < calls)" in
    1) echo "no line to the outside" >&2; exit 3 ;;
    2) until [ -e picked-up ]; do sleep 0.1; done; echo "answered: I am on my way" ;;
    *) echo "answered: I see it" ;;
esac
"""
SENT = """
[expert]
name = "Anna Berg"
telephone = "030 901820"
command = ["true"]
[staff]
name = "Station 2"
command = ["true"]
"""
CALLED = """
[expert]
name = "Anna Berg"
telephone = "030 901820"
command = [{command}]
"""


def halted(terminal: Terminal, robot_beside: DeviceSimulator) -> None:
    """Press the emergency stop, and wait until the dialog takes keys."""
    robot_beside.do("inject", kind="emergency-stop")
    terminal.until("Tangy stands still")
    terminal.settle()


def cleared(terminal: Terminal, robot_beside: DeviceSimulator) -> None:
    """Release the emergency stop, and clear the fault."""
    robot_beside.do("lift", kind="emergency-stop")
    terminal.until("It is gone now")
    terminal.type("r")
    terminal.until(lambda text: "Tangy stands still" not in text)


def log(folder: Path, *options: str) -> str:
    """Return what `tangy log show last` prints."""
    show = [TANGY, "log", "show", "last", "--data", str(folder), *options]
    return subprocess.run(show, check=True, capture_output=True, text=True).stdout  # noqa: S603


def test_the_dialog_and_the_log_show_the_result_of_each_call(
    folder: Path, robot_beside: DeviceSimulator
) -> None:
    command = folder / "ring"
    command.write_text(COMMAND)
    command.chmod(0o755)
    called = CALLED.format(command=json.dumps(str(command)))
    terminal = program(robot_beside, folder, called)
    try:
        begin(terminal)

        halted(terminal, robot_beside)
        terminal.type("e")
        terminal.until("Tangy cannot reach Anna Berg (it ended with status 3: no line to the")
        terminal.type("e")
        terminal.until("Tangy is sending a message to Anna Berg.")
        assert "call Anna Berg: 030 901820" in " ".join(terminal.text.replace("┃", "").split())
        (folder / "picked-up").touch()
        terminal.until("Anna Berg was reached, and answered: I am on my way.")
        cleared(terminal, robot_beside)

        halted(terminal, robot_beside)
        terminal.type("e")
        terminal.until("Anna Berg was reached, and answered: I see it.")
        cleared(terminal, robot_beside)
    finally:
        terminal.end()

    calls = json.loads(log(folder, "--json"))["moments"]
    told = [(one["stage"], one.get("said", "")) for one in calls if one["kind"] == "call"]
    assert told == [
        ("tried", ""),
        ("failed", "it ended with status 3: no line to the outside"),
        ("tried", ""),
        ("answered", "I am on my way"),
        ("tried", ""),
        ("answered", "I see it"),
    ]
    assert "Somebody pressed the emergency stop." in (folder / "messages").read_text()


def test_a_press_on_the_chest_screen_answers_the_call(
    folder: Path, robot_beside: DeviceSimulator
) -> None:
    terminal, tablet = program(robot_beside, folder, SENT), None
    where = re.compile(r"chest screen (http://[\d.:]+/) code (\d{4}-\d{4})")
    try:
        begin(terminal)
        found = where.search(terminal.until(lambda text: where.search(text) is not None))
        assert found is not None
        tablet = Tablet(found[1], found[2])
        wait_until(lambda: bool(tablet.picture), "the tablet is paired")

        halted(terminal, robot_beside)
        terminal.until("Tangy has sent a message to Station 2. Nobody has answered yet")
        terminal.type("e")
        terminal.until("Tangy has sent a message to Anna Berg. Nobody has answered yet")
        wait_until(lambda: len(tablet.calls) == 2, "a button for each call")
        assert list(tablet.calls.values()) == ["Station 2", "Anna Berg"]
        staff, expert = tablet.calls
        assert tablet.press(expert)
        terminal.until("! Anna Berg was reached: they answered on the chest screen.")
        assert "Call the expert" not in terminal.text
        assert tablet.press(staff)
        terminal.until("! Station 2 was reached: they answered on the chest screen.")
        wait_until(lambda: not tablet.calls, "the buttons are gone")
        assert not tablet.press(staff)
        cleared(terminal, robot_beside)
    finally:
        if tablet is not None:
            tablet.close()
        terminal.end()

    told = log(folder)
    assert "The expert (chest screen): was reached, and answered." in told
    assert "The staff (chest screen): was reached, and answered." in told
