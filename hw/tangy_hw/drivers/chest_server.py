"""Server of the chest screen's page, with access control and limits on what strangers can use.

It talks to `chest.js`. A tablet is paired once (`POST /pair` with the code on the console) and
keeps a token as a cookie. A paired page receives the events `show` (a number and a picture, as
JSON) and `alive` (the number again), and acknowledges both with `POST /seen?page=P&number=N`. A
picture can have a `file`, which a page requests with `GET /file?n=N`. While staff are called,
`calls` lists the buttons to show; a press is `POST /answer?call=KEY`. Other browsers only get the
page that asks for the code. A browser paired as a viewer shows the same page, but only the robot's
tablets count as a working chest screen.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import socket
import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tangy_hw.drivers.chest_http import (
    LONGEST_HEAD,
    BadRequest,
    Request,
    cookie_line,
    event,
    read_request,
    response,
    stream_head,
)
from tangy_hw.drivers.chest_pairing import CodeCheck, Pairing, TooManyCodes
from tangy_profiles.declared.media import read_picture
from tangy_profiles.errors import ProfileError

ALIVE_SECONDS = 0.4  # between two events, and so between two answers of a page
SEND_SECONDS = 2.0  # timeout for sending a message to a page
FILE_SECONDS = 20.0  # timeout for sending a picture's file (at most 4 MB) to a paired tablet
ASK_SECONDS = 3.0  # timeout for a stranger's request, from the connection on
IDLE_SECONDS = 30.0  # for which an idle connection of a paired tablet is kept
GONE_SECONDS = 5.0  # without an answer, after which another page may replace it
MOST_PAGES = 16
LOOKS_ON = "viewer"  # after the code in a viewer's request to pair
MOST_CONNECTIONS = 64

FILES = {
    "/": ("chest.html", "text/html; charset=utf-8"),
    "/chest.css": ("chest.css", "text/css; charset=utf-8"),
    "/chest.js": ("chest.js", "text/javascript; charset=utf-8"),
}

Said = dict[str, Any]


@dataclass(eq=False, slots=True)
class _Connection:
    """A connection: its address, and whether a paired tablet uses it."""

    writer: asyncio.StreamWriter
    task: asyncio.Task[None]
    address: str
    paired: bool = False
    viewer: bool = False
    """Whether a viewer uses it, rather than one of the robot's tablets."""
    told: bool = False
    """Whether it receives events, and so sends no more requests."""


@dataclass(eq=False, slots=True)
class _Page:
    """A page that is open on a paired tablet, and when it last acknowledged an event."""

    heard: float
    changed: asyncio.Event = field(default_factory=asyncio.Event)
    over: bool = False


class ChestServer:
    """Serves the page; calls `tell` with the events of pages.

    These are {"page": name, "seen": number}, {"gone": name} and {"answered": key}.
    """

    def __init__(
        self,
        host: str,
        port: int,
        pairing: Pairing,
        tell: Callable[[Said], None],
        names: Sequence[str] = (),
    ) -> None:
        """Prepare the server; `names` are further host names that tablets may use."""
        self.host, self.port = host, port
        self._pairing = pairing
        self._codes = CodeCheck(pairing.code)
        self._tell = tell
        own = socket.gethostname().lower()
        self._names = {host.lower(), "localhost", own, f"{own.partition('.')[0]}.local", *names}
        self._server: asyncio.Server | None = None
        self._connections: dict[_Connection, None] = {}  # oldest first
        self.windows: dict[str, _Page] = {}
        self._number = -1
        self._file: tuple[bytes, str] | None = None
        """Content and media type of the current picture's file."""
        self.newest = b""
        self._calls: dict[str, str] = {}

    async def start(self) -> None:
        """Start to listen.

        Raises:
            OSError, OverflowError, UnicodeError: it cannot listen at this address.
        """
        self._server = await asyncio.start_server(
            self._serve, self.host, self.port, limit=LONGEST_HEAD
        )
        self.port = self._server.sockets[0].getsockname()[1]

    async def close(self) -> None:
        """Close for good; pages show that the connection is lost."""
        server, self._server = self._server, None
        if server is not None:
            server.close()
        tasks = [connection.task for connection in self._connections]
        for task in tasks:
            task.cancel()
        if tasks:
            await asyncio.wait(tasks)

    def show(self, number: int, picture: Mapping[str, Any]) -> None:
        """Show a picture on all pages, also on those that open later."""
        self._number = number
        self._file = _file_of(str(picture.get("file", "")))
        self.newest = event("show", json.dumps({"n": number, **picture, "file": bool(self._file)}))
        for page in self.windows.values():
            page.changed.set()

    def offer(self, calls: Mapping[str, str]) -> None:
        """Show a button for each open call on all pages: name of the called person, by key."""
        self._calls = dict(calls)
        for page in self.windows.values():
            page.changed.set()

    @property
    def connections(self) -> int:
        """Number of open connections."""
        return len(self._connections)

    # ------------------------------------------------------------------------- connections

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = asyncio.current_task()
        assert task is not None  # noqa: S101
        address = str((writer.get_extra_info("peername") or ("",))[0])
        mine = _Connection(writer, task, address)
        self._connections[mine] = None
        self._make_room(mine)
        try:
            await self._serve_requests(reader, mine)
        except BadRequest:
            writer.write(response(400, b"No request that is answered here.\n"))
        except (OSError, TimeoutError, asyncio.CancelledError):
            pass  # closed by the client, too slow, dropped for another, or shutting down
        finally:
            self._connections.pop(mine, None)
            with contextlib.suppress(OSError):
                writer.close()

    def _make_room(self, newest: _Connection) -> None:
        """Drop a connection if there are too many.

        Strangers are dropped first: the oldest connection from the address with the most of them.
        So a paired tablet gets in however many strangers there are.
        """
        if len(self._connections) <= MOST_CONNECTIONS:
            return
        strangers = [one for one in self._connections if not one.paired and one is not newest]
        if strangers:
            counts = Counter(one.address for one in strangers)
            dropped = max(strangers, key=lambda one: counts[one.address])  # the oldest of equals
        else:
            asking = (one for one in self._connections if not one.told)
            dropped = next(asking, newest)
        self._connections.pop(dropped, None)
        dropped.writer.transport.abort()
        dropped.task.cancel()

    async def _serve_requests(self, reader: asyncio.StreamReader, mine: _Connection) -> None:
        writer = mine.writer
        while request := await read_request(reader, IDLE_SECONDS if mine.paired else ASK_SECONDS):
            token = request.cookie(self._pairing.cookie)
            mine.paired = self._pairing.knows(token)
            mine.viewer = self._pairing.is_viewer(token)
            if not request.meant_for(self._names):
                writer.write(response(421, b"Open this page by its address in numbers.\n"))
                return
            if mine.paired and request.path == "/events" and request.method == "GET":
                mine.told = True
                await self._tell_events(request, writer)
                return
            writer.write(self._answer(request, mine))
            async with asyncio.timeout(FILE_SECONDS if mine.paired else SEND_SECONDS):
                await writer.drain()
            if not request.stays:
                return

    # ------------------------------------------------------------------------- requests

    def _answer(self, request: Request, asker: _Connection) -> bytes:
        posts = {"/seen": self._seen, "/pair": self._pair, "/answer": self._answered}
        if request.path in posts:
            return (
                posts[request.path](request, asker) if request.method == "POST" else response(405)
            )
        if request.method not in ("GET", "HEAD"):
            return response(405)
        if request.path in ("/paired", "/events"):
            return response(204 if asker.paired else 403)
        if request.path == "/file" and asker.paired and self._file is not None:
            whole = response(200, *self._file)
        elif request.path in FILES:
            file, kind = FILES[request.path]
            whole = response(200, (Path(__file__).parent / file).read_bytes(), kind)
        else:
            return response(404, b"There is only one page here: /\n")
        return whole if request.method == "GET" else whole.partition(b"\r\n\r\n")[0] + b"\r\n\r\n"

    def _pair(self, request: Request, asker: _Connection) -> bytes:
        code, looks_on, _ = request.body.decode("ascii", "replace").partition(LOOKS_ON)
        try:
            right = self._codes.right(code, asker.address)
        except TooManyCodes:
            return response(429)
        if not right:
            return response(403)
        token = self._pairing.token(viewer=bool(looks_on))
        return response(204, more=cookie_line(self._pairing.cookie, token))

    def _seen(self, request: Request, asker: _Connection) -> bytes:
        """Handle a paired page's acknowledgement of an event."""
        name, number = request.query.get("page", ""), request.query.get("number", "")
        if not asker.paired:
            return response(403)
        page = self.windows.get(name)
        if page is None or not (number.isascii() and number.isdecimal() and len(number) < 10):
            return response(404)
        page.heard = time.monotonic()
        if not asker.viewer:
            self._tell({"page": name, "seen": min(int(number), self._number)})
        return response(204)

    def _answered(self, request: Request, asker: _Connection) -> bytes:
        """Handle a paired page's answer to an open call; viewers may answer too."""
        if not asker.paired:
            return response(403)
        key = request.query.get("call", "")
        if key not in self._calls:
            return response(404)
        self._tell({"answered": key})
        return response(204)

    # ------------------------------------------------------------------------- events

    def _may_open(self, name: str) -> bool:
        """Return whether there is room for a page; one that no longer answers is dropped."""
        if not (0 < len(name) <= 40):
            return False
        if len(self.windows) < MOST_PAGES or name in self.windows:
            return True
        quiet = min(self.windows, key=lambda name: self.windows[name].heard)
        if self.windows[quiet].heard > time.monotonic() - GONE_SECONDS:
            return False
        self._end(quiet)
        return True

    def _end(self, name: str) -> None:
        page = self.windows.pop(name)
        page.over = True
        page.changed.set()

    async def _tell_events(self, request: Request, writer: asyncio.StreamWriter) -> None:
        """Send events to a page until it disconnects."""
        name = request.query.get("page", "")
        if not self._may_open(name):
            writer.write(response(503, b"There are too many pages open.\n"))
            return
        page = _Page(time.monotonic())
        if (before := self.windows.get(name)) is not None:  # the same page after a lost connection
            page.heard = before.heard
            self._end(name)
        self.windows[name] = page
        writer.write(stream_head())
        try:
            await self._events(page, writer)
        finally:
            if self.windows.get(name) is page:
                del self.windows[name]
                self._tell({"gone": name})

    async def _events(self, page: _Page, writer: asyncio.StreamWriter) -> None:
        sent, offered = -2, dict[str, str]()
        while not page.over:
            page.changed.clear()
            writer.write(self.newest if sent != self._number else event("alive", str(sent)))
            sent = self._number
            if offered != self._calls:
                offered = dict(self._calls)
                writer.write(event("calls", json.dumps(offered)))
            async with asyncio.timeout(SEND_SECONDS):
                await writer.drain()
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(page.changed.wait(), ALIVE_SECONDS)


def _file_of(path: str) -> tuple[bytes, str] | None:
    """Read a picture's file; None if there is none, or it cannot be shown."""
    with contextlib.suppress(ProfileError):
        return read_picture(path) if path else None
    return None
