"""The robot stops if the program fails, and the program reports failures of the robot process."""

from __future__ import annotations

import json
import os
import pty
import select
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from statistics import median, quantiles
from typing import Any

import pytest

from tangy_hw.device_protocols import DeviceError
from tangy_hw.robot_client.client import CHILD, RobotLink
from tangy_hw.robot_process.controller import HAZARD_SECONDS
from tangy_hw.robot_process.stop_latch import Preempted
from tangy_profiles.worker_lines import LONGEST_LINE
from tangy_tui.app.device_simulator import DeviceSimulator
from tests.real.bench_setup import setup_on
from tests.support.waiting import wait_until

ROOT = Path(__file__).parents[2]
STOPS = 0.6  # s after the program's end until the base stands still
BASE_STOPS = 1.0  # s in which a base stands by itself: half of it its time-out, and braking
ZERO = 0.35  # s from the last data to a command to stand, for 95 of 100
BRAKES = 0.4  # s that the bench's wheels take to stand from .5 m/s, and a tick of the bench
TRIALS = 20
SCANS, FIRST_SCAN, TICK = 0.1, 0.05, 0.05  # s of simulated time
SAID = 0.35  # s until the end of the robot process is known
TABLE = 5.0  # m: where its near edge is
FROZEN = 3.0  # s, long after the link is known to be silent
PATIENCE = 30.0

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("robot")]


class Program:
    """A program on its own terminal that drives the robot up and down."""

    def __init__(self, bench: DeviceSimulator) -> None:
        self.terminal, theirs = pty.openpty()
        command = [sys.executable, "-m", "tests.real.driving_program", setup_on(bench).to_json()]
        self.process = subprocess.Popen(  # noqa: S603 - our own program
            command, cwd=ROOT, stdin=theirs, stdout=theirs, stderr=theirs, start_new_session=True
        )
        os.close(theirs)

    def close(self) -> None:
        with suppress(ProcessLookupError):
            self.process.send_signal(signal.SIGCONT)
            self.process.kill()
        self.process.wait()
        if self.terminal >= 0:
            os.close(self.terminal)

    def hang_up(self) -> None:
        os.close(self.terminal)
        self.terminal = -1
        self.process.send_signal(signal.SIGHUP)


@pytest.fixture
def program(bench: DeviceSimulator) -> Iterator[Program]:
    program = Program(bench)
    wait_until(lambda: speed(bench) > 0.25, "the robot drives")
    yield program
    program.close()


def speed(bench: DeviceSimulator) -> float:
    """The robot's true speed, in m/s of simulated time."""
    before = bench.do("truth")["truth"]
    time.sleep(0.1)
    after = bench.do("truth")["truth"]
    way = sum((a - b) ** 2 for a, b in zip(after["pose"][:2], before["pose"][:2], strict=True))
    return float(way**0.5 / max(1e-6, after["time"] - before["time"]))


def seconds_to_stop(bench: DeviceSimulator) -> float:
    """The simulated time until the robot stands, from now on."""
    began = bench.do("truth")["truth"]["time"]
    until = time.monotonic() + PATIENCE
    while time.monotonic() < until:
        truth = bench.do("truth")["truth"]
        if not truth["moving"]:
            return float(truth["time"] - began)
        time.sleep(0.01)
    return PATIENCE


@pytest.mark.parametrize("ending", ["killed", "hung", "hung up"])
def test_the_base_stops_if_the_program_ends_or_hangs(
    bench: DeviceSimulator, program: Program, ending: str
) -> None:
    wait_until(lambda: speed(bench) > 0.25, "the robot drives")
    if ending == "killed":
        program.process.kill()
    elif ending == "hung":
        program.process.send_signal(signal.SIGSTOP)
    else:
        program.hang_up()

    assert seconds_to_stop(bench) <= STOPS
    stood = bench.do("truth")["truth"]["pose"]
    time.sleep(0.5)
    assert bench.do("truth")["truth"]["pose"] == pytest.approx(stood, abs=1e-3)


def test_a_program_that_continues_does_not_resume_the_drive(
    bench: DeviceSimulator, program: Program
) -> None:
    program.process.send_signal(signal.SIGSTOP)
    assert seconds_to_stop(bench) <= STOPS
    time.sleep(2 * HAZARD_SECONDS)
    program.process.send_signal(signal.SIGCONT)

    said = b""
    until = time.monotonic() + PATIENCE
    while b"broken off" not in said and time.monotonic() < until:
        if select.select([program.terminal], [], [], 0.1)[0]:
            said += os.read(program.terminal, 1000)
    assert b"the program says nothing" in said


def is_there(process: int) -> bool:
    """Return whether a process runs; a process that has ended may remain as a zombie."""
    try:
        stat = Path(f"/proc/{process}/stat").read_text()
    except OSError:
        return False
    return stat.rpartition(")")[2].split()[0] != "Z"


def test_a_robot_process_ends_with_its_program_despite_an_open_pipe() -> None:
    command = f"exec 3<&0; {shlex.join(CHILD)} $$ <&3 & echo $!; sleep 1"
    with subprocess.Popen(  # noqa: S602 - our own program
        command, shell=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as program:
        assert program.stdout is not None
        robot = int(program.stdout.readline())
        assert is_there(robot)
        wait_until(lambda: program.poll() is not None, "the program ends")
        wait_until(lambda: not is_there(robot), "the robot process ends")


def test_a_stop_overtakes_a_drive_and_latches(bench: DeviceSimulator, link: RobotLink) -> None:
    drive = link.ask("go", to=[8.0, 3.0, 1.57])
    wait_until(lambda: speed(bench) > 0.25, "the robot drives")
    link.stop("somebody said so")

    assert seconds_to_stop(bench) <= STOPS
    with pytest.raises(Preempted, match="somebody said so"):
        drive.result(PATIENCE)
    with pytest.raises(Preempted, match="somebody said so"):
        link.do("go", to=[8.0, 3.0, 1.57])
    link.release()
    assert link.do("go", to=[5.0, 2.0, 1.57])["arrived"]


def seconds_to_zero(bench: DeviceSimulator) -> float:
    """The delay from the last scan to the command to stand, if the scanner falls silent now."""
    began = time.monotonic()
    bench.do("inject", kind="laser-disconnected")
    ticks: int = round((bench.do("truth")["truth"]["time"] - FIRST_SCAN) / TICK)
    since_scan = ticks % round(SCANS / TICK) * TICK
    while any(bench.do("truth")["truth"]["commanded"]):
        assert time.monotonic() < began + PATIENCE
        time.sleep(0.003)
    return time.monotonic() - began + since_scan


def test_a_silent_laser_stops_the_robot(bench: DeviceSimulator, link: RobotLink) -> None:
    told, stood = [], []
    for number in range(TRIALS):
        drive = link.ask("go", to=[[8.0, 3.0, 1.57], [2.0, 3.0, 1.57]][number % 2])
        wait_until(lambda: speed(bench) > 0.25, "the robot drives")
        told.append(seconds_to_zero(bench))
        stood.append(told[-1] + seconds_to_stop(bench))
        with pytest.raises(Preempted, match="laser scanner says nothing"):
            drive.result(PATIENCE)
        bench.do("lift", kind="laser-disconnected")
        wait_until(lambda: not link.beat().hazard, "the laser is back")

    p95 = quantiles(told, n=20, method="inclusive")[-1]
    print(f"zero: median {median(told):.3f}, p95 {p95:.3f} s; stands: median {median(stood):.2f} s")
    assert p95 <= ZERO
    assert median(stood) <= ZERO + BRAKES


def test_a_killed_robot_process_is_reported_and_restarted(
    bench: DeviceSimulator, link: RobotLink
) -> None:
    drive = link.ask("go", to=[8.0, 3.0, 1.57])
    wait_until(lambda: speed(bench) > 0.25, "the robot drives")
    assert link.pid is not None
    os.kill(link.pid, signal.SIGKILL)
    with pytest.raises(Preempted, match="has ended"):
        drive.result(SAID)
    assert link.silent == "the robot process has ended (signal 9)"
    assert {reading.state for reading in link.health()} == {"STALE"}
    assert seconds_to_stop(bench) <= BASE_STOPS
    with pytest.raises(DeviceError):
        link.do("go", to=[5.0, 2.0, 1.57])

    link.stop("staff stopped it")
    link.restart()
    with pytest.raises(Preempted, match="staff stopped it"):
        link.do("go", to=[5.0, 2.0, 1.57])
    link.release()
    assert link.do("go", to=[5.0, 2.0, 1.57])["arrived"]


def test_a_frozen_robot_process_stays_stopped_until_release(
    bench: DeviceSimulator, link: RobotLink
) -> None:
    drive = link.ask("go", to=[8.0, 3.0, 1.57])
    wait_until(lambda: speed(bench) > 0.25, "the robot drives")
    assert link.pid is not None
    os.kill(link.pid, signal.SIGSTOP)
    try:
        assert seconds_to_stop(bench) <= BASE_STOPS
        wait_until(lambda: link.silent != "", "it is said that nothing is heard")
        time.sleep(FROZEN)
        stood = bench.do("truth")["truth"]["pose"]
    finally:
        os.kill(link.pid, signal.SIGCONT)

    with pytest.raises(Preempted, match="it was frozen for"):
        drive.result(PATIENCE)
    link.release("staff")
    with pytest.raises(Preempted, match="it was frozen for"):
        link.do("go", to=[8.0, 3.0, 1.57])
    assert bench.do("truth")["truth"]["pose"] == pytest.approx(stood, abs=1e-3)
    assert link.beat().frozen >= FROZEN
    link.release("fault")
    assert link.do("go", to=[5.0, 2.0, 1.57])["arrived"]
    assert link.beat().frozen == 0.0


def test_driving_by_hand_is_slow_near_the_table_and_stops_before_it(
    bench: DeviceSimulator, link: RobotLink
) -> None:
    """The table's top is above the scanner: only the map shows it."""
    fastest = 0.0

    def drive(forward: float, turn: float, until: Callable[[dict[str, Any]], bool]) -> None:
        nonlocal fastest
        ends = time.monotonic() + PATIENCE
        while time.monotonic() < ends:
            link.tell("drive", forward=forward, turn=turn)
            truth: dict[str, Any] = bench.do("truth")["truth"]
            fastest = max(fastest, abs(truth["commanded"][0]))
            assert not truth["bumped"]
            if until(truth):
                return
            time.sleep(0.05)
        raise AssertionError(f"{forward}, {turn}: it did not come about")

    drive(5.0, 0.0, lambda _: link.state.held == "stands")
    wait_until(lambda: speed(bench) < 0.01, "it stands")
    assert 0.4 < fastest <= 0.5
    near = bench.do("truth")["truth"]["pose"][1]
    assert 0.3 < TABLE - near < 0.6  # the robot's radius, and a hand
    drive(-5.0, 0.0, lambda truth: truth["pose"][1] < near - 0.1)
    drive(0.0, 1.0, lambda truth: abs(truth["pose"][2]) > 2.8)
    drive(0.3, 0.0, lambda truth: truth["commanded"][0] > 0.1)
    bench.do("inject", kind="laser-disconnected")
    drive(0.3, 0.0, lambda truth: not truth["moving"] and "laser" in link.state.hazard)


def test_nonsense_lines_are_answered_and_do_not_end_the_process(
    bench: DeviceSimulator,
) -> None:
    wrong = [
        "[" * 100_000,
        '{"id": [1], "do": "spin"}',
        '{"id": 1, "do": ["go"]}',
        '{"id": 2, "do": "drive", "forward": "fast", "turn": 0}',
        '{"id": 3, "do": "drive", "forward": NaN, "turn": 0}',
        "x" * (2 * LONGEST_LINE),
    ]
    with subprocess.Popen(  # noqa: S603 - our own program
        [*CHILD, str(os.getpid())], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as robot:
        assert robot.stdin is not None and robot.stdout is not None
        said = (json.loads(line) for line in robot.stdout)
        robot.stdin.write(setup_on(bench).to_json() + "\n")
        robot.stdin.flush()
        next(one for one in said if "ready" in one)
        for line in wrong:
            robot.stdin.write(line + "\n")
            robot.stdin.flush()
            answer = next(one for one in said if "beat" not in one)
            assert "failed" in answer, line[:60]
        robot.stdin.write('{"id": 9, "do": "wait", "seconds": 0.1}\n')
        robot.stdin.flush()
        assert "done" in next(one for one in said if one.get("id") == 9)
        robot.stdin.close()
        assert robot.wait(PATIENCE) == 0
