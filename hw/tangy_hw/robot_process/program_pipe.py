"""The robot process's end of its pipe to the program, and its exit when the program has ended."""

from __future__ import annotations

import asyncio
import json
import os
from typing import Any

MOST_UNREAD = 1 << 16  # bytes; a program that hangs reads none
LOOK_SECONDS = 0.5  # between two checks for the program
END_SECONDS = 4.0  # after the program's end: limit for devices that do not answer


async def end_with(program: int, lines: asyncio.StreamReader) -> None:
    """Exit some seconds after the program has ended, even with tasks in progress."""
    while os.getppid() == program and not lines.at_eof():  # noqa: ASYNC110 - no notification
        await asyncio.sleep(LOOK_SECONDS)
    await asyncio.sleep(END_SECONDS)
    os._exit(1)


class AnswerPipe(asyncio.Protocol):
    """Lines to the program; if it reads none, heartbeats are dropped, and nothing blocks."""

    transport: asyncio.WriteTransport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Store the transport for writing."""
        assert isinstance(transport, asyncio.WriteTransport)  # noqa: S101 - it is a pipe
        self.transport = transport

    def write(self, answer: dict[str, Any]) -> None:
        """Write a line."""
        transport = self.transport
        if transport is None or transport.is_closing():
            return
        if "beat" in answer and transport.get_write_buffer_size() > MOST_UNREAD:
            return
        transport.write(json.dumps(answer, separators=(",", ":")).encode() + b"\n")
