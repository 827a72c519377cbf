"""A child's side of its pipes: JSON lines come in and go out, and a bad one ends nothing.

The supervisor's side is `tangy_hw.worker_process`.
"""

from __future__ import annotations

import asyncio
import json
import os
import sys
import threading
from collections.abc import AsyncIterator, Callable, Iterator
from typing import Any, BinaryIO

from tangy_profiles.errors import TangyError

LONGEST_LINE = 1 << 24  # bytes: the faces of 24 people fit
TOO_LONG = "That line is too long."

Asked = dict[str, Any]


class LineError(TangyError):
    """A line that cannot be heeded; one sentence."""


def read_line(line: bytes) -> Asked:
    """Read a line as a JSON object.

    Raises:
        LineError: it is none, or nested too deeply.
    """
    try:
        asked = json.loads(line)
    except (ValueError, RecursionError):
        asked = None
    if not isinstance(asked, dict):
        raise LineError("That line is no JSON object.")
    return asked


def requests(refuse: Callable[[str], object], pipe: BinaryIO | None = None) -> Iterator[Asked]:
    """Read requests until the pipe closes.

    Args:
        refuse: called with a sentence that says why a line is no request.
        pipe: the input; by default standard input.
    """
    pipe = sys.stdin.buffer if pipe is None else pipe
    while line := pipe.readline(LONGEST_LINE):
        try:
            if len(line) == LONGEST_LINE and not line.endswith(b"\n"):
                while line and not line.endswith(b"\n"):
                    line = pipe.readline(LONGEST_LINE)
                raise LineError(TOO_LONG)
            asked = read_line(line)
        except LineError as error:
            refuse(str(error))
        else:
            yield asked


async def open_lines() -> tuple[asyncio.StreamReader, asyncio.ReadTransport]:
    """Return what comes by standard input, and that pipe."""
    reader = asyncio.StreamReader(limit=LONGEST_LINE)
    pipe, _ = await asyncio.get_running_loop().connect_read_pipe(
        lambda: asyncio.StreamReaderProtocol(reader), sys.stdin
    )
    return reader, pipe


async def next_line(lines: asyncio.StreamReader) -> bytes:
    """Return the next line, b"" at the end.

    Raises:
        LineError: it was too long; it is over, and the line after it comes next.
    """
    long = False
    while True:
        try:
            line = await lines.readuntil(b"\n")
        except asyncio.IncompleteReadError as end:
            line = end.partial
        except asyncio.LimitOverrunError as error:
            long = True
            await lines.readexactly(error.consumed)
            continue
        if long:
            raise LineError(TOO_LONG)
        return line


async def coming(
    refuse: Callable[[str], object], lines: asyncio.StreamReader
) -> AsyncIterator[Asked]:
    """Do as `requests` does, for what `open_lines` opened."""
    while True:
        try:
            line = await next_line(lines)
            if not line:
                return
            asked = read_line(line)
        except LineError as error:
            refuse(str(error))
        else:
            yield asked


class AnswerWriter:
    """The output of a child, from any thread; it ends with its reader."""

    def __init__(self) -> None:
        """Take standard output: what libraries print there goes to standard error from now on."""
        self._pipe = os.fdopen(os.dup(1), "wb")
        self._writing = threading.Lock()
        os.dup2(2, 1)

    def fileno(self) -> int:
        """Return the pipe's number."""
        return self._pipe.fileno()

    def write(self, answer: Asked, after: bytes | memoryview = b"") -> None:
        """Say something, and the bytes that belong to it (see `worker_process`)."""
        line = json.dumps(answer).encode() + b"\n"
        with self._writing:
            try:
                self._pipe.write(line)
                self._pipe.write(after)
                self._pipe.flush()
            except (OSError, ValueError):
                os._exit(0)  # nobody reads any more

    def refuse(self, why: str) -> None:
        """Answer a line that is no request."""
        self.write({"failed": why})
