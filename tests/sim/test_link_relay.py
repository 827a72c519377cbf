"""A relay delays a connection, keeps its bytes in order, and resends lost packets."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from random import Random
from urllib.parse import urlsplit

import pytest

from tangy_sim.servers.link_relay import PACKET, RESEND_SECONDS, LinkQuality, LinkRelays
from tests.hw.waiting import PATIENCE, until


class Certain(Random):
    """A generator that loses given packets (1 for lost), and none afterwards."""

    def __init__(self, lost: str) -> None:
        super().__init__(1)
        self._lost = list(lost)

    def random(self) -> float:
        return 0.0 if self._lost and self._lost.pop(0) == "1" else 1.0


@pytest.mark.parametrize(
    ("lost", "size", "late"),
    [
        ("0", 10, 0.05),
        ("1", 10, 0.05 + RESEND_SECONDS),  # nothing follows it, so only the time-out shows the loss
        ("110", 10, 0.05 + 3 * RESEND_SECONDS),  # lost again: each time-out is twice as long
        ("0001", 4 * PACKET, 0.05 + 0.1),  # three packets follow it: one round trip
        ("01", 4 * PACKET, 0.05 + RESEND_SECONDS),
        ("", 0, 0.05),
    ],
)
def test_a_lost_packet_arrives_late(lost: str, size: int, late: float) -> None:
    link = LinkQuality(delay=0.05, loss=0.5)
    assert link.late(size, Certain(lost)) == pytest.approx(late)


def test_the_loss_rate_matches_the_setting() -> None:
    link, chance = LinkQuality(loss=0.1), Random(1)
    lost = sum(link.late(10, chance) > 0 for _ in range(2000))
    assert 150 < lost < 250  # 200 expected, with a standard deviation of 13


@asynccontextmanager
async def echo() -> AsyncIterator[tuple[str, list[asyncio.StreamWriter]]]:
    """Serve an echo, and keep the connections."""
    there: list[asyncio.StreamWriter] = []

    async def serve(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        there.append(writer)
        while read := await reader.read(1000):
            writer.write(read)
        writer.close()

    server = await asyncio.start_server(serve, "127.0.0.1", 0)
    yield f"http://127.0.0.1:{server.sockets[0].getsockname()[1]}/head", there
    server.close()


@asynccontextmanager
async def relayed(quality: LinkQuality, url: str) -> AsyncIterator[str]:
    relays = LinkRelays(quality, 1)
    yield await relays.relayed(url)
    await relays.close()


async def test_bytes_arrive_in_order_and_delayed_in_both_directions() -> None:
    sent = bytes(number % 251 for number in range(200_000))
    async with echo() as (url, _), relayed(LinkQuality(0.02, 0.05), url) as there:
        assert there != url and there.endswith("/head")
        reader, writer = await asyncio.open_connection("127.0.0.1", urlsplit(there).port)
        loop = asyncio.get_running_loop()
        began = loop.time()
        writer.write(sent)
        async with asyncio.timeout(PATIENCE):
            assert await reader.readexactly(1) == sent[:1]
            first = loop.time() - began
            assert await reader.readexactly(len(sent) - 1) == sent[1:]
        writer.close()
    assert first >= 0.04


async def test_an_end_on_one_side_ends_the_other() -> None:
    async with echo() as (url, connections), relayed(LinkQuality(0.01), url) as there:
        port = urlsplit(there).port
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        await until(lambda: len(connections) == 1)
        connections[0].transport.abort()
        async with asyncio.timeout(PATIENCE):
            assert await reader.read() == b""
        writer.close()
        _, other = await asyncio.open_connection("127.0.0.1", port)
        await until(lambda: len(connections) == 2)
        other.close()
        await until(connections[1].is_closing)


async def test_a_perfect_link_needs_no_relay() -> None:
    async with echo() as (url, _), relayed(LinkQuality(), url) as there:
        assert there == url
