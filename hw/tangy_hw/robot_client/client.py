"""The program's end of the robot process: it is started, asked, heard, and told that we live.

It may be used from any thread, and none ever waits to be heard. A reader's thread takes what the
process says, a writer's tells it what waits; another one says twenty times a second that the
program lives, so that a program that hangs has the robot stop. That thread lives on where only a
screen hangs: a screen says itself that it is `alive`.
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
from tangy_hw.device_protocols import DeviceError
from tangy_hw.robot_client.robot_state import RobotState
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
"""Without a word from it for so long, the robot process hangs; its end is known at once."""
LATE_SECONDS = 0.25
"""s without a word from it after which what it said last has grown old; it speaks ten times a s."""
SILENT_STEPPED = 10.0  # on a bench in a hurry, where a busy machine may take its time
HANGS_SECONDS = 2.0
"""A screen that has not said for so long that it lives hangs: staff could not stop the robot."""
START_SECONDS = 30.0
ANSWER_SECONDS = 240.0  # the longest that anything takes; a drive ends by itself before
END_SECONDS = 3.0
CALLED_OFF_SECONDS = 1.0
"""In which a process that was still switching the robot on lets go of what it has opened."""


@dataclass
class _Told:
    """What the reader's thread has heard."""

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
        """Prepare it.

        Args:
            setup: what robot it is.
            log: takes what the process writes beside its lines.
            cancellation: of the opening that it is part of.
            patience: for how many s nothing may be heard from the process.
        """
        self.setup = setup
        self.screen = ""
        """The address of the chest screen's page, where it is one."""
        self.code = ""
        """The code by which a tablet is paired there."""
        self._log = log
        self._patience = patience
        self._cancellation = cancellation or Cancellation()
        self._starting = threading.Lock()
        self._over = False  # it is closed for good
        self.worker: WorkerProcess | None = None
        self.on_answer: Callable[[str], object] = _nothing
        """Is called, on a thread of its own, with the key of each call answered at the robot."""
        self._calls: dict[str, str] = {}
        self._told = _Told()
        self._said = threading.Condition()
        self._closing = threading.Event()
        self._alive: float | None = None  # when a screen last said that it lives
        self.beating = threading.Thread()

    # ------------------------------------------------------------------------- its process

    def start(self) -> None:
        """Start the process, and wait until the robot is switched on.

        Raises:
            DeviceError: it cannot be started, or says what is wrong with its setup.
        """
        with self._starting:
            self._cancellation.check()
            if self._over:
                raise DeviceError("The robot is switched off.")
            worker = self._begin()
        self._cancellation.register(partial(_call_off, worker))
        self._cancellation.starts("program")
        try:
            told = worker.first.result(START_SECONDS)
            self.screen, self.code = str(told.get("screen", "")), str(told.get("code", ""))
        except TooLate:
            self._end()
            raise DeviceError("The robot process does not begin.") from None
        except CancelledError:
            raise Cancelled from None

    def _begin(self) -> WorkerProcess:
        """Start the process, and tell it what robot it is."""
        self._closing.clear()
        self._told = _Told()
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
        if self._calls:
            worker.tell({**self._command("show calls"), "calls": self._calls})
        self.beating = threading.Thread(target=self._beat, args=(worker,), daemon=True)
        self.beating.start()
        return worker

    def restart(self) -> None:
        """End the process, however it is, and start another.

        Raises:
            DeviceError: it cannot be started, or this was closed meanwhile.
        """
        self._end()
        self.start()

    def close(self) -> None:
        """Let the process stop the robot and end, for good; it is ended where it does not."""
        with self._starting:  # or one that is just being started would be left behind
            self._over = True
        self._end()

    def _end(self) -> None:
        self._closing.set()
        worker = self.worker
        if worker is None:
            return
        called_off = self._cancellation.cancelled
        if self.silent and not called_off:  # it would not end by itself, and may not even read
            worker.kill()
        worker.stop(CALLED_OFF_SECONDS if called_off else END_SECONDS)
        if self.beating is not threading.current_thread():
            self.beating.join()

    # ------------------------------------------------------------------------- what it says

    @property
    def tablet_page(self) -> str:
        """The address of the chest screen and its code, as short as can be; "" as for `tablet`."""
        return f"chest screen {self.screen} code {self.code}" if self.screen else ""

    @property
    def state(self) -> RobotState:
        """What the robot said of itself last."""
        return self._told.state

    @property
    def pid(self) -> int | None:
        """The id of the process, None where there is none."""
        return None if self.worker is None else self.worker.pid

    @property
    def time(self) -> float:
        """The robot's time, in s, as it was told last: with an answer, or else with a beat."""
        return self._told.time

    @property
    def silent(self) -> str:
        """Why nothing is heard from the robot process, "" as long as it is."""
        if self._how:
            return _ended(self._how)
        patience = self._patience or SILENT_SECONDS
        patience = SILENT_STEPPED if self.setup.stepped else patience
        return "the robot process does not answer" if self._quiet > patience else ""

    @property
    def _quiet(self) -> float:
        """For how many s nothing was heard."""
        return time.monotonic() - self._heard

    @property
    def _how(self) -> str:
        """How the process ended, "" where it has not."""
        return "" if self.worker is None else self.worker.how

    @property
    def _heard(self) -> float:
        """When it said something last (monotonic, s); 0 where it never has."""
        return 0.0 if self.worker is None else self.worker.heard

    def health(self) -> Health:
        """Return the newest reading of each device; all are stale where the process is silent.

        They grow older while its next word is late.
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

    # ------------------------------------------------------------------------- what it is told

    def ask(self, do: Request, **what: Any) -> Future[dict[str, Any]]:
        """Ask the robot for something; the answer comes, or DeviceError, or BrokenOff."""
        worker = self.worker
        if worker is None:
            gone: Future[dict[str, Any]] = Future()
            gone.set_exception(Preempted(self.silent))
            return gone
        asked = worker.ask({**self._command(do), **what})
        asked.add_done_callback(partial(_note_answer, do, command_id()))
        return asked

    def wait(self, asked: Future[dict[str, Any]], seconds: float = 0.05) -> bool:
        """Wait so many s for an answer; return whether it is there."""
        with suppress(TooLate):
            asked.exception(seconds)
        return asked.done()

    def beat(self) -> RobotState:
        """Wait until the robot has said once more how it is, and return that."""
        last, until = self.state.number, time.monotonic() + START_SECONDS
        while (
            self.state.number == last
            and not (self._how or self._cancellation.cancelled)
            and time.monotonic() < until
        ):
            with self._said:
                self._said.wait(BEAT_SECONDS)
        return self.state

    def do(self, do: Request, **what: Any) -> dict[str, Any]:
        """Ask the robot for something, and wait for it.

        Raises:
            BrokenOff: it was broken off, because the robot had to stand still.
            DeviceError: it could not be done.
        """
        try:
            return self.ask(do, **what).result(ANSWER_SECONDS)
        except TooLate:
            raise DeviceError(f"The robot process does not answer ({do}).") from None

    def tell(self, do: Request, **what: Any) -> None:
        """Tell the robot something, and wait for no answer."""
        line = {**self._command(do), **what}
        if self.worker is not None:
            self.worker.tell(line)

    @staticmethod
    def _command(do: Request) -> dict[str, str]:
        """Begin a line: the request, and the id of the command that it serves."""
        command = command_id()
        level = logging.WARNING if do == "stop" else level_of(do)
        _LOG.log(level, "asks the robot to %s", do)
        return {"do": do} if command == NO_COMMAND else {"do": do, "command": command}

    def offer_calls(self, calls: Mapping[str, str]) -> None:
        """Show a button at the robot for each open call: who is called, by its key."""
        self._calls = dict(calls)
        self.tell("show calls", calls=self._calls)

    def stop(self, why: str, by: str = STAFF) -> None:
        """Stop the robot now; it waits behind nothing, and latches until `by` releases it."""
        self.tell("stop", why=why, by=by)

    def release(self, by: str = "") -> None:
        """Release the stop of one source, or of the source that stopped the robot."""
        self.tell("release", by=by)

    def alive(self) -> None:
        """Say that the screen lives, which from the first time on has to be said again and again.

        Where it is not, the robot process is not told either that the program lives.
        """
        self._alive = time.monotonic()

    # ------------------------------------------------------------------------- the threads

    def _beat(self, worker: WorkerProcess) -> None:
        number = 0
        while not self._closing.wait(BEAT_SECONDS) and worker.pid is not None:
            alive = self._alive
            hears = not (worker.heard and self.silent)  # or its pipe would only fill
            if hears and (alive is None or time.monotonic() - alive < HANGS_SECONDS):
                number += 1
                worker.beat({"beat": number})

    def _hear(self, said: Said, _: bytes) -> bool:
        """Take what it says of itself; return whether that was no answer."""
        self._told.time = max(self._told.time, said.get("at", 0.0))
        if "starts" in said:
            self._cancellation.starts(str(said["starts"]))
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
    """Take an answer for which nobody waits."""


def _ended(how: str) -> str:
    return f"the robot process has ended ({how})"


def _call_off(worker: WorkerProcess) -> None:
    """Have the process end that was to switch the robot on; nobody waits for it any more."""
    worker.terminate()
    worker.first.cancel()


def _answer(said: Said) -> dict[str, Any]:
    """Return the result of a command.

    Raises:
        BrokenOff: it was broken off.
        DeviceError: it could not be done.
    """
    if "failed" in said:
        kind = Preempted if said.get("broken") else DeviceError
        raise kind(said["failed"])
    done: dict[str, Any] = said.get("done", {})
    return done


def _note_answer(do: Request, command: str, asked: Future[dict[str, Any]]) -> None:
    """Log what came of something that the robot was asked for; this is another thread."""
    with serving(command):
        failed = None if asked.cancelled() else asked.exception()
        if failed is None:
            _LOG.log(level_of(do), "the robot has done %s", do)
        else:
            _LOG.warning("the robot has not done %s: %s", do, failed)
