"""Live games on the bench: real processes, sockets, pixels and scans from end to end."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tangy_profiles.fault_file import load_faults
from tangy_profiles.store import Store
from tangy_sim.worlds.injection import read_injection
from tangy_tui.app.robot_opening import open_bench
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Acted
from tangy_tui.learning.policies import load_policy
from tangy_tui.monitoring.fault import Diagnosed, read_faults
from tangy_tui.monitoring.supervision import Event, Supervision
from tests.support.terminal import TANGY, Terminal

pytestmark = [pytest.mark.xdist_group("robot"), pytest.mark.slow]


@pytest.fixture
def data_folder(folder: Path) -> Path:
    """A folder with one guided game and the policy learnt from it."""
    return folder


def games(workspace: Workspace, world: BenchedWorld) -> Supervision:
    policy, _ = load_policy(workspace.store, workspace.activity, "")
    return workspace.supervision(policy, 1, asks=True, world=world)


def play(game: Supervision, steps: int) -> list[Event]:
    told: list[Event] = []
    wanted = game.steps + steps
    control = scripted_controller(game)
    while game.steps < wanted and not game.over:
        told += go_on_by_script(control, expert=True)
    return told


def test_a_robot_on_the_bench_calls_visits_reads_cards_and_returns(workspace: Workspace) -> None:
    book = load_faults(workspace.robot)
    with open_bench(workspace, seed=3, stepped=True, pace=2, book=book, kind=BenchedWorld) as world:
        game = games(workspace, world)
        told = game.begin() + play(game, 4)
        world.requests.ask_for("user2")
        told += play(game, 2)
        assert world.observe().place == "user2"
        assert world.truth()["place"] == "user2"  # as it really is
        while world.observe().place != "front" and not game.over:
            told += play(game, 1)

        acted = [event for event in told if isinstance(event, Acted)]
        assert all(event.right for event in acted)
        assert not [event for event in told if isinstance(event, Diagnosed)]
        score = world.score.to_json()
        assert score["identities"] == {"right": 1, "unknown": 0, "wrong": 0}
        assert score["reads"]["right"] >= 1 and score["reads"]["wrong"] == 0
        assert score["pose_error_m"]["p95"] < 0.15
        assert len(world.truth()["called"]) == len(world.called)  # people heard every call


def test_faults_on_the_bench_are_diagnosed_and_recovered(workspace: Workspace) -> None:
    book = load_faults(workspace.robot)
    faults = [read_injection(text) for text in ("laser-disconnected@3", "camera-occluded@6")]
    with open_bench(
        workspace, seed=4, stepped=True, pace=2, book=book, injections=faults, kind=BenchedWorld
    ) as world:  # fmt: skip
        game = games(workspace, world)
        game.begin()
        play(game, 8)
        assert [fault.code for fault in game.faults] == ["laser-disconnected", "camera-occluded"]
        assert [fault.critical for fault in game.faults] == [True, False]
        assert all(fault.succeeded for fault in game.faults)
        assert world.present == []
        game.leave()


@contextmanager
def shown_game(folder: Path, seed: int, columns: int = 80, lines: int = 24) -> Iterator[Terminal]:
    """Play on the bench in a terminal, with its steps in place of the staff view."""
    words = ("live", "--bench", "--begin", "--pace", "3", "--seed", str(seed))
    terminal = Terminal([TANGY, *words, "--data", str(folder)], columns=columns, lines=lines)
    try:
        if "Is all well now?" in terminal.until(
            lambda text: "greet everyone" in text or "well" in text
        ):
            terminal.type("y")
        terminal.until("Now")
        terminal.type("u")
        terminal.until("call number")
        yield terminal
    finally:
        terminal.end()


def test_staff_can_watch_and_control_a_game_on_a_terminal(folder: Path) -> None:
    with shown_game(folder, 5) as terminal:
        terminal.type("h")
        terminal.until("Who needs help?")
        terminal.type("\r")
        terminal.until("You asked for")
        terminal.until("go to the user")  # its step is done
        terminal.type("\x18")
        assert "STOPPED" in terminal.until("STOPPED")
        terminal.type("\x1b")  # back to the staff view
        terminal.until("Tangy was stopped.")
        terminal.type("\x1b")
        terminal.until("Leave in the middle")
        terminal.settle()  # a key from before the question does not answer it
        terminal.type("y")
        assert terminal.wait() == 0


def robot_process_of(program: int) -> int:
    """Return the id of the program's robot process."""
    listed = subprocess.run(
        ["ps", "-eo", "pid,ppid,args"],  # noqa: S607
        check=True,
        capture_output=True,
        text=True,
    )
    rows = (line.split(None, 2) for line in listed.stdout.splitlines()[1:])
    mine = ((int(pid), args) for pid, of, args in rows if int(of) == program)
    (found,) = (pid for pid, args in mine if "tangy_hw.robot_process" in args)
    return found


def test_a_robot_process_frozen_for_four_seconds_opens_one_dialog(folder: Path) -> None:
    with shown_game(folder, 6, columns=100, lines=40) as terminal:
        robot = robot_process_of(terminal.process.pid)
        os.kill(robot, signal.SIGSTOP)
        try:
            terminal.until("Link to the robot lost")
            ends = time.monotonic() + 4.0
            while time.monotonic() < ends:
                terminal.read(0.1)
        finally:
            os.kill(robot, signal.SIGCONT)
        # it answers again, and reports the freeze, until staff have dealt with it
        terminal.until("program stood still")
        assert "Also wrong" not in terminal.text
        terminal.settle()
        terminal.type("a")
        terminal.until("Press r when all is well")
        terminal.type("r")
        terminal.until(lambda text: re.search(r"\b5 \w.* -> ", text) is not None)  # it has gone on
        workspace = Workspace(folder, write=False)
        try:
            assert [fault.code for fault in read_faults(workspace.store)[-1:]] == ["link-lost"]
            last = read_faults(workspace.store)[-1].game
            assert len(read_faults(workspace.store, last)) == 1
        finally:
            workspace.close()


def test_a_robot_without_drivers_is_refused_with_advice(folder: Path) -> None:
    done = subprocess.run(  # noqa: S603
        [TANGY, "live", "--headless", "--data", str(folder)], capture_output=True, text=True
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert "names no drivers" in done.stderr and "--bench" in done.stderr
    assert "Traceback" not in done.stderr


def test_faults_can_be_read_from_a_file(folder: Path, tmp_path: Path) -> None:
    wrong = tmp_path / "faults.txt"
    wrong.write_text("# what is to come\nlaser-disconected@3\n")
    done = subprocess.run(  # noqa: S603
        [TANGY, "live", "--bench", "--json", "--inject", str(wrong), "--data", str(folder)],
        capture_output=True,
        text=True,
    )
    assert done.returncode == 2 and "laser-disconnected" in done.stderr
    assert json.dumps(done.stdout) == '""'


def test_a_new_person_joins_a_live_game_by_lines(folder: Path) -> None:
    lines = ["wait until called", "add Berta", "wait 2", *["wait until called"] * 3, "end"]
    done = subprocess.run(  # noqa: S603
        [TANGY, "live", "--bench", "--plain", "--seed", "4", "--by", "Nina", "--pace", "5",
         "--inject", "arm-failed@1", "--inject", "voice-dead@4", "--data", str(folder)],
        input="\n".join(lines), capture_output=True, text=True, timeout=240,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    joined, resumed = done.stdout.split("Berta has joined.")
    assert "Berta joins: seat 5." in joined and "is paused" not in joined
    assert "Call number" in resumed and "You ended the game." in resumed
    assert f"tangy report --data {folder}" in " ".join(resumed.split())
    with Store.open(folder, write=False) as store:
        did = [(e.body["did"], e.body["by"]) for e in store.events("staff action")]
        assert len({e.body["game"] for e in store.events("staff action")}) == 1
    assert ("came", "Nina") in did and ("ended", "Nina") in did
    page, again = re.findall(r"open (http:\S+) on the tablet; the code there is (\S+)", done.stderr)
    assert page == again  # a tablet that shows it connects again
    fault = "Fault, non-critical: "
    assert joined.count(f"{fault}An arm") == 1 and f"{fault}An arm" not in resumed
    assert f"{fault}No voice" not in joined and resumed.count(f"{fault}No voice") == 1  # later


def test_staff_control_a_live_game_by_lines_and_the_log_names_them(folder: Path) -> None:
    lines = [
        "pause", "where", "go on", "wait until called", "stop the robot", "drive left", "go on",
        "drive left 1", "wait until called", "call again", "call back", "take over",
        "wait until asked", "tell a joke", "y", "ask for user1", "wait 20", "end",
    ]  # fmt: skip
    done = subprocess.run(  # noqa: S603
        [TANGY, "live", "--bench", "--plain", "--pace", "2", "--seed", "4", "--teacher", "Ada",
         "--data", str(folder)],
        input="\n".join(lines), capture_output=True, text=True, timeout=180,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    for words in (
        "Paused: ", "Tangy goes on.", "STOP: Tangy stands still.", "Type first: go on.",
        "Tangy has driven.", " again.", "counts as not called", "joke, as Ada said",
        "You asked for", "You ended the game.",
    ):  # fmt: skip
        assert words in done.stdout, words
    with Store.open(folder, write=False) as store:
        did = [(e.body["did"], e.body["by"]) for e in store.events("staff action")]
    for what in (
        "stopped", "let go on", "drove", "called again", "took over", "ended",
    ):  # fmt: skip
        assert (what, "Ada") in did
    # the log shows one command from the program to the driver and back
    program = (folder / "program.log").read_text(encoding="utf-8")
    robot = (folder / "robot.log").read_text(encoding="utf-8")
    ids = re.findall(r"facilitation \[([0-9a-f]{8})\] joke for everybody begins", program)
    assert len(ids) == 1
    assert re.search(rf"ros_voice \[{ids[0]}\] says \d+ characters", robot)
    assert f"[{ids[0]}] has done perform" in robot
    assert f"[{ids[0]}] the robot has done perform" in program
