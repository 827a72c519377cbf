"""The screen on the robot's chest: a page that any tablet's browser shows, told what by events.

The page answers every event that it has drawn, so that it is known what people really see. It
speaks with `chest.js`: events `show` (a number and a picture, as JSON) and `alive` (the number
again), both answered with `POST /seen?page=P&number=N`.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import math
import socket
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from tangy_hw.arrivals import Arrivals
from tangy_hw.devices import DeviceError, Picture
from tangy_hw.drivers.chest_http import (
    LONGEST_HEAD,
    BadRequest,
    Request,
    event,
    read_request,
    response,
    stream_head,
)
from tangy_profiles.health import ERROR, OK, STALE, WARN, Reading
from tangy_profiles.reading import plain

PORT = 8765
SHOW_SECONDS = 1.0  # in which a page draws what it is told; they take 10 to 50 ms
ALIVE_SECONDS = 0.4  # between two events, and so two answers of each page
GONE_SECONDS = 3.0  # without an answer: a page that is not there any more
SEND_SECONDS = 2.0  # in which a page takes what is sent to it
AGAIN_SECONDS = 1.0  # until a port that is in use is tried again
MOST_PAGES = 16
NEVER = 3600.0

FILES = {
    "/": ("chest.html", "text/html; charset=utf-8"),
    "/chest.css": ("chest.css", "text/css; charset=utf-8"),
    "/chest.js": ("chest.js", "text/javascript; charset=utf-8"),
}


@dataclass(eq=False, slots=True)
class _Page:
    """A page that is open somewhere: what it has drawn, and when it last said so."""

    seen: int = 0
    heard: float = -math.inf
    changed: asyncio.Event = field(default_factory=asyncio.Event)
    over: bool = False


class WebChestScreen:
    """A page in the network; every tablet that opens its address shows the same.

    Whoever comes later is shown the picture that is on at once. It works in the time of the
    machine, also on a bench in a hurry: its pages do.
    """

    def __init__(
        self,
        host: str = "127.0.0.1",
        port: int = PORT,
        *,
        name: str = "screen",
        clock: Callable[[], float] = time.monotonic,
        stale_after: float = 1.0,
    ) -> None:
        """Prepare the screen; nothing listens before `start`.

        Args:
            host: where it listens: 127.0.0.1 for a screen of this machine, 0.0.0.0 for tablets.
            port: 0 for one that is free.
            name: what the robot's profile calls it.
            clock: gives the time in s.
            stale_after: s without an answer from any page after which nobody is thought to look.
        """
        self.name = name
        self.host, self.port = host, port
        self._clock = clock
        self._stale_after = stale_after
        self._server: asyncio.Server | None = None
        self._task: asyncio.Task[None] | None = None
        self._serving: set[asyncio.Task[None]] = set()
        self._pages: dict[str, _Page] = {}
        self._number = 0
        self._shown = event("show", _drawn(0, Picture("")))
        self._heard = -math.inf
        self._arrivals = Arrivals()
        self._taken = asyncio.Event()
        self._error = ""

    @property
    def url(self) -> str:
        """The address of the page, as a tablet opens it."""
        return f"http://{_reached_at(self.host)}:{self.port}/"

    @property
    def pages(self) -> int:
        """How many pages are open and answer."""
        since = self._clock() - GONE_SECONDS
        return sum(page.heard > since for page in self._pages.values())

    @property
    def why(self) -> str:
        """What is wrong with it, in one sentence; "" if nothing is."""
        if self._error or self._server is None:
            return self._error or f"{self.name} does not run."
        if self._heard == -math.inf:
            return f"{self.name}: no tablet has opened {self.url} yet."
        return "" if self.pages else f"{self.name}: no tablet shows {self.url} any more."

    async def start(self) -> None:
        """Begin to listen; where the port is in use, as soon as it is free."""
        if self._task is not None or await self._listen():
            return
        self._task = asyncio.create_task(self._listen_again(), name=f"screen {self.name}")

    async def close(self) -> None:
        """End for good; pages say that the link is lost."""
        tasks = {*self._serving, *([self._task] if self._task else [])}
        self._task = None
        server, self._server = self._server, None
        if server is not None:
            server.close()
        for task in tasks:
            task.cancel()
        if tasks:
            await asyncio.wait(tasks)

    async def show(self, picture: Picture) -> None:
        """Show something, until the next; where no page is open, whoever opens one sees it.

        Raises:
            DeviceError: a page is open, and none has drawn it within a second.
        """
        self._number += 1
        mine = self._number
        self._shown = event("show", _drawn(mine, picture))
        for page in self._pages.values():
            page.changed.set()
        if not self.pages:
            return
        try:
            async with asyncio.timeout(SHOW_SECONDS):
                while not any(page.seen >= mine for page in self._pages.values()):
                    self._taken.clear()
                    await self._taken.wait()
        except TimeoutError:
            raise DeviceError(f"{self.name}: no tablet has shown it within a second.") from None

    def reading(self) -> Reading:
        """Return its state, and the age of the newest answer of a page.

        WARN: no page was ever open; STALE: none answers any more; ERROR: its port is in use.
        """
        now = self._clock()
        age, rate = min(max(0.0, now - self._heard), NEVER), self._arrivals.rate(now)
        if self._error:
            return Reading(self.name, age, ERROR)
        if self._heard == -math.inf:
            return Reading(self.name, age, WARN)
        return Reading(self.name, age, OK if age <= self._stale_after else STALE, rate=rate)

    async def _listen(self) -> bool:
        try:
            self._server = await asyncio.start_server(
                self._serve, self.host, self.port, limit=LONGEST_HEAD
            )
        except (OSError, OverflowError, UnicodeError) as error:  # or no such host or port can be
            said = plain(getattr(error, "strerror", None) or str(error))
            self._error = f"{self.name} cannot listen at {self.host}:{self.port} ({said})."
            return False
        self.port = self._server.sockets[0].getsockname()[1]
        self._error = ""
        return True

    async def _listen_again(self) -> None:
        while True:
            await asyncio.sleep(AGAIN_SECONDS)
            if await self._listen():
                return

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = asyncio.current_task()
        assert task is not None  # noqa: S101
        self._serving.add(task)
        try:
            while request := await read_request(reader):
                if request.path == "/events" and request.method == "GET":
                    await self._tell(request, writer)
                    return
                writer.write(self._answer(request))
                async with asyncio.timeout(SEND_SECONDS):
                    await writer.drain()
                if not request.stays:
                    return
        except BadRequest:
            writer.write(response(400, b"No request that is answered here.\n"))
        except (OSError, TimeoutError, asyncio.CancelledError):
            pass  # it went, or we do
        finally:
            self._serving.discard(task)
            with contextlib.suppress(OSError):
                writer.close()

    def _answer(self, request: Request) -> bytes:
        if request.path == "/seen":
            if request.method != "POST":
                return response(405)
            return response(204 if self._was_seen(request) else 404)
        if request.method not in ("GET", "HEAD"):
            return response(405)
        if request.path not in FILES:
            return response(404, b"There is only one page here: /\n")
        file, kind = FILES[request.path]
        whole = response(200, (Path(__file__).parent / file).read_bytes(), kind)
        return whole if request.method == "GET" else whole.partition(b"\r\n\r\n")[0] + b"\r\n\r\n"

    def _was_seen(self, request: Request) -> bool:
        """Take a page's answer; return whether the page is one that is told things."""
        page = self._pages.get(request.query.get("page", ""))
        number = request.query.get("number", "")
        if page is None or not (number.isdecimal() and len(number) < 10):
            return False
        page.heard = self._heard = self._clock()
        self._arrivals.count(self._heard)
        page.seen = max(page.seen, min(int(number), self._number))
        self._taken.set()
        return True

    async def _tell(self, request: Request, writer: asyncio.StreamWriter) -> None:
        """Send events to a page until it has gone."""
        name = request.query.get("page", "")
        if not (0 < len(name) <= 40) or (
            len(self._pages) >= MOST_PAGES and name not in self._pages
        ):
            writer.write(response(503, b"There are too many pages open.\n"))
            return
        page = _Page()
        if (before := self._pages.get(name)) is not None:  # the same page, after a lost link
            page.heard, before.over = before.heard, True
            before.changed.set()
        self._pages[name] = page
        writer.write(stream_head())
        sent = -1
        try:
            while not page.over:
                page.changed.clear()
                writer.write(self._shown if sent != self._number else event("alive", str(sent)))
                sent = self._number
                async with asyncio.timeout(SEND_SECONDS):
                    await writer.drain()
                with contextlib.suppress(TimeoutError):
                    await asyncio.wait_for(page.changed.wait(), ALIVE_SECONDS)
        finally:
            if self._pages.get(name) is page:
                del self._pages[name]


def _reached_at(host: str) -> str:
    """Return by which address others reach what listens at all of this machine's."""
    if host not in ("", "0.0.0.0"):  # noqa: S104
        return host
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            # Nothing is sent: it only has the system choose the way out (RFC 5737).
            probe.connect(("192.0.2.1", 9))
            return str(probe.getsockname()[0])
        except OSError:
            return "127.0.0.1"


def _drawn(number: int, picture: Picture) -> str:
    """Write a picture as the page is told of it: JSON, in one line, of plain ASCII."""
    return json.dumps({"n": number, **picture._asdict()})
