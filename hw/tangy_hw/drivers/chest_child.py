"""The process of the chest screen's page: what strangers do to it costs the robot nothing.

Run as `python -m tangy_hw.drivers.chest_child`, spoken to by JSON, one object a line:

    {"host": "0.0.0.0", "port": 8765, "names": [], "pairing": {...}}   where, and who is paired
    {"show": 7, "picture": {...}}              what pages show from now on, and its number
    {"calls": {"staff": "Station 2"}}          for whom pages show a button from now on, by a key
    {"port": 8765}                             it listens there
    {"error": "Address already in use"}        it cannot; it tries again every second
    {"page": "17", "seen": 7}                  a page of a paired tablet has drawn it
    {"gone": "17"}                             that page is not connected any more
    {"answered": "staff"}                      somebody has pressed that button
    {"failed": "That line is too long."}       a line cannot be heeded, and nothing comes of it

The first comes once, the second any number of times; the others are what it says. It ends when its
input closes.
"""

from __future__ import annotations

import asyncio
import logging
import os
from collections.abc import Callable
from contextlib import suppress

from tangy_hw.drivers.chest_pairing import Pairing
from tangy_hw.drivers.chest_server import ChestServer, Said
from tangy_profiles.process_log import log_to_stderr
from tangy_profiles.worker_lines import AnswerWriter, Asked, LineError, coming, open_lines

_LOG = logging.getLogger("tangy_hw.drivers.chest_child")  # also where it is run as a process

AGAIN_SECONDS = 1.0  # until a port that is in use is tried again
NICER = 5  # than what drives the robot


class PageChild:
    """Serves the page on request, and reports its events."""

    def __init__(self, say: Callable[[Said], None]) -> None:
        self._say = say
        self._server: ChestServer | None = None
        self._listening: asyncio.Task[None] | None = None

    def take(self, told: Asked) -> None:
        """Take the setup, or what pages show or offer from now on.

        Raises:
            LineError: it is neither.
        """
        match told:
            case {
                "host": str(host),
                "port": int(port),
                "names": list(names),
                "pairing": dict(known),
            }:
                if self._server is None:
                    pairing = Pairing.from_json(known)
                    self._server = ChestServer(host, port, pairing, self._say, names)
            case {"show": int(number), "picture": dict(picture)} if self._server is not None:
                self._server.show(number, picture)
                if self._listening is None:  # there is something to show from the first page on
                    self._listening = asyncio.create_task(self._listen(self._server))
            case {"calls": dict(calls)} if self._server is not None:
                self._server.offer(calls)
            case _:
                raise LineError(
                    "A line must hold the setup, once, or then show and picture, or calls."
                )

    async def _listen(self, server: ChestServer) -> None:
        """Begin to listen, as soon as that can be."""
        while True:
            try:
                await server.start()
            except (OSError, OverflowError, UnicodeError) as error:  # or no such host or port
                self._say({"error": str(getattr(error, "strerror", None) or error)})
                await asyncio.sleep(AGAIN_SECONDS)
            else:
                self._say({"port": server.port})
                return

    async def close(self) -> None:
        """Serve no more."""
        if self._listening is not None:
            self._listening.cancel()
        if self._server is not None:
            await self._server.close()


async def run() -> None:
    """Serve the page until there is nothing more to hear."""
    answers = AnswerWriter()
    lines, _ = await open_lines()
    child = PageChild(answers.write)
    async for told in coming(answers.refuse, lines):
        try:
            child.take(told)
        except (LineError, ValueError) as error:
            answers.refuse(str(error))
    await child.close()


def main() -> None:
    """Run it."""
    log_to_stderr()
    _LOG.info("the page of the chest screen is served")
    with suppress(OSError):
        os.nice(NICER)
    with suppress(KeyboardInterrupt):
        asyncio.run(run())


if __name__ == "__main__":
    main()
