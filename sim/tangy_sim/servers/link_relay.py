"""A relay that delays TCP connections, and delays them more where a network would lose packets.

TCP loses nothing: what a network loses arrives later, and so does all that follows it. A lost
packet that at least three others follow at once is sent again after one round trip, any other one
after `RESEND_SECONDS`, then after twice as long, and so on.
"""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from random import Random
from urllib.parse import urlsplit

RESEND_SECONDS = 0.2  # the least retransmission timeout of Linux
PACKET = 1448  # bytes of data in a packet
FOLLOWING = 3  # packets after a lost one, by which the loss is noticed at once
CHUNK = 65536  # bytes read at once
WAITING = 64  # chunks on their way, after which no more are read

Coming = asyncio.Queue[tuple[float, bytes]]
"""When each chunk is due, and the chunk; b"": the end."""


@dataclass(frozen=True)
class LinkQuality:
    """The quality of a network: delay (s) in each direction, and the share of packets lost."""

    delay: float = 0.0
    loss: float = 0.0

    @property
    def perfect(self) -> bool:
        """Whether it neither delays nor loses anything."""
        return not (self.delay or self.loss)

    def late(self, size: int, chance: Random) -> float:
        """Return after how many s the last of so many bytes arrives, by chance."""
        latest = 0.0
        for after in range(-(-size // PACKET)):  # packets that follow this one
            if chance.random() >= self.loss:
                continue
            late, again = RESEND_SECONDS, 2 * RESEND_SECONDS
            if after >= FOLLOWING:
                late, again = 2 * self.delay, RESEND_SECONDS
            while chance.random() < self.loss:
                late, again = late + again, 2 * again
            latest = max(latest, late)
        return self.delay + latest


class LinkRelays:
    """Relays to servers, one for each of their ports."""

    def __init__(self, quality: LinkQuality, seed: int) -> None:
        """Prepare relays of a quality; the seed determines which packets are lost."""
        self._quality = quality
        self._chance = Random(f"{seed}/links")
        self._relays: dict[tuple[str, int], asyncio.Server] = {}
        self._tasks: set[asyncio.Task[None]] = set()

    async def relayed(self, url: str) -> str:
        """Return the address by which a server is reached through a relay."""
        if self._quality.perfect:
            return url
        parts = urlsplit(url)
        host, port = parts.hostname or "127.0.0.1", parts.port or 80
        if (host, port) not in self._relays:

            async def serve(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
                await self._serve(reader, writer, host, port)

            self._relays[host, port] = await asyncio.start_server(serve, host, 0)
        relay = self._relays[host, port].sockets[0].getsockname()[1]
        return parts._replace(netloc=f"{host}:{relay}").geturl()

    async def close(self) -> None:
        """Close all connections and relays."""
        for relay in self._relays.values():
            relay.close()
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    async def _serve(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, host: str, port: int
    ) -> None:
        """Pass a connection on in both directions, until either side ends it."""
        task = asyncio.current_task()
        assert task is not None  # noqa: S101 - a server's connections are tasks
        self._tasks.add(task)
        writers = [writer]
        try:
            there, to_server = await asyncio.open_connection(host, port)
            writers.append(to_server)
            async with asyncio.TaskGroup() as both:
                for source, target in ((reader, to_server), (there, writer)):
                    coming: Coming = asyncio.Queue(WAITING)
                    both.create_task(self._read(source, coming))
                    both.create_task(self._send(coming, target))
        except* OSError:
            pass  # one side is gone: so is the other
        finally:
            self._tasks.discard(task)
            for one in writers:
                one.transport.abort()

    async def _read(self, reader: asyncio.StreamReader, coming: Coming) -> None:
        """Note when what one side sends is due at the other, in order."""
        loop, due, read = asyncio.get_running_loop(), 0.0, b"-"
        while read:
            read = await reader.read(CHUNK)
            due = max(due, loop.time() + self._quality.late(len(read), self._chance))
            await coming.put((due, read))

    async def _send(self, coming: Coming, writer: asyncio.StreamWriter) -> None:
        """Send the messages that are due.

        Raises:
            OSError: a side has ended the connection.
        """
        loop = asyncio.get_running_loop()
        while True:
            due, read = await coming.get()
            await asyncio.sleep(max(0.0, due - loop.time()))
            if not read:
                raise ConnectionResetError
            writer.write(read)
            await writer.drain()
