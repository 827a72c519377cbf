"""The one supervisor of a child process: it is started, told, asked, timed, and ended.

A child speaks JSON objects over its pipes, one a line; `tangy_profiles.worker_lines` is its side.
What says {"bytes": n} is followed by so many bytes. Each child leads a session of its own, so that
Ctrl+C in a terminal is not meant for it, and ends when its input closes, also where this process
was killed. Anything here may be called from any thread, and only `stop` waits: one thread writes
to the child, another reads.
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

MOST_BYTES = 1 << 28  # that follow a line: a picture of 9,000 x 9,000 pixels
LINGERS_SECONDS = 2.0  # in which a child ends that has closed its output
LAST_SECONDS = 1.0  # in which the end of a child that was killed is heard of
FIRST = 0
"""The id of the first word that a child says unasked, and of each later one without an id."""

Said = dict[str, Any]


class WorkerError(TangyError):
    """A child that cannot be started, or has ended; its text says how, in a few words."""


def _nothing(*_: object) -> None:
    """Take what nobody waits for."""


def _itself(said: Said) -> Said:
    return said


class WorkerProcess:
    """A child that runs from the beginning on, until it ends or `stop` ends it."""

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
            command: what to run.
            hear: takes each thing it says, with the bytes after it, on the reader's thread or in
                `loop`; returns True where that answers nothing.
            ended: is told how it ended, as `WorkerError` is: "signal 9".
            read: makes of an answer what `ask` gives, or raises what `ask` raises.
            lost: makes of how it ended what `ask` raises when there is no answer any more.
            log: takes what it writes to standard error; a log that cannot be written is no matter.
            stderr: takes that where there is no log: nobody, or with None whoever takes ours.
            longest: bytes of a line; what is longer cannot be read.
            forgiving: leave out a line that cannot be read, in place of ending the child.
            loop: where `hear` and `ended` are called.

        Raises:
            WorkerError: it cannot be started; its text is the system's.
        """
        self.heard = 0.0
        """When it spoke last (monotonic, s); 0 before its first word."""
        self.how = ""
        """How it ended, "" as long as it has not."""
        self.over: Future[str] = Future()
        """Is done, with how it ended, when that was told everybody."""
        self.over.set_running_or_notify_cancel()  # nobody who waits for the end can call it off
        self._hear, self._ended, self._read, self._lost = hear, ended, read, lost
        self._longest, self._forgiving, self._loop = longest, forgiving, loop
        self._lock = threading.Lock()
        self._number = FIRST
        self.asked: dict[int, Future[Any]] = {}
        self.first = self._expect(FIRST)
        """The answer of a child that says by itself when it is ready."""
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
        assert self.process.stdin is not None  # noqa: S101 - it was asked for
        self.outbox = WriteQueue(self.process.stdin)
        self.threads = [
            threading.Thread(target=work, daemon=True) for work in (self.outbox.run, self._listen)
        ]
        for thread in self.threads:
            thread.start()

    @property
    def pid(self) -> int | None:
        """The id of its process, which is that of its group; None where it has ended."""
        return self.process.pid if self.process.poll() is None else None

    # ------------------------------------------------------------------------- what it is told

    def tell(self, what: Mapping[str, Any] | str) -> Future[None] | None:
        """Have a line written; the future is done when it is, or never can be.

        Returns:
            None where it takes no more.
        """
        return self.outbox.put(what if isinstance(what, str) else json.dumps(what))

    def beat(self, what: Mapping[str, Any]) -> None:
        """Have a line written that is worth nothing later: it is left out where others wait."""
        self.outbox.beat(json.dumps(what))

    def expect(self) -> tuple[int, Future[Any]]:
        """Return an id for what is told next, and what is done when that is answered.

        Whoever cancels the future is not answered any more.
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
        """Ask for something; the answer comes, or what `read` or `lost` makes of it is raised."""
        number, answer = self.expect()
        if self.tell({"id": number, **what}) is None:  # it ends, and is not waited for
            _fail(answer, self._lost(self.how or "closed"))
        return answer

    # ------------------------------------------------------------------------- its end

    def close(self) -> None:
        """Close its input when all is written, at which it ends by itself."""
        self.outbox.close()

    def terminate(self) -> None:
        """Ask it to end by a signal."""
        self.process.terminate()

    def kill(self) -> None:
        """Kill it, and all in its group."""
        if self.process.poll() is None:
            with suppress(ProcessLookupError):
                os.killpg(self.process.pid, signal.SIGKILL)

    def stop(self, patience: float) -> None:
        """Let it end by itself, and kill it where it has not in so many s."""
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
        """Do as `stop` does after so many s, in a loop; called off, it kills at once."""
        self.close()
        over = asyncio.wrap_future(self.over)
        try:
            await asyncio.wait({over}, timeout=patience)
        finally:
            if not self.over.done():
                self.kill()
        await asyncio.wait({over}, timeout=LAST_SECONDS)

    # ------------------------------------------------------------------------- what it says

    def _listen(self) -> None:
        with suppress(OSError, ValueError):
            self._read_lines()
        self.kill()
        status = self.process.wait()
        with self._lock:
            self.how = f"signal {-status}" if status < 0 else f"status {status}"
        self._post(self._tell_end)

    def _read_lines(self) -> None:
        """Take what it says until it ends, closes its output, or says what cannot be read."""
        assert self.process.stdout is not None  # noqa: S101 - it was asked for
        with self.process.stdout as out:
            while line := out.readline(self._longest):
                said = _object(line)
                if said is None and not self._forgiving:
                    return
                while line and not line.endswith(b"\n"):  # the rest of one that is too long
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
            with suppress(RuntimeError):  # the loop is closed: nobody listens any more
                self._loop.call_soon_threadsafe(do, *what)

    def _take(self, said: Said, after: bytes) -> None:
        number = said.get("id", FIRST)
        answer = self.asked.get(number) if type(number) is int else None
        try:
            if self._hear(said, after) or answer is None:
                return
            done = self._read(said)
        except Exception as error:  # whoever waits for an answer is told
            if answer is None:
                _LOG.warning("what a process said cannot be taken: %r", error)
            else:
                _fail(answer, error)
        else:
            with suppress(InvalidStateError):  # nobody waits any more
                answer.set_result(done)

    def _tell_end(self) -> None:
        self.outbox.close()
        for answer in list(self.asked.values()):
            _fail(answer, self._lost(self.how))
        try:
            self._ended(self.how)
        finally:
            self.over.set_result(self.how)


def _fail(answer: Future[Any], error: Exception) -> None:
    with suppress(InvalidStateError):  # nobody waits any more, or it was answered just now
        answer.set_exception(error)


def _object(line: bytes) -> Said | None:
    """Read a line as a JSON object; None where it is none, or so many bytes cannot follow it."""
    try:
        said = json.loads(line)
    except (ValueError, RecursionError):
        return None
    if not isinstance(said, dict) or not line.endswith(b"\n"):
        return None
    follow = said.get("bytes", 0)
    return said if type(follow) is int and 0 <= follow <= MOST_BYTES else None
