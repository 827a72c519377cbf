"""Cancelling the opening of a robot: every exit of the program leaves no process running."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from tests.support.processes import Family
from tests.support.terminal import TANGY, Terminal

ENDS = 2.0  # s until everything has ended, on an idle machine
PATIENCE = 60.0
PROFILE = Path(__file__).parents[2] / "profiles/tangy_profiles/robots/tangy.toml"

BENCH, ROBOT, CAMERA = "tangy_sim.device_simulator", "tangy_hw.robot_process", "camera_child"
STAGES = (BENCH, ROBOT, CAMERA)
"""The processes in the order of their start."""

ENDINGS: dict[str, tuple[Callable[[Terminal], object], int]] = {
    "HUP": (lambda t: t.process.send_signal(signal.SIGHUP), 129),
    "TERM": (lambda t: t.process.send_signal(signal.SIGTERM), 143),
    "ctrl-c": (lambda t: t.type("\x03"), 0),
    "esc": (lambda t: t.type("\x1b"), 0),
    "closed": (lambda t: t.close(), 129),
}
"""The ways to end a program on a terminal, with the exit status of each."""

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("robot")]


@pytest.fixture
def family() -> Iterator[Family]:
    family = Family()
    yield family
    for pid in family.there():
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)


def runs(what: str) -> Callable[[dict[int, str]], bool]:
    return lambda there: any(what in command for command in there.values())


def nothing(there: dict[int, str]) -> bool:
    return not there


def assert_all_over(family: Family, started: set[int], meanwhile: Callable[[], object]) -> None:
    """Wait until nothing runs; no bench or robot process may have started meanwhile."""
    took = family.seconds_until(nothing, PATIENCE, meanwhile)
    late = {pid: family.seen[pid] for pid in family.seen.keys() - started}
    assert not [command for command in late.values() if BENCH in command or ROBOT in command]
    assert took <= ENDS * max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1))


@pytest.mark.parametrize("ending", ENDINGS)
@pytest.mark.parametrize("stage", STAGES)
def test_a_cancelled_opening_on_a_terminal_leaves_no_process(
    folder: Path, family: Family, stage: str, ending: str
) -> None:
    command = [TANGY, "live", "--bench", "--begin", "--data", str(folder)]
    terminal = Terminal(command, environment=family.environment)
    end, status = ENDINGS[ending]

    try:
        family.seconds_until(runs(stage), PATIENCE, lambda: terminal.read(0.0))
        started = set(family.there())
        end(terminal)
        read = (lambda: None) if ending == "closed" else (lambda: terminal.read(0.0))
        assert_all_over(family, started, read)
        assert terminal.process.wait(1) == status
    finally:
        terminal.end()


@pytest.mark.parametrize(
    ("number", "status"), [(signal.SIGHUP, 129), (signal.SIGTERM, 143), (signal.SIGINT, 130)]
)
@pytest.mark.parametrize("stage", STAGES)
def test_a_cancelled_opening_without_a_screen_leaves_no_process(
    folder: Path, family: Family, stage: str, number: int, status: int
) -> None:
    with subprocess.Popen(  # noqa: S603
        [TANGY, "live", "--bench", "--json", "--data", str(folder)],
        env={**os.environ, **family.environment},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
    ) as program:
        family.seconds_until(runs(stage), PATIENCE, lambda: None)
        started = set(family.there())
        program.send_signal(number)
        assert_all_over(family, started, lambda: None)
        out, err = program.communicate()
        assert (program.returncode, out) == (status, b"")
        assert b"Traceback" not in err


@pytest.fixture
def deaf() -> Iterator[int]:
    """A port that accepts connections and never sends anything."""
    with socket.create_server(("127.0.0.1", 0), backlog=64) as server:
        yield int(server.getsockname()[1])


@pytest.mark.parametrize("ending", ["HUP", "esc"])
def test_a_cancelled_opening_of_a_silent_robot_leaves_no_process(
    folder: Path, tmp_path: Path, family: Family, deaf: int, ending: str
) -> None:
    drivers = [
        "[drivers]",
        *(
            f'{name} = {{ kind = "rosbridge", at = "ws://127.0.0.1:{deaf}" }}'
            for name in ("base", "stop_button", "arms", "voice")
        ),
        f'laser = {{ kind = "scip", at = "tcp://127.0.0.1:{deaf}" }}',
    ]
    camera = f'source = "http://127.0.0.1:{deaf}/head"'
    text = PROFILE.read_text().replace('# source = "/dev/video0"', camera)
    file = tmp_path / "robot.toml"
    file.write_text(f"{text}\n" + "\n".join(drivers) + "\n")
    command = [TANGY, "live", "--robot", str(file), "--begin", "--data", str(folder)]
    terminal = Terminal(command, environment=family.environment)
    end, status = ENDINGS[ending]
    try:
        family.seconds_until(runs(CAMERA), PATIENCE, lambda: terminal.read(0.0))
        terminal.settle(0.2)
        started = set(family.there())
        end(terminal)
        assert_all_over(family, started, lambda: terminal.read(0.0))
        assert terminal.process.wait(1) == status
    finally:
        terminal.end()


def test_child_processes_end_after_the_program_is_killed(folder: Path, family: Family) -> None:
    command = [TANGY, "live", "--bench", "--begin", "--data", str(folder)]
    terminal = Terminal(command, environment=family.environment)
    try:
        family.seconds_until(runs(ROBOT), PATIENCE, lambda: terminal.read(0.0))
        terminal.process.kill()
        family.seconds_until(nothing, PATIENCE, lambda: None)
    finally:
        terminal.end()
