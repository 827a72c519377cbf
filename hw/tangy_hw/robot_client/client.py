"""The program's end of the robot process: starts it, sends requests and heartbeats, and listens.

It may be used from any thread, and never blocks on writing: one thread reads, one writes, and one
sends a heartbeat twenty times a second, so that the robot stops if the program hangs. That thread
goes on if only a screen hangs, so a screen must call `alive`.
"""

from __future__ import annotations

import logging
import os
import sys
import threading
import time
from collections.abc import Callable, Mapping
from concurrent.futures import CancelledError, Future
from concurrent.futures import TimeoutError as TooLate
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from tangy_hw.cancellation import Cancellation, Cancelled
from tangy_hw.device_protocols import DeviceError, DeviceFailed
from tangy_hw.robot_client.robot_state import RobotState
from tangy_hw.robot_client.starting import StartUp
from tangy_hw.robot_process.protocol import level_of
from tangy_hw.robot_process.requests import Request
from tangy_hw.robot_process.stop_latch import STAFF, Preempted
from tangy_hw.robot_setup import RobotSetup
from tangy_hw.worker_process import Said, WorkerError, WorkerProcess
from tangy_profiles.health import STALE, Health
from tangy_profiles.process_log import NO_COMMAND, command_id, serving

_LOG = logging.getLogger(__name__)

CHILD = (sys.executable, "-P", "-m", "tangy_hw.robot_process")
BEAT_SECONDS = 0.05
SILENT_SECONDS = 0.6
"""Silence after which the robot process counts as hanging; its exit is known at once."""
LATE_SECONDS = 0.25
"""s of silence after which its last readings age; it normally sends ten messages a second."""
SILENT_STEPPED = 10.0  # on a stepped bench, where a busy machine may be slow
HANGS_SECONDS = 2.0
"""Silence after which a screen counts as hanging: staff could not stop the robot."""
BEGIN_SECONDS = 30.0  # until the first heartbeat of a robot that is on
ANSWER_SECONDS = 240.0  # longer than any request; a drive ends by itself before
END_SECONDS = 3.0
CALLED_OFF_SECONDS = 1.0
"""For a process that was still switching the robot on to release its devices."""


@dataclass
class _Told:
    """Data that the reader thread has received."""

    state: RobotState = field(default_factory=RobotState)
    time: float = 0.0


class RobotLink:
    """A robot process. `start` it, `ask` it for things, `stop` the robot, and `close` it."""

    def __init__(
        self,
        setup: RobotSetup,
        *,
        log: Path | None = None,
        cancellation: Cancellation | None = None,
        patience: float | None = None,
    ) -> None:
        """Prepare the link.

        Args:
            setup: the first message to the process.
            log: file for the standard error of the process.
            cancellation: start-up that this link is part of.
            patience: s of silence after which the process counts as hanging.
        """
        self.setup = setup
        self.screen = ""
        """Address of the chest screen's page, if it has one."""
        self.code = ""
        """Code that pairs a tablet with it."""
        self._log = log
        self._patience = patience
        self._cancellation = cancellation or Cancellation()
        self._starting = threading.Lock()
        self._over = False  # closed for good
        self.worker: WorkerProcess | None = None
        self.on_answer: Callable[[str], object] = _nothing
        """Called, on its own thread, with the key of each call answered at the robot."""
        self._calls: dict[str, str] = {}
        self._stops: dict[str, str] = {}  # by source: those that hold, also for another process
        self._told, self._start_up = _Told(), StartUp()
        self._said = threading.Condition()
        self._closing = threading.Event()
        self._alive: float | None = None  # time of the last sign of life from a screen
        self.beating = threading.Thread()

    # ------------------------------------------------------------------------- its process

    def start(self) -> None:
        """Start the process, and wait until the robot is switched on.

        Raises:
            DeviceError: it cannot be started, or reports a problem with its setup.
        """
        with self._starting:
            self._cancellation.check()
            if self._over:
                raise DeviceError("The robot is switched off.")
            self._cancellation.starts("program")  # before the process tells of its own parts
            worker = self._begin()
        self._cancellation.register(partial(_call_off, worker))
        try:
            told = self._start_up.wait(worker.first)
            self.screen, self.code = str(told.get("screen", "")), str(told.get("code", ""))
        except TooLate:
            self._end()
            raise self._start_up.blocked() from None
        except CancelledError:
            raise Cancelled from None

    def _begin(self) -> WorkerProcess:
        """Start the process, and send it the setup."""
        self._closing.clear()
        self._told, self._start_up = _Told(), StartUp()
        try:
            worker = self.worker = WorkerProcess(
                [*CHILD, str(os.getpid())],
                hear=self._hear,
                read=_answer,
                lost=lambda how: Preempted(_ended(how)),
                log=self._log,
                forgiving=True,
            )
        except WorkerError as error:
            raise DeviceError(f"The robot process cannot be started ({error}).") from None
        worker.tell(self.setup.to_json())
        for by, why in tuple(self._stops.items()):
            worker.tell({**self._command("stop"), "why": why, "by": by})
        if self._calls:
            worker.tell({**self._command("show calls"), "calls": self._calls})
        self.beating = threading.Thread(target=self._beat, args=(worker,), daemon=True)
        self.beating.start()
        return worker

    def restart(self) -> None:
        """End the process, whatever its state, and start another, which is as stopped as it was.

        Raises:
            DeviceError: it cannot be started, or this link was closed meanwhile.
        """
        self._end()
        self.start()

    def close(self) -> None:
        """Let the process stop the robot and exit, for good; kill it if it does not."""
        with self._starting:  # otherwise a process that is just starting would be left behind
            self._over = True
        self._end()

    def _end(self) -> None:
        self._closing.set()
        worker = self.worker
        if worker is None:
            return
        called_off = self._cancellation.cancelled
        if self.silent and not called_off:  # it would not exit by itself, and may not even read
            worker.kill()
        worker.stop(CALLED_OFF_SECONDS if called_off else END_SECONDS)
        if self.beating is not threading.current_thread():
            self.beating.join()

    # ------------------------------------------------------------------------- its state

    @property
    def tablet_page(self) -> str:
        """Address of the chest screen and its code in one phrase; "" if it has no page."""
        return f"chest screen {self.screen} code {self.code}" if self.screen else ""

    @property
    def state(self) -> RobotState:
        """Latest state of the robot."""
        return self._told.state

    @property
    def pid(self) -> int | None:
        """Id of the process, None if there is none."""
        return None if self.worker is None else self.worker.pid

    @property
    def time(self) -> float:
        """Latest known time of the robot in s, from an answer or a heartbeat."""
        return self._told.time

    @property
    def silent(self) -> str:
        """Why the robot process is silent, "" if it is not."""
        if self._how:
            return _ended(self._how)
        patience = self._patience or SILENT_SECONDS
        patience = SILENT_STEPPED if self.setup.stepped else patience
        return "the robot process does not answer" if self._quiet > patience else ""

    @property
    def _quiet(self) -> float:
        """Duration of its silence in s."""
        return time.monotonic() - self._heard

    @property
    def _how(self) -> str:
        """How the process ended, "" if it has not."""
        return "" if self.worker is None else self.worker.how

    @property
    def _heard(self) -> float:
        """Time of its last message (monotonic, s); 0 before the first."""
        return 0.0 if self.worker is None else self.worker.heard

    def health(self) -> Health:
        """Return the newest reading of each device; all are stale if the process is silent.

        Readings age while its next message is late.
        """
        health = self._told.state.health
        if self.silent:
            return tuple(
                r._replace(age=r.age + self._quiet, state=STALE, rate=None) for r in health
            )
        quiet = self._quiet
        if self.setup.stepped or quiet <= LATE_SECONDS:
            return health
        return tuple(r._replace(age=r.age + quiet) for r in health)

    # ------------------------------------------------------------------------- requests

    def ask(self, do: Request, **what: Any) -> Future[dict[str, Any]]:
        """Send a request; the future has the answer, or raises DeviceError or Preempted."""
        worker = self.worker
        if worker is None:
            gone: Future[dict[str, Any]] = Future()
            gone.set_exception(Preempted(self.silent))
            return gone
        asked = worker.ask({**self._command(do), **what})
        asked.add_done_callback(partial(_note_answer, do, command_id()))
        return asked

    def wait(self, asked: Future[dict[str, Any]], seconds: float = 0.05) -> bool:
        """Wait for an answer, with a timeout in s; return whether it is there."""
        with suppress(TooLate):
            asked.exception(seconds)
        return asked.done()

    def beat(self) -> RobotState:
        """Wait for the robot's next heartbeat, and return its state."""
        last, until = self.state.number, time.monotonic() + BEGIN_SECONDS
        while (
            self.state.number == last
            and not (self._how or self._cancellation.cancelled)
            and time.monotonic() < until
        ):
            with self._said:
                self._said.wait(BEAT_SECONDS)
        return self.state

    def do(self, do: Request, **what: Any) -> dict[str, Any]:
        """Send a request, and wait for the answer.

        Raises:
            Preempted: it was aborted, because the robot had to stop.
            DeviceError: it failed.
        """
        try:
            return self.ask(do, **what).result(ANSWER_SECONDS)
        except TooLate:
            raise DeviceError(f"The robot process does not answer ({do}).") from None

    def tell(self, do: Request, **what: Any) -> None:
        """Send a request without waiting for an answer."""
        line = {**self._command(do), **what}
        if self.worker is not None:
            self.worker.tell(line)

    @staticmethod
    def _command(do: Request) -> dict[str, str]:
        """Return the beginning of a line: the request, and the id of its command."""
        command = command_id()
        level = logging.WARNING if do == "stop" else level_of(do)
        _LOG.log(level, "asks the robot to %s", do)
        return {"do": do} if command == NO_COMMAND else {"do": do, "command": command}

    def offer_calls(self, calls: Mapping[str, str]) -> None:
        """Show a button at the robot for each open call: the called person's name by key."""
        self._calls = dict(calls)
        self.tell("show calls", calls=self._calls)

    def stop(self, why: str, by: str = STAFF) -> None:
        """Stop the robot now, ahead of everything; it latches until `by` releases it."""
        self._stops.setdefault(by, why)
        self.tell("stop", why=why, by=by)

    def release(self, by: str = "") -> None:
        """Release the stop of one source, or of all."""
        for one in (by,) if by else tuple(self._stops):
            self._stops.pop(one, None)
        self.tell("release", by=by)

    def alive(self) -> None:
        """Report that the screen is alive; after the first call it must be repeated.

        Without it, the heartbeat to the robot process stops too.
        """
        self._alive = time.monotonic()

    # ------------------------------------------------------------------------- the threads

    def _beat(self, worker: WorkerProcess) -> None:
        number = 0
        while not self._closing.wait(BEAT_SECONDS) and worker.pid is not None:
            alive = self._alive
            hears = not (worker.heard and self.silent)  # otherwise its pipe would only fill
            if hears and (alive is None or time.monotonic() - alive < HANGS_SECONDS):
                number += 1
                worker.beat({"beat": number})

    def _hear(self, said: Said, _: bytes) -> bool:
        """Handle a message; return whether it was not an answer."""
        self._told.time = max(self._told.time, said.get("at", 0.0))
        if (part := self._start_up.hear(said)) is not None:
            if part:
                self._cancellation.starts(part)
            return True
        if "beat" not in said:
            return False
        before, self._told.state = self._told.state, RobotState.from_json(said["beat"])
        self._told.time = max(self._told.time, self._told.state.time)
        with self._said:
            self._said.notify_all()
        for key in self._told.state.answered:
            if key not in before.answered:
                threading.Thread(target=self.on_answer, args=(key,), daemon=True).start()
        return True


def _nothing(_: str) -> None:
    """Ignore the event."""


def _ended(how: str) -> str:
    return f"the robot process has ended ({how})"


def _call_off(worker: WorkerProcess) -> None:
    """End a process that is still switching the robot on, and its waiting caller."""
    worker.terminate()
    worker.first.cancel()


def _answer(said: Said) -> dict[str, Any]:
    """Return the result of a request.

    Raises:
        Preempted: it was aborted.
        DeviceError: it failed.
    """
    if "device" in said and "failed" in said:
        raise DeviceFailed(str(said["device"]), said["failed"])
    if "failed" in said:
        kind = Preempted if said.get("broken") else DeviceError
        raise kind(said["failed"])
    done: dict[str, Any] = said.get("done", {})
    return done


def _note_answer(do: Request, command: str, asked: Future[dict[str, Any]]) -> None:
    """Log the outcome of a request; called on another thread."""
    with serving(command):
        failed = None if asked.cancelled() else asked.exception()
        if failed is None:
            _LOG.log(level_of(do), "the robot has done %s", do)
        else:
            _LOG.warning("the robot has not done %s: %s", do, failed)
