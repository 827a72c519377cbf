"""The screen on the robot's chest: a web page on paired tablets, updated by server-sent events.

The page acknowledges each event that it has drawn, so Tangy knows what people really see. A child
process (`chest_child`) serves it: strangers can overload that process, and nothing else.
"""

from __future__ import annotations

import asyncio
import logging
import math
import socket
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from tangy_hw.device_protocols import DeviceError, Picture
from tangy_hw.drivers.chest_pairing import Pairing
from tangy_hw.rate_estimator import RateEstimator
from tangy_hw.worker_process import WorkerError, WorkerProcess
from tangy_profiles.health import ERROR, NEVER, OK, STALE, WARN, Reading
from tangy_profiles.reading import plain

_LOG = logging.getLogger(__name__)

CHILD = (sys.executable, "-P", "-m", "tangy_hw.drivers.chest_child")
PORT = 8765
SHOW_SECONDS = 1.0  # in which a page must draw a picture; it takes 10 to 50 ms
FILE_SECONDS = 10.0  # in which it must have loaded a picture's file
GONE_SECONDS = 3.0  # without an answer, after which a page counts as closed
START_SECONDS = 20.0  # until its process reports a port; .2 s on an idle machine
AGAIN_SECONDS = 1.0  # until a dead process is restarted
END_SECONDS = 1.0


@dataclass(eq=False, slots=True)
class _Page:
    """A page on a paired tablet: the number it has drawn, and when it last answered."""

    seen: int = -1
    heard: float = -math.inf


class WebChestScreen:
    """A web page; every paired tablet that opens its address shows the same picture.

    A page that opens later shows the current picture at once. It uses the machine's time even on an
    accelerated bench, because its pages do.
    """

    def __init__(
        self,
        host: str = "127.0.0.1",
        port: int = PORT,
        *,
        name: str = "screen",
        names: Sequence[str] = (),
        pairing: Pairing | None = None,
        clock: Callable[[], float] = time.monotonic,
        stale_after: float = 1.0,
    ) -> None:
        """Prepare the screen; `start` opens the port.

        Args:
            host: address to listen at: 127.0.0.1 for a screen of this machine, 0.0.0.0 for tablets.
            port: port to listen at; 0 for any free one.
            name: its name in the robot's profile.
            names: further host names of this machine that tablets may use.
            pairing: secrets that identify tablets; None: new ones.
            clock: returns the time in s.
            stale_after: s without an answer after which a page counts as stale.
        """
        self.name = name
        self.host, self.port = host, port
        self.pairing = Pairing() if pairing is None else pairing
        self._names = tuple(names)
        self._clock = clock
        self.stale_after = stale_after
        self._task: asyncio.Task[None] | None = None
        self._worker: WorkerProcess | None = None
        self._begun = asyncio.Event()
        self.windows: dict[str, _Page] = {}
        self._number = 0
        self._picture = Picture("")
        self.answered: tuple[str, ...] = ()
        """Keys of the open calls that were answered at it."""
        self._calls: dict[str, str] = {}
        self._heard = -math.inf
        self._arrivals = RateEstimator()
        self._taken = asyncio.Event()
        self._error = ""

    @property
    def url(self) -> str:
        """Address of the page for tablets."""
        return f"http://{_reached_at(self.host)}:{self.port}/"

    @property
    def code(self) -> str:
        """Code that pairs a tablet, as people read it."""
        return self.pairing.shown

    @property
    def pid(self) -> int | None:
        """Id of the process that serves the page, if one runs."""
        return None if self._worker is None else self._worker.pid

    @property
    def pages(self) -> int:
        """Number of pages that are open on paired tablets, and answer."""
        since = self._clock() - GONE_SECONDS
        return sum(page.heard > since for page in self.windows.values())

    @property
    def why(self) -> str:
        """Its problem, in one sentence; "" if there is none."""
        if self._error or self._task is None:
            return self._error or f"{self.name} does not run."
        if self._heard == -math.inf:
            code = f"the code that pairs it is {self.code}"
            return f"{self.name}: no tablet has opened {self.url} yet; {code}."
        return "" if self.pages else f"{self.name}: no tablet shows {self.url} any more."

    async def start(self) -> None:
        """Start to listen; if the port is in use, as soon as it is free."""
        if self._task is not None:
            return
        self._begun.clear()
        self._task = asyncio.create_task(self._run(), name=f"screen {self.name}")
        with suppress(TimeoutError):
            await asyncio.wait_for(self._begun.wait(), START_SECONDS)

    async def close(self) -> None:
        """Close for good; pages show that the connection is lost."""
        task, self._task = self._task, None
        if task is not None:
            task.cancel()
            await asyncio.wait([task])

    async def show(self, picture: Picture) -> None:
        """Show a picture until the next one, also on pages that open later.

        Raises:
            DeviceError: a page is open, and none has drawn it in time.
        """
        _LOG.info("shows a picture on the chest screen")
        self._number += 1
        mine = self._number
        self._picture = picture
        self._send_picture()
        if not self.pages:
            return
        try:
            async with asyncio.timeout(FILE_SECONDS if picture.file else SHOW_SECONDS):
                while not any(page.seen >= mine for page in self.windows.values()):
                    self._taken.clear()
                    await self._taken.wait()
        except TimeoutError:
            raise DeviceError(f"{self.name}: no tablet has shown it in time.") from None

    def offer(self, calls: Mapping[str, str]) -> None:
        """Show a button for each open call, and only for these: the called person's name by key."""
        self._calls = dict(calls)
        self.answered = tuple(key for key in self.answered if key in calls)
        self._send_calls()

    def reading(self) -> Reading:
        """Return its state, and the age of the newest answer of a page.

        WARN: no paired page was ever open; STALE: none answers now; ERROR: it cannot listen.
        """
        now = self._clock()
        age, rate = min(max(0.0, now - self._heard), NEVER), self._arrivals.rate(now)
        if self._error:
            return Reading(self.name, age, ERROR)
        if self._heard == -math.inf:
            return Reading(self.name, age, WARN)
        return Reading(self.name, age, OK if age <= self.stale_after else STALE, rate=rate)

    # ------------------------------------------------------------------------- its process

    async def _run(self) -> None:
        """Keep a process that serves the page running."""
        while True:
            try:
                worker = self._begin()
            except WorkerError as error:
                self._error = plain(f"{self.name}: its page cannot be served ({error}).")
            else:
                try:
                    await asyncio.wait({asyncio.wrap_future(worker.over)})
                    self._error = f"{self.name}: the process of its page has ended ({worker.how})."
                finally:
                    self._worker = None
                    self.windows.clear()
                    await worker.stopped(END_SECONDS)
            self._begun.set()
            await asyncio.sleep(AGAIN_SECONDS)

    def _begin(self) -> WorkerProcess:
        worker = self._worker = WorkerProcess(
            CHILD, hear=self._take, stderr=None, loop=asyncio.get_running_loop()
        )
        pairing = self.pairing.to_json()
        place = {"host": self.host, "port": self.port, "names": self._names}
        worker.tell({**place, "pairing": pairing})
        self._send_picture()
        self._send_calls()
        return worker

    def _take(self, said: dict[str, Any], _: bytes) -> None:
        match said:
            case {"port": int(port)}:
                self.port, self._error = port, ""
                self._begun.set()
            case {"error": str(why)}:
                place = f"{self.name} cannot listen at {self.host}:{self.port}"
                self._error = f"{place} ({plain(why)})."
                self._begun.set()
            case {"page": str(name), "seen": int(number)}:
                page = self.windows.setdefault(name, _Page())
                page.heard = self._heard = self._clock()
                page.seen = max(page.seen, min(number, self._number))
                self._arrivals.count(self._heard)
                self._taken.set()
            case {"gone": str(name)}:
                self.windows.pop(name, None)
            case {"answered": str(key)} if key in self._calls and key not in self.answered:
                _LOG.info("a call was answered at the chest screen: %s", key)
                self.answered += (key,)

    def _send_picture(self) -> None:
        if self._worker is not None:  # otherwise it is sent when the process runs
            self._worker.tell({"show": self._number, "picture": self._picture._asdict()})

    def _send_calls(self) -> None:
        if self._worker is not None:
            self._worker.tell({"calls": self._calls})


def _reached_at(host: str) -> str:
    """Return the address at which others reach a server that listens on all addresses."""
    if host not in ("", "0.0.0.0"):  # noqa: S104
        return host
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            # Nothing is sent: the system only chooses the outgoing interface (RFC 5737).
            probe.connect(("192.0.2.1", 9))
            return str(probe.getsockname()[0])
        except OSError:
            return "127.0.0.1"
