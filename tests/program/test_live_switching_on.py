"""Cancelling the opening of a robot from a screen and by a signal."""

from __future__ import annotations

import json
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import cast

import pytest

from tangy_hw.cancellation import Cancellation, Cancelled
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_tui.app import device_simulator
from tangy_tui.app.device_simulator import BenchError, DeviceSimulator
from tangy_tui.app.switching_on import SwitchingOn, switched_on

WORLD = cast(LiveWorld, object())


class Robot:
    """Opens a robot that answers when the test allows it, and records its states."""

    def __init__(self) -> None:
        self.did: list[str] = []
        self.begun, self.answers = threading.Event(), threading.Event()

    @contextmanager
    def __call__(self, stepped: bool, cancellation: Cancellation) -> Iterator[LiveWorld]:
        self.did.append("begins")
        cancellation.register(self.answers.set)
        self.begun.set()
        try:
            assert self.answers.wait(20)
            cancellation.check()
            self.did.append("is on")
            yield WORLD
        finally:
            self.did.append("is off")


def test_an_opened_robot_stays_open_until_it_is_closed() -> None:
    robot = Robot()
    robot.answers.set()
    one = SwitchingOn(robot)
    assert one.open() is WORLD
    one.cancel()
    assert robot.did == ["begins", "is on"]
    one.close()
    one.close()
    assert robot.did == ["begins", "is on", "is off"]


def test_a_cancelled_opening_closes_the_robot() -> None:
    robot = Robot()
    one = SwitchingOn(robot)

    def call_off() -> None:
        if robot.begun.wait(20):
            one.cancel()

    caller = threading.Thread(target=call_off)
    caller.start()
    with pytest.raises(Cancelled):
        one.open()
    caller.join()
    assert robot.did == ["begins", "is off"]


def test_a_cancelled_robot_can_be_switched_on_again() -> None:
    robot = Robot()
    one = SwitchingOn(robot)
    one.cancel()  # before it begins
    with pytest.raises(Cancelled):
        one.open()
    assert robot.did == []
    robot.answers.set()
    assert one.open() is WORLD
    assert robot.did == ["begins", "is on"]


@pytest.fixture
def hang_ups() -> Iterator[None]:
    """Handle hang-ups, even if the tests themselves run under nohup."""
    before = signal.signal(signal.SIGHUP, signal.SIG_DFL)
    yield
    signal.signal(signal.SIGHUP, before)


@contextmanager
def signalled(number: int, when: Callable[[], object]) -> Iterator[None]:
    """Send this program a signal, once."""
    this = threading.main_thread().ident
    assert this is not None

    def send() -> None:
        if when():
            signal.pthread_kill(this, number)

    sender = threading.Thread(target=send)
    sender.start()
    try:
        yield
    finally:
        sender.join()


@pytest.mark.usefixtures("hang_ups")
@pytest.mark.parametrize(
    ("number", "status"),
    [(signal.SIGHUP, 129), pytest.param(signal.SIGTERM, 143, marks=pytest.mark.slow)],
)
def test_a_signal_cancels_the_opening_without_a_screen(number: int, status: int) -> None:
    robot = Robot()
    before = signal.getsignal(number)
    with (
        pytest.raises(SystemExit) as ended,
        signalled(number, lambda: robot.begun.wait(20)),
        switched_on(robot, stepped=True),
    ):
        pytest.fail("it was switched on")
    assert ended.value.code == status
    assert robot.did == ["begins", "is off"]
    assert signal.getsignal(number) == before


def test_ctrl_c_cancels_the_opening_without_a_screen() -> None:
    robot = Robot()
    with (
        pytest.raises(KeyboardInterrupt),
        signalled(signal.SIGINT, lambda: robot.begun.wait(20)),
        switched_on(robot, stepped=True),
    ):
        pytest.fail("it was switched on")
    assert robot.did == ["begins", "is off"]


@pytest.mark.slow
def test_a_signal_outside_a_wait_cancels_the_opening() -> None:
    robot = Robot()

    def opening(stepped: bool, cancellation: Cancellation) -> AbstractContextManager[LiveWorld]:
        signal.pthread_kill(threading.get_ident(), signal.SIGTERM)  # this thread, not the main one
        return robot(stepped, cancellation)

    with pytest.raises(SystemExit) as ended, switched_on(opening, stepped=False):
        pass
    assert ended.value.code == 128 + signal.SIGTERM
    assert robot.did == ["begins", "is off"]


@pytest.mark.usefixtures("hang_ups")
def test_a_signal_in_a_game_closes_the_robot() -> None:
    robot = Robot()
    robot.answers.set()
    playing = threading.Event()
    with (
        pytest.raises(SystemExit),
        signalled(signal.SIGHUP, lambda: playing.wait(20)),
        switched_on(robot, stepped=True) as world,
    ):
        assert world is WORLD
        playing.set()
        for _ in range(400):  # one long wait may miss a signal that another thread takes
            threading.Event().wait(0.05)
        pytest.fail("nothing came of it")
    assert robot.did == ["begins", "is on", "is off"]


def test_an_ignored_hangup_does_not_cancel() -> None:
    """`nohup tangy live --bench --headless` starts this way."""
    robot = Robot()
    robot.answers.set()
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with switched_on(robot, stepped=True):
            assert signal.getsignal(signal.SIGHUP) == signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)


def test_a_cancelled_bench_ends_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        device_simulator, "CHILD", (sys.executable, "-c", "import time; time.sleep(60)")
    )
    cancellation = Cancellation()
    caller = threading.Timer(0.2, cancellation.cancel)
    caller.start()
    began = time.monotonic()
    with pytest.raises(Cancelled):
        DeviceSimulator(
            seed=1,
            people={},
            stepped=True,
            activity="bingo",
            robot="/dev/null",
            cancellation=cancellation,
        )
    assert time.monotonic() - began < device_simulator.END_SECONDS  # nothing waits for it
    caller.join()


@pytest.mark.parametrize(
    ("does", "how"), [("sys.exit(3)", "status 3"), ("print('x', flush=True); input()", "signal 9")]
)
def test_a_bench_that_cannot_start_reports_its_status(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, does: str, how: str
) -> None:
    monkeypatch.setattr(device_simulator, "CHILD", (sys.executable, "-c", "import sys; " + does))
    log = tmp_path / "bench.log"
    with pytest.raises(BenchError, match=rf"does not begin \({how}\): see .*bench.log"):
        DeviceSimulator(seed=1, people={}, stepped=True, activity="bingo", robot="", log=log)


def test_a_bench_that_does_not_answer_or_ends_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    ready = dict.fromkeys(("rosbridge", "scip", "head", "infrared"), "")
    says = json.dumps({"ready": {**ready, "corners": [], "faces": {}}})
    does = f"import os, sys; print({says!r}, flush=True); input(); input(); os._exit(4)"
    monkeypatch.setattr(device_simulator, "CHILD", (sys.executable, "-c", does))
    bench = DeviceSimulator(seed=1, people={}, stepped=True, activity="bingo", robot="")
    try:
        monkeypatch.setattr(device_simulator, "ANSWER_SECONDS", 0.05)
        with pytest.raises(BenchError, match="does not answer"):
            bench.do("truth")
        monkeypatch.setattr(device_simulator, "ANSWER_SECONDS", 20)
        for _ in range(2):
            with pytest.raises(BenchError, match=r"has ended \(status 4\)"):
                bench.do("truth")
    finally:
        bench.close()


def test_no_bench_starts_after_a_cancellation(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[object] = []
    monkeypatch.setattr("subprocess.Popen", lambda *a, **b: started.append(a))
    cancellation = Cancellation()
    cancellation.cancel()
    with pytest.raises(Cancelled):
        DeviceSimulator(
            seed=1, people={}, stepped=True, activity="bingo", robot="", cancellation=cancellation
        )
    assert started == []
