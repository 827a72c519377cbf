"""A camera: its newest frame, and its state.

A child process reads the camera (see `camera_child`, which documents the protocol). This module
starts it, sends it requests, watches it, and kills and restarts it when it hangs or has died.
"""

from __future__ import annotations

import asyncio
import sys
import time
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tangy_hw.drivers.camera_look import Look
from tangy_hw.drivers.camera_source import CameraError, CameraSource
from tangy_hw.drivers.camera_state import USUAL, CameraLimits, CameraWatch, Sight, State
from tangy_hw.worker_process import WorkerError, WorkerProcess
from tangy_profiles.codec import encode
from tangy_profiles.health import Reading

if TYPE_CHECKING:
    from tangy_hw.drivers.camera_look import Image

CHILD = (sys.executable, "-P", "-m", "tangy_hw.drivers.camera_child")
SILENT_SECONDS = 3.0  # without a heartbeat: the process hangs
START_SECONDS = 20.0  # until the first heartbeat: .1 s on an idle machine
READ_SECONDS = 2.5  # for one frame; a stream gives up by itself before
OPEN_SECONDS = 10.0  # some cameras take 4 s to open
AGAIN_SECONDS = 0.2  # until a dead process is restarted
TICK_SECONDS = 0.1  # between two checks of the state


@dataclass(frozen=True, slots=True)
class Frame:
    """A frame: its number, time of arrival (monotonic, s), and BGR pixels, row by row.

    `sight` is the state of the camera at that time.
    """

    seq: int
    stamp: float
    width: int
    height: int
    pixels: bytes
    sight: Sight

    def image(self) -> Image:
        """Return it as a read-only OpenCV image, (rows, columns, 3) in BGR."""
        import numpy as np

        return np.frombuffer(self.pixels, np.uint8).reshape(self.height, self.width, 3)


def _nobody(*_: object) -> None:
    """Ignore the event."""


class Camera:
    """Frames of one source: `async for frame in camera` yields the newest each time.

    Use it with `async with`, or call `start` and `close`.
    """

    def __init__(
        self,
        source: CameraSource,
        *,
        device: str = "camera",
        log: Path | None = None,
        limits: CameraLimits = USUAL,
    ) -> None:
        """Prepare a camera; `start` opens it.

        Args:
            source: where its frames come from.
            device: its name in the robot's profile.
            log: file for the messages of its process; None: they are dropped.
            limits: thresholds of its states.
        """
        self.source = source
        self.changed: Callable[[Sight], None] = _nobody
        """Called when the state has changed."""
        self._device = device
        self._log = log
        self._limits = limits
        self._watch = self._new_watch()
        self._shown: State = "OPENING"
        self._worker: WorkerProcess | None = None
        self._began = 0.0  # when the worker was started
        self._tasks: list[asyncio.Task[None]] = []
        self._asked: dict[int, tuple[dict[str, Any], asyncio.Future[Frame | None]]] = {}
        self._requests = 0
        self._next = 0  # number of the next frame
        self._last = -1  # number of the last returned frame
        self._error = ""
        self._closing = False

    async def __aenter__(self) -> Camera:
        await self.start()
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.close()

    @property
    def name(self) -> str:
        """Name of its source."""
        return self.source.name

    @property
    def pid(self) -> int | None:
        """Id of the process that reads it, if one runs."""
        return None if self._worker is None else self._worker.pid

    @property
    def sight(self) -> Sight:
        """Current state, and the evidence for it."""
        return self._watch.at(time.monotonic())

    @property
    def over(self) -> bool:
        """Whether the stream has ended."""
        return self._watch.over

    def reading(self) -> Reading:
        """Return its reading for the diagnosis."""
        return self.sight.reading(self._device)

    async def start(self) -> None:
        """Start reading; a camera that cannot be read is a state, not an error."""
        self._closing = False
        self._watch = self._new_watch()
        self._tasks = [asyncio.create_task(self._run()), asyncio.create_task(self._tick())]

    async def close(self) -> None:
        """Kill its process; pending requests for a frame return None."""
        self._closing = True
        for task in self._tasks:
            task.cancel()
        if self._tasks:
            await asyncio.wait(self._tasks)
        self._answer_all()

    async def frame(
        self,
        *,
        after: int | None = None,
        wait: float | None = None,
        fit: tuple[int, int] | None = None,
    ) -> Frame | None:
        """Return the newest frame whose number is higher than that of the last returned one.

        Args:
            after: return a frame with a higher number than this instead.
            wait: timeout in s; None: no timeout.
            fit: scale the frame to fit into this width and height in pixels.

        Returns:
            None if no frame came in time, or the stream has ended.

        Raises:
            CameraError: a file or folder could not be read.
        """
        if not self.over and not self._closing:
            self._requests += 1
            id = self._requests
            asked: asyncio.Future[Frame | None] = asyncio.get_running_loop().create_future()
            request: dict[str, Any] = {"frame": id, "after": self._last if after is None else after}
            if fit is not None:
                request["fit"] = fit
            self._asked[id] = request, asked
            self._send(request)
            try:
                async with asyncio.timeout(wait):
                    frame = await asked
            except TimeoutError:
                frame = None
            finally:
                self._asked.pop(id, None)
            if frame is not None:
                self._last = max(self._last, frame.seq)
                return frame
        if self._error:
            raise CameraError(self._error)
        return None

    def __aiter__(self) -> AsyncIterator[Frame]:
        return self._frames()

    async def _frames(self) -> AsyncIterator[Frame]:
        while (frame := await self.frame()) is not None:
            yield frame

    def _new_watch(self) -> CameraWatch:
        source = self.source
        interval = 1 / source.rate if source.rate else 0.0
        return CameraWatch(time.monotonic(), self._limits, each=source.each, interval=interval)

    async def _tick(self) -> None:
        """Report every change of state, also those caused by silence."""
        while True:
            self._look_after()
            self._tell()
            await asyncio.sleep(TICK_SECONDS)

    def _look_after(self) -> None:
        """Kill a process that hangs."""
        worker = self._worker
        if worker is None or worker.how:
            return
        patience = SILENT_SECONDS if worker.heard else START_SECONDS
        if time.monotonic() - (worker.heard or self._began) > patience:
            self._lose("its process does not answer")

    def _tell(self) -> None:
        sight = self.sight
        if sight.state != self._shown:
            self._shown = sight.state
            self.changed(sight)

    async def _run(self) -> None:
        """Keep a worker process running until the source has ended."""
        while not self.over:
            try:
                worker = self._begin()
            except WorkerError as error:
                self._watch.lost(f"its process cannot be started ({error})")
            else:
                try:
                    await asyncio.wait({asyncio.wrap_future(worker.over)})
                finally:
                    self._drop()
                    await worker.stopped(0)
            if not self.over:
                await asyncio.sleep(AGAIN_SECONDS)
        self._answer_all()
        self._tell()

    def _begin(self) -> WorkerProcess:
        worker = self._worker = WorkerProcess(
            CHILD,
            hear=self._take,
            ended=lambda how: self._lose(f"its process ended ({how})"),
            log=self._log,
            loop=asyncio.get_running_loop(),
        )
        self._began = time.monotonic()
        worker.tell({"source": encode(self.source), "first": self._next})
        for request, _ in self._asked.values():
            worker.tell(request)
        return worker

    def _lose(self, why: str) -> None:
        """Record a failed process, and kill it; `_run` starts another."""
        if self._drop():  # otherwise the failure is known already
            self._watch.lost(why)

    def _drop(self) -> bool:
        worker, self._worker = self._worker, None
        if worker is not None:
            worker.kill()
        return worker is not None

    def _take(self, said: dict[str, Any], pixels: bytes) -> None:
        if self._worker is None:
            return  # it was dropped
        match said:
            case {"alive": _, "busy": busy, "for": seconds}:
                if seconds > {"read": READ_SECONDS, "open": OPEN_SECONDS}.get(busy, seconds):
                    self._lose("it hangs")
            case {"look": look}:
                seen = Look(*look)
                self._next = max(self._next, seen.seq + 1)
                self._watch.saw(seen)
                self._tell()
            case {"frame": id, "seq": seq, "stamp": stamp, "width": width, "height": height}:
                self._next = max(self._next, seq + 1)
                _, asked = self._asked.get(id, (None, None))
                if asked is not None and not asked.done():
                    asked.set_result(Frame(seq, stamp, width, height, pixels, self.sight))
            case {"lost": str(why)}:
                self._watch.lost(why)
            case {"over": str(why)}:
                self._error = f"{self.name}: {why}." if why else ""
                self._watch.ended(self._error or "That was the last picture.")
                self._drop()

    def _send(self, request: dict[str, Any]) -> None:
        if self._worker is not None:  # otherwise it is sent when the process runs
            self._worker.tell(request)

    def _answer_all(self) -> None:
        for _, asked in self._asked.values():
            if not asked.done():
                asked.set_result(None)
