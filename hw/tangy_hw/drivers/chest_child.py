"""Process that serves the chest screen's page, so that strangers cannot slow down the robot.

Run as `python -m tangy_hw.drivers.chest_child`; speaks JSON lines:

    {"host": "0.0.0.0", "port": 8765, "names": [], "pairing": {...}}   address, and pairing
    {"show": 7, "picture": {...}}              picture to show, and its number
    {"calls": {"staff": "Station 2"}}          open calls to show a button for, by key
    {"port": 8765}                             it listens there
    {"error": "Address already in use"}        it does not; it retries every second
    {"page": "17", "seen": 7}                  a page of a paired tablet has drawn it
    {"gone": "17"}                             that page has disconnected
    {"answered": "staff"}                      a person has pressed that button
    {"failed": "That line is too long."}       an invalid line was ignored

The program sends the first once, then `show` and `calls`; the process sends the others. It exits
when its input closes.
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

_LOG = logging.getLogger("tangy_hw.drivers.chest_child")  # also if run as a script

AGAIN_SECONDS = 1.0  # until a port in use is tried again
NICER = 5  # added to the nice value, so that the robot process comes first


class PageChild:
    """Serves the page on request, and reports its events."""

    def __init__(self, say: Callable[[Said], None]) -> None:
        self._say = say
        self._server: ChestServer | None = None
        self._listening: asyncio.Task[None] | None = None

    def take(self, told: Asked) -> None:
        """Handle the setup, or what pages show or offer.

        Raises:
            LineError: the line is neither.
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
                if self._listening is None:  # the first page that opens has a picture to show
                    self._listening = asyncio.create_task(self._listen(self._server))
            case {"calls": dict(calls)} if self._server is not None:
                self._server.offer(calls)
            case _:
                raise LineError(
                    "A line must hold the setup, once, or then show and picture, or calls."
                )

    async def _listen(self, server: ChestServer) -> None:
        """Start to listen, as soon as possible."""
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
        """Stop serving."""
        if self._listening is not None:
            self._listening.cancel()
        if self._server is not None:
            await self._server.close()


async def run() -> None:
    """Serve the page until the input closes."""
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
    """Run the process."""
    log_to_stderr()
    _LOG.info("the page of the chest screen is served")
    with suppress(OSError):
        os.nice(NICER)
    with suppress(KeyboardInterrupt):
        asyncio.run(run())


if __name__ == "__main__":
    main()
