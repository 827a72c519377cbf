"""Supervises a child process: starts it, sends it requests, watches its life, and ends it.

A child exchanges JSON lines over its pipes; `tangy_profiles.worker_lines` is its side. A message
with {"bytes": n} is followed by n bytes. Each child leads its own session, so that Ctrl+C in a
terminal does not reach it, and exits when its input closes, even if this process was killed. Any
method may be called from any thread, and only `stop` blocks: one thread writes to the child,
another reads.
"""

from __future__ import annotations

import asyncio
import json
import logging
import os
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, InvalidStateError
from concurrent.futures import TimeoutError as TooLate
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

from tangy_hw.write_queue import WriteQueue
from tangy_profiles.errors import TangyError
from tangy_profiles.worker_lines import LONGEST_LINE
from tangy_profiles.worker_log import open_log

_LOG = logging.getLogger(__name__)

MOST_BYTES = 1 << 28  # after a line: an image of 9,000 x 9,000 pixels
LINGERS_SECONDS = 2.0  # for a child to exit after closing its output
LAST_SECONDS = 1.0  # for the exit of a killed child
FIRST = 0
"""Id of the first unsolicited message of a child, and of later ones without an id."""

Said = dict[str, Any]


class WorkerError(TangyError):
    """A child cannot be started, or has ended; the text says how, in a few words."""


def _nothing(*_: object) -> None:
    """Ignore the event."""


def _itself(said: Said) -> Said:
    return said


class WorkerProcess:
    """A child process that runs until it ends or `stop` ends it."""

    def __init__(
        self,
        command: Sequence[str],
        *,
        hear: Callable[[Said, bytes], object] = _nothing,
        ended: Callable[[str], object] = _nothing,
        read: Callable[[Said], Any] = _itself,
        lost: Callable[[str], Exception] = WorkerError,
        log: Path | None = None,
        stderr: int | None = subprocess.DEVNULL,
        longest: int = LONGEST_LINE,
        forgiving: bool = False,
        loop: asyncio.AbstractEventLoop | None = None,
    ) -> None:
        """Start a child.

        Args:
            command: the command line.
            hear: called with each message and the bytes after it, on the reader's thread or in
                `loop`; returns True if the message is not an answer.
            ended: called with how it ended, as in `WorkerError`: "signal 9".
            read: converts an answer to the result of `ask`, or raises its error.
            lost: converts how it ended to the error of pending requests.
            log: file for its standard error; a log that cannot be written is ignored.
            stderr: destination of standard error without a log: DEVNULL, or None for ours.
            longest: maximum bytes of a line.
            forgiving: skip an invalid line, instead of ending the child.
            loop: event loop in which `hear` and `ended` are called.

        Raises:
            WorkerError: it cannot be started; the text is the system's.
        """
        self.heard = 0.0
        """Time of its last message (monotonic, s); 0 before the first."""
        self.how = ""
        """How it ended, "" while it runs."""
        self.over: Future[str] = Future()
        """Done, with how it ended, after all callbacks."""
        self.over.set_running_or_notify_cancel()  # a waiting caller cannot cancel the end
        self._hear, self._ended, self._read, self._lost = hear, ended, read, lost
        self._longest, self._forgiving, self._loop = longest, forgiving, loop
        self._lock = threading.Lock()
        self._number = FIRST
        self.asked: dict[int, Future[Any]] = {}
        self.first = self._expect(FIRST)
        """The first message of a child that reports when it is ready."""
        with ExitStack() as opened:
            if log is not None:
                with suppress(OSError):
                    stderr = opened.enter_context(open_log(log)).fileno()
            try:
                self.process = subprocess.Popen(  # noqa: S603 - it is our own program
                    list(command),
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=stderr,
                    start_new_session=True,
                )
            except OSError as error:
                raise WorkerError(error.strerror or str(error)) from None
        assert self.process.stdin is not None  # noqa: S101 - it is a pipe
        self.outbox = WriteQueue(self.process.stdin)
        self.threads = [
            threading.Thread(target=work, daemon=True) for work in (self.outbox.run, self._listen)
        ]
        for thread in self.threads:
            thread.start()

    @property
    def pid(self) -> int | None:
        """Id of its process and process group; None if it has ended."""
        return self.process.pid if self.process.poll() is None else None

    # ------------------------------------------------------------------------- requests

    def tell(self, what: Mapping[str, Any] | str) -> Future[None] | None:
        """Queue a line; the future is done when it is written, or never will be.

        Returns:
            None if the queue is closed.
        """
        return self.outbox.put(what if isinstance(what, str) else json.dumps(what))

    def beat(self, what: Mapping[str, Any]) -> None:
        """Send a line that is only useful now: it is dropped if others are queued."""
        self.outbox.beat(json.dumps(what))

    def expect(self) -> tuple[int, Future[Any]]:
        """Return an id for the next request, and a future for its answer.

        A cancelled future gets no answer.
        """
        with self._lock:
            self._number += 1
            number, over = self._number, self.how
            answer = Future() if over else self._expect(number)
        if over:
            answer.set_exception(self._lost(over))
        return number, answer

    def _expect(self, number: int) -> Future[Any]:
        answer = self.asked[number] = Future()
        answer.add_done_callback(lambda _: self.asked.pop(number, None))
        return answer

    def ask(self, what: Mapping[str, Any]) -> Future[Any]:
        """Send a request; return a future with the result of `read`, or the error of `lost`."""
        number, answer = self.expect()
        if self.tell({"id": number, **what}) is None:  # it has ended, or is ending
            _fail(answer, self._lost(self.how or "closed"))
        return answer

    # ------------------------------------------------------------------------- its end

    def close(self) -> None:
        """Close its input when all is written, at which it exits by itself."""
        self.outbox.close()

    def terminate(self) -> None:
        """Send it SIGTERM."""
        self.process.terminate()

    def kill(self) -> None:
        """Kill it and its process group."""
        if self.process.poll() is None:
            with suppress(ProcessLookupError):
                os.killpg(self.process.pid, signal.SIGKILL)

    def stop(self, patience: float) -> None:
        """Let it exit by itself, and kill it after `patience` s."""
        self.close()
        with suppress(TooLate):
            self.over.result(patience)
        if not self.over.done():
            self.kill()
            with suppress(TooLate):
                self.over.result(LAST_SECONDS)
        for thread in self.threads:
            if thread is not threading.current_thread():
                thread.join(LAST_SECONDS)

    async def stopped(self, patience: float) -> None:
        """Do as `stop` does, in an event loop, after `patience` s; kill at once if cancelled."""
        self.close()
        over = asyncio.wrap_future(self.over)
        try:
            await asyncio.wait({over}, timeout=patience)
        finally:
            if not self.over.done():
                self.kill()
        await asyncio.wait({over}, timeout=LAST_SECONDS)

    # ------------------------------------------------------------------------- messages

    def _listen(self) -> None:
        with suppress(OSError, ValueError):
            self._read_lines()
        self.kill()
        status = self.process.wait()
        with self._lock:
            self.how = f"signal {-status}" if status < 0 else f"status {status}"
        self._post(self._tell_end)

    def _read_lines(self) -> None:
        """Read its messages until it ends, closes its output, or sends an invalid line."""
        assert self.process.stdout is not None  # noqa: S101 - it is a pipe
        with self.process.stdout as out:
            while line := out.readline(self._longest):
                said = _object(line)
                if said is None and not self._forgiving:
                    return
                while line and not line.endswith(b"\n"):  # the rest of a line that is too long
                    line = out.readline(self._longest)
                if said is not None:
                    after = out.read(said.get("bytes", 0))
                    if len(after) < said.get("bytes", 0):
                        return
                    self.heard = time.monotonic()
                    self._post(self._take, said, after)
            with suppress(subprocess.TimeoutExpired):
                self.process.wait(LINGERS_SECONDS)

    def _post(self, do: Callable[..., None], *what: Any) -> None:
        if self._loop is None:
            do(*what)
        else:
            with suppress(RuntimeError):  # the loop is closed
                self._loop.call_soon_threadsafe(do, *what)

    def _take(self, said: Said, after: bytes) -> None:
        number = said.get("id", FIRST)
        answer = self.asked.get(number) if type(number) is int else None
        try:
            if self._hear(said, after) or answer is None:
                return
            done = self._read(said)
        except Exception as error:  # the waiting caller gets the error
            if answer is None:
                _LOG.warning("what a process said cannot be taken: %r", error)
            else:
                _fail(answer, error)
        else:
            with suppress(InvalidStateError):  # it was cancelled
                answer.set_result(done)

    def _tell_end(self) -> None:
        self.outbox.close()
        for answer in list(self.asked.values()):
            _fail(answer, self._lost(self.how))
        try:
            self._ended(self.how)
        finally:
            self.over.set_result(self.how)


def cpu_seconds(pid: int | None) -> float | None:
    """Return the CPU time in s of a process and its children; None if unknown."""
    try:
        children = Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="utf-8").split()
    except OSError:
        children = []
    own = _ticks(pid)
    if own is None:
        return None
    return (own + sum(_ticks(int(child)) or 0 for child in children)) / os.sysconf("SC_CLK_TCK")


def _ticks(pid: int | None) -> int | None:
    """Return the clock ticks of CPU time of a process; None if it does not exist."""
    try:
        told = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
        return int(told[11]) + int(told[12])
    except (OSError, ValueError, IndexError):
        return None


def _fail(answer: Future[Any], error: Exception) -> None:
    with suppress(InvalidStateError):  # cancelled, or answered just now
        answer.set_exception(error)


def _object(line: bytes) -> Said | None:
    """Parse a line as a JSON object; None if it is invalid, or its `bytes` are."""
    try:
        said = json.loads(line)
    except (ValueError, RecursionError):
        return None
    if not isinstance(said, dict) or not line.endswith(b"\n"):
        return None
    follow = said.get("bytes", 0)
    return said if type(follow) is int and 0 <= follow <= MOST_BYTES else None
