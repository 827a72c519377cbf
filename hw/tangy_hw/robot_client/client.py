"""The program's end of the robot process: it is started, asked, heard, and told that we live.

It may be used from any thread, and none ever waits to be heard. A reader's thread takes what the
process says, a writer's tells it what waits; another one says twenty times a second that the
program lives, so that a program that hangs has the robot stop. That thread lives on where only a
screen hangs: a screen says itself that it is `alive`.
"""

from __future__ import annotations

import json
import logging
import os
import subprocess
import sys
import threading
import time
from concurrent.futures import Future
from concurrent.futures import TimeoutError as TooLate
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import IO, Any

from tangy_hw.cancellation import Cancellation, Cancelled
from tangy_hw.device_protocols import DeviceError
from tangy_hw.robot_client.robot_state import RobotState
from tangy_hw.robot_process.protocol import level_of
from tangy_hw.robot_process.requests import Request
from tangy_hw.robot_process.stop_latch import STAFF, Preempted
from tangy_hw.robot_setup import RobotSetup
from tangy_hw.write_queue import WriteQueue
from tangy_profiles.health import STALE, Health
from tangy_profiles.process_log import NO_COMMAND, command_id, serving
from tangy_profiles.worker_log import open_log

_LOG = logging.getLogger(__name__)

CHILD = (sys.executable, "-P", "-m", "tangy_hw.robot_process")
BEAT_SECONDS = 0.05
SILENT_SECONDS = 0.6
"""Without a word from it for so long, the robot process hangs; its end is known at once."""
SILENT_STEPPED = 10.0  # on a bench in a hurry, where a busy machine may take its time
HANGS_SECONDS = 2.0
"""A screen that has not said for so long that it lives hangs: staff could not stop the robot."""
START_SECONDS = 30.0
ANSWER_SECONDS = 240.0  # the longest that anything takes; a drive ends by itself before
END_SECONDS = 3.0
CALLED_OFF_SECONDS = 1.0
"""In which a process that was still switching the robot on lets go of what it has opened."""

ENDED = "the robot process has ended"


@dataclass
class _Told:
    """What the reader's thread has heard."""

    state: RobotState = field(default_factory=RobotState)
    time: float = 0.0
    heard: float = 0.0
    ended: str = ""


class RobotLink:
    """A robot process. `start` it, `ask` it for things, `stop` the robot, and `close` it."""

    def __init__(
        self,
        setup: RobotSetup,
        *,
        log: Path | None = None,
        cancellation: Cancellation | None = None,
    ) -> None:
        """Prepare it.

        Args:
            setup: what robot it is.
            log: takes what the process writes beside its lines.
            cancellation: of the opening that it is part of.
        """
        self.setup = setup
        self.screen = ""
        """The address of the chest screen's page, where it is one."""
        self.code = ""
        """The code by which a tablet is paired there."""
        self._log = log
        self._cancellation = cancellation or Cancellation()
        self._starting = threading.Lock()
        self._over = False  # it is closed for good
        self._process: subprocess.Popen[bytes] | None = None
        self._told = _Told()
        self._outbox: WriteQueue | None = None
        self._asked: dict[int, Future[dict[str, Any]]] = {}
        self._number = 0
        self._lock = threading.Lock()
        self._said = threading.Condition()
        self._closing = threading.Event()
        self._alive: float | None = None  # when a screen last said that it lives
        self._threads: list[threading.Thread] = []

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
            ready = self._begin()
        self._cancellation.register(self._call_off)
        try:
            told = ready.result(START_SECONDS)
            self.screen, self.code = str(told.get("screen", "")), str(told.get("code", ""))
        except TooLate:
            self._end()
            raise DeviceError("The robot process does not begin.") from None

    def _begin(self) -> Future[dict[str, Any]]:
        """Start the process and the threads; return what is done when the robot is switched on."""
        self._closing.clear()
        self._told = _Told()
        log: IO[bytes] | int = subprocess.DEVNULL
        if self._log is not None:
            with suppress(OSError):
                log = open_log(self._log)
        try:
            process = self._process = subprocess.Popen(  # noqa: S603 - it is our own program
                [*CHILD, str(os.getpid())],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                start_new_session=True,
            )
        except OSError as error:
            raise DeviceError(f"The robot process cannot be started ({error}).") from None
        finally:
            if not isinstance(log, int):
                log.close()
        ready: Future[dict[str, Any]] = Future()
        self._asked[0] = ready
        assert process.stdin is not None  # noqa: S101 - it was asked for
        outbox = self._outbox = WriteQueue(process.stdin)
        outbox.put(self.setup.to_json())
        self._threads = [
            threading.Thread(target=outbox.run, daemon=True),
            threading.Thread(target=self._listen, args=(process,), daemon=True),
            threading.Thread(target=self._beat, args=(process, outbox), daemon=True),
        ]
        for thread in self._threads:
            thread.start()
        return ready

    def _call_off(self) -> None:
        """Have the process end that was to switch the robot on; nobody waits for it any more."""
        process = self._process
        if process is not None:
            process.terminate()
        with self._lock:
            ready = self._asked.pop(0, None)
        if ready is not None:
            ready.set_exception(Cancelled())

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
        process, self._process = self._process, None
        outbox, self._outbox = self._outbox, None
        self._closing.set()
        if process is None or outbox is None:
            return
        called_off = self._cancellation.cancelled
        if self.silent and not called_off:  # it would not end by itself, and may not even read
            process.kill()
        outbox.close()
        try:
            process.wait(CALLED_OFF_SECONDS if called_off else END_SECONDS)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        for thread in self._threads:
            if thread is not threading.current_thread():
                thread.join()

    # ------------------------------------------------------------------------- what it says

    @property
    def tablet(self) -> str:
        """How a tablet becomes the chest screen, in a sentence; "" where that is no page."""
        if not self.screen:
            return ""
        return f"Chest screen: open {self.screen} on the tablet; the code there is {self.code}."

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
        return None if self._process is None else self._process.pid

    @property
    def time(self) -> float:
        """The robot's time, in s, as it was told last: with an answer, or else with a beat."""
        return self._told.time

    @property
    def silent(self) -> str:
        """Why nothing is heard from the robot process, "" as long as it is."""
        told = self._told
        if told.ended:
            return told.ended
        patience = SILENT_STEPPED if self.setup.stepped else SILENT_SECONDS
        quiet = time.monotonic() - told.heard
        return "the robot process does not answer" if quiet > patience else ""

    def health(self) -> Health:
        """Return the newest reading of each device; all are stale where the process is silent."""
        health = self._told.state.health
        if not self.silent:
            return health
        quiet = time.monotonic() - self._told.heard
        return tuple(r._replace(age=r.age + quiet, state=STALE, rate=None) for r in health)

    # ------------------------------------------------------------------------- what it is told

    def ask(self, do: Request, **what: Any) -> Future[dict[str, Any]]:
        """Ask the robot for something; the answer comes, or DeviceError, or BrokenOff."""
        asked: Future[dict[str, Any]] = Future()
        with self._lock:  # an end of the process is answered either here or by whoever hears of it
            self._number += 1
            line = json.dumps({"id": self._number, **self._command(do), **what})
            heard = not self._told.ended and self._write(line)
            if heard:
                self._asked[self._number] = asked
                answered = partial(_note_answer, do, command_id())
                asked.add_done_callback(answered)
        if not heard:
            asked.set_exception(Preempted(self.silent or ENDED))
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
            and not (self._told.ended or self._cancellation.cancelled)
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
        self._write(json.dumps({**self._command(do), **what}))

    @staticmethod
    def _command(do: Request) -> dict[str, str]:
        """Begin a line: what is to be done, and the id of the command that it serves."""
        command = command_id()
        level = logging.WARNING if do == "stop" else level_of(do)
        _LOG.log(level, "asks the robot to %s", do)
        return {"do": do} if command == NO_COMMAND else {"do": do, "command": command}

    def stop(self, why: str, by: str = STAFF) -> None:
        """Stop the robot now; it waits behind nothing, and latches until `by` releases it."""
        self.tell("stop", why=why, by=by)

    def release(self, by: str = "") -> None:
        """Let the robot move again as far as somebody is concerned, or whoever stopped it."""
        self.tell("release", by=by)

    def alive(self) -> None:
        """Say that the screen lives, which from the first time on has to be said again and again.

        Where it is not, the robot process is not told either that the program lives.
        """
        self._alive = time.monotonic()

    # ------------------------------------------------------------------------- the threads

    def _write(self, line: str) -> bool:
        """Have a line written, without waiting for it; return whether it may be."""
        outbox = self._outbox
        return outbox is not None and outbox.put(line) is not None

    def _beat(self, process: subprocess.Popen[bytes], outbox: WriteQueue) -> None:
        number = 0
        while not self._closing.wait(BEAT_SECONDS) and process.poll() is None:
            alive = self._alive
            hears = not (self._told.heard and self.silent)  # or its pipe would only fill
            if hears and (alive is None or time.monotonic() - alive < HANGS_SECONDS):
                number += 1
                outbox.beat(f'{{"beat":{number}}}')

    def _listen(self, process: subprocess.Popen[bytes]) -> None:
        assert process.stdout is not None  # noqa: S101 - it was asked for
        for line in process.stdout:
            with suppress(ValueError, KeyError, TypeError, AttributeError, RecursionError):
                self._take(json.loads(line))
        process.stdout.close()
        with self._lock:
            self._told.ended = ENDED
            unanswered, self._asked = self._asked, {}
        for asked in unanswered.values():
            if not asked.done():
                asked.set_exception(Preempted(ENDED))

    def _take(self, said: dict[str, Any]) -> None:
        self._told.heard = time.monotonic()
        self._told.time = max(self._told.time, said.get("at", 0.0))
        if "beat" in said:
            self._told.state = RobotState.from_json(said["beat"])
            self._told.time = max(self._told.time, self._told.state.time)
            with self._said:
                self._said.notify_all()
            return
        with self._lock:
            asked = self._asked.pop(said.get("id", 0), None)
        if asked is None or asked.done():
            return
        if "failed" in said:
            kind = Preempted if said.get("broken") else DeviceError
            asked.set_exception(kind(said["failed"]))
        else:
            asked.set_result(said.get("done", {}))


def _note_answer(do: Request, command: str, asked: Future[dict[str, Any]]) -> None:
    """Log what came of something that the robot was asked for; this is another thread."""
    with serving(command):
        failed = None if asked.cancelled() else asked.exception()
        if failed is None:
            _LOG.log(level_of(do), "the robot has done %s", do)
        else:
            _LOG.warning("the robot has not done %s: %s", do, failed)
