"""Fixtures for tests of the link by rosbridge: a server, a link to it, a clock that tests set."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Awaitable
from contextlib import asynccontextmanager
from typing import Any

from websockets.asyncio.server import ServerConnection, serve

from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_sim.servers.rosbridge_server import RosbridgeServer
from tests.support.waiting import until

SOON = 5  # s in which an immediate event has happened on any machine


class Now:
    """A clock that tests set."""

    def __init__(self) -> None:
        self.time = 100.0

    def __call__(self) -> float:
        return self.time


@asynccontextmanager
async def linked(**settings: Any) -> AsyncIterator[tuple[RosbridgeServer, Rosbridge, Now]]:
    """Open a server and a link to it, on a clock that the test sets."""
    server, now = RosbridgeServer(), Now()
    await server.start()
    bridge = Rosbridge(server.url, **{"clock": now, **settings})
    await bridge.start()
    assert await bridge.wait_connected(SOON)
    try:
        yield server, bridge, now
    finally:
        await bridge.close()
        await server.close()


async def soon(thing: Awaitable[Any]) -> Any:
    """Wait for an immediate event."""
    return await asyncio.wait_for(thing, SOON)


async def done(_: Any) -> dict[str, Any]:
    """Serve a service that does nothing."""
    return {"done": True}


class Raw:
    """A server with scripted messages that records the received ones."""

    def __init__(self) -> None:
        self.heard: list[dict[str, Any]] = []
        self.link: ServerConnection | None = None

    @asynccontextmanager
    async def serving(self, **settings: Any) -> AsyncIterator[Rosbridge]:
        async def attend(link: ServerConnection) -> None:
            self.link = link
            async for text in link:
                self.heard.append(json.loads(text))

        async with serve(attend, "127.0.0.1", 0, compression=None) as server:
            port = next(iter(server.sockets)).getsockname()[1]
            bridge = Rosbridge(f"ws://127.0.0.1:{port}", **settings)
            await bridge.start()
            assert await bridge.wait_connected(SOON)
            await until(lambda: self.link is not None)
            yield bridge
            await bridge.close()

    async def say(self, text: str | bytes | dict[str, Any]) -> None:
        assert self.link is not None
        await self.link.send(json.dumps(text) if isinstance(text, dict) else text)


def diagnoses(*statuses: tuple[str, int, str]) -> dict[str, Any]:
    """Return diagnostics: name, level and sentence of each."""
    return {
        "status": [
            {"name": name, "level": level, "message": says, "values": []}
            for name, level, says in statuses
        ]
    }
