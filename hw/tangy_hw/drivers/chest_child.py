"""The process of the chest screen's page: what strangers do to it costs the robot nothing.

Run as `python -m tangy_hw.drivers.chest_child`, spoken to by JSON, one object a line:

    {"host": "0.0.0.0", "port": 8765, "names": [], "pairing": {...}}   where, and who is paired
    {"show": 7, "picture": {...}}              what pages show from now on, and its number
    {"port": 8765}                             it listens there
    {"error": "Address already in use"}        it cannot; it tries again every second
    {"page": "17", "seen": 7}                  a page of a paired tablet has drawn it
    {"gone": "17"}                             that page is not connected any more

The first comes once, the second any number of times; the others are what it says. It ends when its
input closes.
"""

from __future__ import annotations

import asyncio
import json
import logging
import os
import sys
from contextlib import suppress

from tangy_hw.drivers.chest_pairing import Pairing
from tangy_hw.drivers.chest_server import ChestServer, Said
from tangy_profiles.process_log import log_to_stderr

_LOG = logging.getLogger(__name__)

AGAIN_SECONDS = 1.0  # until a port that is in use is tried again
NICER = 5  # than what drives the robot


def say(said: Said) -> None:
    """Write a line; who does not read it any more has ended."""
    try:
        os.write(1, json.dumps(said).encode() + b"\n")
    except OSError:
        os._exit(0)


async def listen(server: ChestServer) -> None:
    """Begin to listen, as soon as that can be."""
    while True:
        try:
            await server.start()
        except (OSError, OverflowError, UnicodeError) as error:  # or there is no such host or port
            say({"error": str(getattr(error, "strerror", None) or error)})
            await asyncio.sleep(AGAIN_SECONDS)
        else:
            say({"port": server.port})
            return


async def run() -> None:
    """Serve the page until there is nothing more to hear."""
    lines = asyncio.StreamReader()
    await asyncio.get_running_loop().connect_read_pipe(
        lambda: asyncio.StreamReaderProtocol(lines), sys.stdin
    )
    setup = json.loads(await lines.readline())
    pairing = Pairing.from_json(setup["pairing"])
    server = ChestServer(setup["host"], setup["port"], pairing, say, setup["names"])
    listening: asyncio.Task[None] | None = None
    while line := await lines.readline():
        told = json.loads(line)
        server.show(int(told["show"]), told["picture"])
        if listening is None:  # there is something to show from the first page on
            listening = asyncio.create_task(listen(server))
    if listening is not None:
        listening.cancel()
    await server.close()


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
