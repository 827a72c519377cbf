"""Requests of tests to the chest screen's page, and the header of a paired tablet."""

from __future__ import annotations

import asyncio

from tangy_hw.drivers.chest_pairing import Pairing
from tests.hw.waiting import PATIENCE


def paired(pairing: Pairing) -> bytes:
    """Return the request header that identifies a paired tablet."""
    return f"Cookie: other=1; {pairing.cookie}={pairing.token()}\r\n".encode()


async def ask(
    port: int,
    method: str,
    target: str,
    more: bytes = b"",
    *,
    host: str = "127.0.0.1:80",
    body: bytes = b"",
) -> bytes:
    """Send one request, and return the whole response."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    head = f"{method} {target} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n".encode()
    length = b"" if b"Content-Length" in more else b"Content-Length: %d\r\n" % len(body)
    writer.write(head + length + more + b"\r\n" + body)
    async with asyncio.timeout(PATIENCE):
        answer = await reader.read()
    writer.close()
    return answer
