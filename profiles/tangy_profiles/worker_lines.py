"""A child process's side of its pipes: JSON lines in both directions; invalid lines are skipped.

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
    """An invalid line; one sentence."""


def read_line(line: bytes) -> Asked:
    """Parse a line as a JSON object.

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
        refuse: called with a sentence for each invalid line.
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
    """Return a reader of standard input, and its transport."""
    reader = asyncio.StreamReader(limit=LONGEST_LINE)
    pipe, _ = await asyncio.get_running_loop().connect_read_pipe(
        lambda: asyncio.StreamReaderProtocol(reader), sys.stdin
    )
    return reader, pipe


async def next_line(lines: asyncio.StreamReader) -> bytes:
    """Return the next line; b"" at the end.

    Raises:
        LineError: it was too long; it is skipped.
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
    """Yield requests as `requests` does, from the reader of `open_lines`."""
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
    """The output of a child process, for any thread; the process ends when its reader is gone."""

    def __init__(self) -> None:
        """Take over standard output; other output to it goes to standard error from now on."""
        self._pipe = os.fdopen(os.dup(1), "wb")
        self._writing = threading.Lock()
        os.dup2(2, 1)

    def fileno(self) -> int:
        """Return the file descriptor of the pipe."""
        return self._pipe.fileno()

    def write(self, answer: Asked, after: bytes | memoryview = b"") -> None:
        """Write a message, and the bytes that belong to it (see `worker_process`)."""
        line = json.dumps(answer).encode() + b"\n"
        with self._writing:
            try:
                self._pipe.write(line)
                self._pipe.write(after)
                self._pipe.flush()
            except (OSError, ValueError):
                os._exit(0)  # the reader is gone

    def refuse(self, why: str) -> None:
        """Answer an invalid line."""
        self.write({"failed": why})
