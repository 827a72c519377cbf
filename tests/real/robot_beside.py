"""A robot that runs beside the program, named by its file, and a terminal that plays with it."""

from __future__ import annotations

from pathlib import Path

from tangy_tui.app.device_simulator import DeviceSimulator
from tests.support.terminal import TANGY, Terminal

ROOT = Path(__file__).parents[2]
PROFILE = ROOT / "profiles/tangy_profiles/robots/tangy.toml"
ROSBRIDGE = ("base", "stop_button", "arms", "voice")


def robot_file(robot: DeviceSimulator, folder: Path, contacts: str = "") -> Path:
    """Write the file of the robot, as docs/robots.md tells, with tables of contacts at its end."""
    at = robot.wires.rosbridge
    drivers = [
        "[drivers]",
        *(f'{name} = {{ kind = "rosbridge", at = "{at}" }}' for name in ROSBRIDGE),
        f'laser = {{ kind = "scip", at = "{robot.wires.scip}" }}',
        'screen = { kind = "page", port = 0 }',
    ]
    text = PROFILE.read_text().replace('# source = "/dev/video0"', f'source = "{robot.wires.head}"')
    file = folder / "robot.toml"
    file.write_text(f"{text}\n" + "\n".join(drivers) + "\n" + contacts)
    return file


def program(robot: DeviceSimulator, folder: Path, contacts: str = "") -> Terminal:
    """Open a terminal with the program playing with the robot."""
    corners = ",".join(f"{x:g},{y:g}" for x, y in robot.wires.corners)
    file = robot_file(robot, folder, contacts)
    command = [
        *(TANGY, "live", "--robot", str(file), "--begin", "--pace", "3"),
        *("--requests", f"signs:{robot.wires.infrared}", "--table", corners),
        *("--data", str(folder)),
    ]
    return Terminal(command)


def begin(terminal: Terminal) -> None:
    """Begin the game; confirm that faults are over if the program asks."""
    if "Is all well now?" in terminal.until(
        lambda text: "greet everyone" in text or "well" in text
    ):
        terminal.settle()
        terminal.type("y")
    terminal.until("Now")
