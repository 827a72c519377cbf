"""Calling an expert on a terminal: a call that fails, one answered late, one answered at once."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from tangy_tui.app.device_simulator import DeviceSimulator
from tests.real.test_live_robot_file import begin, bench, program, robot_file
from tests.support.terminal import TANGY, Terminal

__all__ = ["bench"]  # the robot beside the program

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
CALLED = """
[expert]
name = "Anna Berg"
telephone = "030 901820"
command = [{command}]
"""


def halted(terminal: Terminal, bench: DeviceSimulator) -> None:
    """Press the button for emergencies, and wait until the dialog takes keys."""
    bench.do("inject", kind="emergency-stop")
    terminal.until("Tangy stands still")
    terminal.settle()


def cleared(terminal: Terminal, bench: DeviceSimulator) -> None:
    """Pull the button out, and clear the fault."""
    bench.do("lift", kind="emergency-stop")
    terminal.until("It is gone now")
    terminal.type("r")
    terminal.until(lambda text: "Tangy stands still" not in text)


def test_the_dialog_and_the_log_say_what_came_of_each_call(
    folder: Path, bench: DeviceSimulator, monkeypatch: pytest.MonkeyPatch
) -> None:
    command = folder / "ring"
    command.write_text(COMMAND)
    command.chmod(0o755)

    def with_an_expert(bench: DeviceSimulator, folder: Path) -> Path:
        file = robot_file(bench, folder)
        file.write_text(file.read_text() + CALLED.format(command=json.dumps(str(command))))
        return file

    monkeypatch.setattr("tests.real.test_live_robot_file.robot_file", with_an_expert)
    terminal = program(bench, folder)
    try:
        begin(terminal)

        halted(terminal, bench)
        terminal.type("e")
        terminal.until("Tangy cannot reach Anna Berg (it ended with status 3: no line to the")
        terminal.type("e")
        terminal.until("Tangy is sending a message to Anna Berg.")
        assert "call Anna Berg: 030 901820" in " ".join(terminal.text.replace("┃", "").split())
        (folder / "picked-up").touch()
        terminal.until("Anna Berg has answered: I am on my way.")
        cleared(terminal, bench)

        halted(terminal, bench)
        terminal.type("e")
        terminal.until("Anna Berg has answered: I see it.")
        cleared(terminal, bench)
    finally:
        terminal.end()

    show = [TANGY, "log", "show", "last", "--json", "--data", str(folder)]
    done = subprocess.run(show, check=True, capture_output=True, text=True)  # noqa: S603
    calls = [one for one in json.loads(done.stdout)["moments"] if one["kind"] == "call"]
    told = [(one["stage"], one.get("said", "")) for one in calls]
    assert told == [
        ("tried", ""),
        ("failed", "it ended with status 3: no line to the outside"),
        ("tried", ""),
        ("answered", "I am on my way"),
        ("tried", ""),
        ("answered", "I see it"),
    ]
    assert "Somebody pressed the emergency stop." in (folder / "messages").read_text()
