"""Minimal HTTP/1.1 server side for a page on a tablet: short requests and responses."""

from __future__ import annotations

import asyncio
import ipaddress
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from urllib.parse import parse_qs, urlsplit

LONGEST_HEAD, LONGEST_BODY = 8192, 256  # bytes

STATUSES = {
    200: "OK",
    204: "No Content",
    400: "Bad Request",
    403: "Forbidden",
    404: "Not Found",
    405: "Method Not Allowed",
    421: "Misdirected Request",
    429: "Too Many Requests",
    503: "Service Unavailable",
}

# The page may load resources from this server, and nothing from elsewhere.
SAFE = (
    "Content-Security-Policy: default-src 'none'; style-src 'self'; script-src 'self'; "
    "img-src 'self'; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'\r\n"
    "X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nCache-Control: no-store\r\n"
)


class BadRequest(Exception):
    """A request that this server does not answer."""


@dataclass(frozen=True, slots=True)
class Request:
    """A browser's request: method, path, and query.

    `headers` have lower-case names; `stays` says whether the connection is kept alive.
    """

    method: str
    path: str
    query: Mapping[str, str] = field(default_factory=dict)
    headers: Mapping[str, str] = field(default_factory=dict)
    body: bytes = b""
    stays: bool = True

    def cookie(self, name: str) -> str:
        """Return the value of a cookie; "" if it is not set."""
        for one in self.headers.get("cookie", "").split(";"):
            key, _, value = one.strip().partition("=")
            if key == name:
                return value
        return ""

    def meant_for(self, names: Collection[str]) -> bool:
        """Return whether its Host header names this machine.

        A page on the internet whose name resolves to this machine (DNS rebinding) still sends its
        own name as Host, and a page of another address sends that as Origin.
        """
        host = self.headers.get("host", "")
        origin = self.headers.get("origin", "")
        if origin and origin.partition("://")[2] != host:
            return False
        try:
            name = urlsplit(f"//{host}").hostname or ""
        except ValueError:
            return False
        name = name.rstrip(".")
        return name in names or _is_address(name)


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name.partition("%")[0])
    except ValueError:
        return False
    return True


async def read_request(reader: asyncio.StreamReader, seconds: float) -> Request | None:
    """Read the next request; return None at the end of the connection.

    Args:
        reader: the connection's stream.
        seconds: timeout for the whole request.

    Raises:
        BadRequest: the request is invalid or too long.
        TimeoutError: it was not complete in time.
    """
    async with asyncio.timeout(seconds):
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
        if not (length.isascii() and length.isdecimal()) or len(length) > 9:
            raise BadRequest
        if int(length) > LONGEST_BODY or "transfer-encoding" in headers:
            raise BadRequest
        try:
            body = await reader.readexactly(int(length))
        except (asyncio.IncompleteReadError, OSError):
            return None
    try:
        asked = urlsplit(words[1])
        query = parse_qs(asked.query, max_num_fields=8)
    except ValueError:
        raise BadRequest from None
    stays = words[2] != "HTTP/1.0" and headers.get("connection", "").lower() != "close"
    last = {name: one[-1] for name, one in query.items()}
    return Request(words[0], asked.path, last, headers, body, stays)


def response(
    status: int, body: bytes = b"", kind: str = "text/plain; charset=utf-8", *, more: str = ""
) -> bytes:
    """Return a response with its body; `more` are additional header lines."""
    return (
        f"HTTP/1.1 {status} {STATUSES[status]}\r\n{SAFE}{more}"
        f"Content-Type: {kind}\r\nContent-Length: {len(body)}\r\n\r\n"
    ).encode() + body


def cookie_line(name: str, value: str) -> str:
    """Return a header line that sets a cookie for as long as browsers allow (400 days)."""
    kept = f"Max-Age={400 * 86_400}; Path=/; HttpOnly; SameSite=Strict"
    return f"Set-Cookie: {name}={value}; {kept}\r\n"


def stream_head() -> bytes:
    """Return the head of a response with server-sent events."""
    return (
        f"HTTP/1.1 200 OK\r\n{SAFE}Content-Type: text/event-stream\r\nConnection: close\r\n\r\n"
    ).encode()


def event(kind: str, line: str) -> bytes:
    """Return a server-sent event with one line of data."""
    return f"event: {kind}\ndata: {line}\n\n".encode()
