"""A tablet that shows the page of a chest screen, as far as the robot can tell: no browser runs."""

from __future__ import annotations

import asyncio
import contextlib
import json
from collections.abc import Mapping
from typing import Any
from urllib.parse import urlsplit

AGAIN_SECONDS = 0.2
LONGEST_EVENT = 1 << 16


class ChestTablet:
    """Opens the page, draws what it is told in its head, and says that it did.

    Faults: while it `hangs` it takes everything and answers nothing; while it is `off` it is not
    there.
    """

    def __init__(self, url: str, page: str = "tablet") -> None:
        """Take the page's address, such as http://127.0.0.1:8765/, and a name of its own."""
        address = urlsplit(url)
        self._host, self._port = address.hostname or "127.0.0.1", address.port or 80
        self._page = page
        self.hangs = False
        self.shown: Mapping[str, Any] = {}
        """What it shows: `text`, `number`, `before` and `asks`."""
        self.pictures = 0
        """How many it was told to show."""
        self._off = False
        self._writer: asyncio.StreamWriter | None = None
        self._task: asyncio.Task[None] | None = None

    @property
    def off(self) -> bool:
        """Whether it is switched off."""
        return self._off

    @off.setter
    def off(self, so: bool) -> None:
        self._off = so
        if so and self._writer is not None:
            self._writer.transport.abort()

    async def start(self) -> None:
        """Switch it on; it looks for the page until it is there."""
        self._task = asyncio.create_task(self._run(), name="tablet")

    async def close(self) -> None:
        """End for good."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.wait({self._task})

    async def _run(self) -> None:
        while True:
            if not self._off:
                with contextlib.suppress(OSError, asyncio.IncompleteReadError, ValueError):
                    await self._look()
            await asyncio.sleep(AGAIN_SECONDS)

    async def _look(self) -> None:
        """Take events until there are none any more; answers go over a connection of their own."""
        reader, self._writer = await asyncio.open_connection(
            self._host, self._port, limit=LONGEST_EVENT
        )
        answers, answering = await asyncio.open_connection(self._host, self._port)
        try:
            self._writer.write(f"GET /events?page={self._page} HTTP/1.1\r\n\r\n".encode())
            head = await reader.readuntil(b"\r\n\r\n")
            if b" 200 " not in head.partition(b"\r\n")[0]:
                return
            while not self._off:
                kind, _, line = (await reader.readuntil(b"\n\n")).decode().strip().partition("\n")
                number = said = json.loads(line.removeprefix("data: "))
                if self.hangs:
                    continue
                if kind == "event: show":
                    self.shown, number = said, said["n"]
                    self.pictures += 1
                answering.write(
                    f"POST /seen?page={self._page}&number={number} HTTP/1.1\r\n\r\n".encode()
                )
                await answers.readuntil(b"\r\n\r\n")
        finally:
            for writer in (self._writer, answering):
                writer.transport.abort()
