"""Terminals, a taught folder and a bench for tests with real processes."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tangy_hw.robot_client.client import RobotLink
from tangy_tui.app.device_simulator import DeviceSimulator
from tangy_tui.app.teacher_profile import TeacherProfile, save_profile
from tests.real.bench_setup import setup_on
from tests.support.terminal import TANGY, Terminal, Tmux

OpenTerminal = Callable[..., Terminal]


@pytest.fixture(scope="session")
def tangy() -> str:
    """The path of the program."""
    return TANGY


@pytest.fixture
def open_terminal(tmp_path: Path) -> Iterator[OpenTerminal]:
    """Open terminals that run `tangy` with these words, in the test's own data folder."""
    opened: list[Terminal] = []

    def open_one(
        *words: str,
        columns: int = 80,
        lines: int = 24,
        environment: dict[str, str] | None = None,
        data: bool = True,
    ) -> Terminal:
        folder = ["--data", str(tmp_path / "data")] if data else []
        if data:  # the teacher's name is known already
            (tmp_path / "data").mkdir(exist_ok=True)
            save_profile(tmp_path / "data", TeacherProfile("Ada"))
        terminal = Terminal(
            [TANGY, *words, *folder], columns=columns, lines=lines, environment=environment
        )
        opened.append(terminal)
        return terminal

    yield open_one
    for terminal in opened:
        terminal.end()


@pytest.fixture
def open_tmux(tmp_path: Path) -> Iterator[Callable[[int, int], Tmux]]:
    """Open a tmux window of this size."""
    if shutil.which("tmux") is None:
        pytest.skip("tmux is not installed")
    opened: list[Tmux] = []

    def open_one(columns: int, lines: int) -> Tmux:
        tmux = Tmux(tmp_path, columns, lines)
        opened.append(tmux)
        return tmux

    yield open_one
    for tmux in opened:
        tmux.end()


@pytest.fixture(scope="module")
def taught(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A data folder with one guided game, and the policy learnt from it."""
    folder = tmp_path_factory.mktemp("taught")
    teach = ["teach", "--guided", "--teacher", "scripted", "--plain"]
    for command in (teach, ["learn"]):
        subprocess.run(  # noqa: S603
            [TANGY, *command, "--data", str(folder)], check=True, capture_output=True
        )
    return folder


@pytest.fixture
def folder(taught: Path, tmp_path: Path) -> Path:
    """A copy of the taught folder for one test, so that no game of another test continues in it."""
    return Path(shutil.copytree(taught, tmp_path / "taught"))


@pytest.fixture
def bench() -> Iterator[DeviceSimulator]:
    bench = DeviceSimulator(
        seed=1,
        people={"user1": "Ann", "user2": "Ben"},
        stepped=False,
        activity="bingo",
        robot="tangy",
    )
    yield bench
    bench.close()


@pytest.fixture
def robot_beside() -> Iterator[DeviceSimulator]:
    """A robot that runs beside the program, not under it, with the people of a game."""
    people = {f"user{number}": f"User {number}" for number in range(1, 5)}
    robot = DeviceSimulator(seed=3, people=people, stepped=False, activity="bingo", robot="tangy")
    robot.do("begin")
    yield robot
    robot.close()


@pytest.fixture
def link(bench: DeviceSimulator) -> Iterator[RobotLink]:
    link = RobotLink(setup_on(bench))
    link.start()
    yield link
    link.close()
