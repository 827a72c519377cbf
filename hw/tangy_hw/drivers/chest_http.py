"""As much of HTTP as a page on a tablet needs: short requests in, short answers out."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import dataclass, field
from urllib.parse import parse_qs, urlsplit

LONGEST_HEAD, LONGEST_BODY = 8192, 4096  # bytes
IDLE_SECONDS = 30.0  # for which a connection is kept between two requests

STATUSES = {
    200: "OK",
    204: "No Content",
    400: "Bad Request",
    404: "Not Found",
    405: "Method Not Allowed",
    503: "Service Unavailable",
}

# The page may load what comes from here, and nothing else from anywhere.
SAFE = (
    "Content-Security-Policy: default-src 'none'; style-src 'self'; script-src 'self'; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n"
    "X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nCache-Control: no-store\r\n"
)


class BadRequest(Exception):
    """What came is no request that is answered here."""


@dataclass(frozen=True, slots=True)
class Request:
    """What a browser asks for: method, path, and what stands behind the question mark."""

    method: str
    path: str
    query: Mapping[str, str] = field(default_factory=dict)
    stays: bool = True
    """Whether it will ask more over the same connection."""


async def read_request(reader: asyncio.StreamReader) -> Request | None:
    """Read the next request, and pass over its body; None: there is none any more.

    Raises:
        BadRequest: it is none, or too long.
        TimeoutError: it did not come to its end in time.
    """
    async with asyncio.timeout(IDLE_SECONDS):
        try:
            head = await reader.readuntil(b"\r\n\r\n")
        except asyncio.LimitOverrunError:
            raise BadRequest from None
        except (asyncio.IncompleteReadError, OSError):
            return None
        first, *lines = head.decode("latin-1").split("\r\n")
        words = first.split(" ")
        if len(head) > LONGEST_HEAD or len(words) != 3 or not words[2].startswith("HTTP/1."):
            raise BadRequest
        headers = {
            name.strip().lower(): value.strip()
            for name, colon, value in (line.partition(":") for line in lines)
            if colon
        }
        length = headers.get("content-length", "0")
        if not length.isdecimal() or int(length) > LONGEST_BODY:
            raise BadRequest
        if "transfer-encoding" in headers:
            raise BadRequest
        try:
            await reader.readexactly(int(length))
        except (asyncio.IncompleteReadError, OSError):
            return None
    try:
        asked = urlsplit(words[1])
        query = parse_qs(asked.query, max_num_fields=8)
    except ValueError:
        raise BadRequest from None
    stays = words[2] != "HTTP/1.0" and headers.get("connection", "").lower() != "close"
    return Request(words[0], asked.path, {name: one[-1] for name, one in query.items()}, stays)


def response(status: int, body: bytes = b"", kind: str = "text/plain; charset=utf-8") -> bytes:
    """Write an answer with its body."""
    return (
        f"HTTP/1.1 {status} {STATUSES[status]}\r\n{SAFE}"
        f"Content-Type: {kind}\r\nContent-Length: {len(body)}\r\n\r\n"
    ).encode() + body


def stream_head() -> bytes:
    """Write the beginning of an answer in which events follow (server-sent events)."""
    return (
        f"HTTP/1.1 200 OK\r\n{SAFE}Content-Type: text/event-stream\r\nConnection: close\r\n\r\n"
    ).encode()


def event(kind: str, line: str) -> bytes:
    """Write an event; its text has one line."""
    return f"event: {kind}\ndata: {line}\n\n".encode()
