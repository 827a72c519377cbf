"""Worker process of a camera, because reading a frame may block forever.

Run as `python -m tangy_hw.drivers.camera_child`; speaks JSON lines:

    {"source": {...}, "first": 17}               what to read (`CameraSource`), and the number
                                                 of its first frame
    {"alive": 9.2, "busy": "read", "for": 0.03}  heartbeat, a few times a second;
                                                 busy: "open", "read", or "" while it waits
    {"look": [...]}                              measures of a frame (`camera_look.Look`)
    {"lost": "it stopped sending"}               it cannot be read, and will be opened again
    {"over": "", "sound": true}                  end of the source; sound: without an error
    {"frame": 3, "after": 16}                    request for the newest frame above number 16
    {"frame": 4, "after": 16, "fit": [80, 45]}   scaled to fit into 80 x 45 pixels
    {"frame": 3, "seq": 18, "stamp": 9.1, "width": 1280, "height": 720, "bytes": 2764800}
                                                 answer, followed by these bytes of BGR
    {"failed": "That line is no JSON object."}   instead of any answer

It exits when its input closes. Output of C libraries goes to standard error.
"""

from __future__ import annotations

import logging
import os
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from threading import Condition, Thread
from typing import TYPE_CHECKING, Any

from tangy_hw.drivers.camera_grabber import Grabber, NoFrame, StreamEnded, make_grabber
from tangy_hw.drivers.camera_source import CameraSource
from tangy_profiles.codec import InvalidValue, decode
from tangy_profiles.process_log import log_to_stderr
from tangy_profiles.worker_lines import AnswerWriter, requests

if TYPE_CHECKING:
    from tangy_hw.drivers.camera_look import Image

_LOG = logging.getLogger("tangy_hw.drivers.camera_child")  # also if run as a script

ALIVE_SECONDS = 0.25  # between two heartbeats
AGAIN_SECONDS = 0.3  # until a lost source is opened again
LOOK_SECONDS = 0.09  # between two measured frames
PIPE_BYTES = 1 << 20


class Child:
    """Reads frames on one thread, takes requests on another, and sends heartbeats on a third."""

    def __init__(self, answers: AnswerWriter) -> None:
        self._answers = answers
        self._begun = False
        self._changed = Condition()
        self._newest: tuple[int, float, Image] | None = None
        # request id -> the number above which it asks, and the size to fit
        self._asked: dict[int, tuple[int, Sequence[int] | None]] = {}
        self._taken = True  # whether the newest frame was requested
        self._over = False
        self._busy = ("", time.monotonic())

    def write(self, answer: dict[str, Any], image: Image | None = None) -> None:
        """Send an answer, with the image (BGR) that belongs to it."""
        if image is None:
            self._answers.write(answer)
        else:
            self._answers.write(answer, image.data if image.flags.c_contiguous else image.tobytes())

    def beat(self) -> None:
        """Send heartbeats forever, each with the current task."""
        while True:
            busy, since = self._busy
            now = time.monotonic()
            self.write({"alive": round(now, 3), "busy": busy, "for": round(now - since, 3)})
            time.sleep(ALIVE_SECONDS)

    def take(self, request: Any) -> None:
        """Handle the source, or a request for a frame."""
        match request:
            case {"source": dict(source), "first": int(first)} if not self._begun:
                try:
                    reads = decode(CameraSource, source)
                except InvalidValue as why:
                    self._answers.refuse(f"That is no source: it {why}.")
                    return
                self._begun = True
                _LOG.info("opens a camera")
                Thread(target=self._reads, args=(reads, first), daemon=True).start()
            case {"frame": int(id), "after": int(after)} if _is_size(request.get("fit")):
                with self._changed:
                    self._asked[id] = after, request.get("fit")
                self._answer()
            case _:
                self._answers.refuse("A line must hold source and first, once, or frame and after.")

    def _answer(self) -> None:
        """Send the newest frame to all requests that it satisfies."""
        with self._changed:
            newest = self._newest
            if newest is None:
                return
            met = {id: fit for id, (after, fit) in self._asked.items() if newest[0] > after}
            for id in met:
                del self._asked[id]
        seq, stamp, whole = newest
        for id, fit in met.items():
            image = whole if fit is None else fitted(whole, *fit)
            height, width = image.shape[:2]
            self.write(
                {"frame": id, "seq": seq, "stamp": stamp, "width": width, "height": height,
                 "bytes": image.nbytes},
                image,
            )  # fmt: skip
        if met:
            with self._changed:
                self._taken = True
                self._changed.notify_all()

    def _reads(self, source: CameraSource, first: int) -> None:
        try:
            self.grab(source, first)
        except BaseException:
            import traceback

            traceback.print_exc()
            sys.stderr.flush()
            os._exit(1)  # the program starts a new process

    def grab(self, source: CameraSource, first: int) -> None:
        """Read frames until there are no more."""
        import cv2

        from tangy_hw.drivers.camera_look import measure

        cv2.setNumThreads(1)
        # Not earlier: while a library loads, no other thread gets to run.
        Thread(target=self.beat, daemon=True).start()
        grabber = make_grabber(source)
        seq, measured, due = first, 0.0, 0.0
        opened = False
        while True:
            try:
                if not opened:
                    self._do("open")
                    grabber.open()
                    opened, due = True, time.monotonic()
                self._do("read")
                image = grabber.read()
                stamp = time.monotonic()
                self._do("")
            except NoFrame as why:
                self._do("")
                opened = False
                grabber.close()
                self.write({"lost": str(why)})
                time.sleep(AGAIN_SECONDS)
                continue
            except StreamEnded as why:
                if source.loop and not str(why):
                    opened = False
                    continue
                self._finish(str(why))
                return
            if source.each or stamp - measured >= LOOK_SECONDS:
                measured = stamp
                self.write({"look": measure(image, seq, stamp)})
            with self._changed:
                self._newest, self._taken = (seq, stamp, image), False
            seq += 1
            self._answer()
            due = self._wait(source, grabber, due)

    def _wait(self, source: CameraSource, grabber: Grabber, due: float) -> float:
        """Wait until the next frame is due, and return that time (monotonic, s)."""
        if source.each:
            with self._changed:
                self._changed.wait_for(lambda: self._taken)
            return 0.0
        if source.live or not grabber.rate:
            return 0.0
        due = max(due + 1 / grabber.rate, time.monotonic() - 1)
        time.sleep(max(0.0, due - time.monotonic()))
        return due

    def _finish(self, why: str) -> None:
        self._do("")
        self.write({"over": why, "sound": not why})

    def _do(self, what: str) -> None:
        self._busy = (what, time.monotonic())


def _is_size(fit: Any) -> bool:
    """Return whether a request's size is valid; None leaves the frame unscaled."""
    match fit:
        case None:
            return True
        case [int(columns), int(rows)]:
            return columns > 0 and rows > 0
    return False


def fitted(image: Image, columns: int, rows: int) -> Image:
    """Return an image (BGR) scaled to fit, with its aspect ratio."""
    import cv2

    height, width = image.shape[:2]
    by = min(columns / width, rows / height)
    size = max(1, round(width * by)), max(1, round(height * by))
    how = cv2.INTER_AREA if by < 1 else cv2.INTER_NEAREST
    made: Image = cv2.resize(image, size, interpolation=how).astype("uint8", copy=False)
    return made


def main() -> None:
    """Read the source named on standard input, until that closes."""
    log_to_stderr()
    answers = AnswerWriter()
    with suppress(ImportError, AttributeError, OSError):
        import fcntl

        fcntl.fcntl(answers, fcntl.F_SETPIPE_SZ, PIPE_BYTES)
    child = Child(answers)
    for request in requests(answers.refuse):
        child.take(request)
    os._exit(0)  # a thread that hangs in a driver must not keep this process alive


if __name__ == "__main__":
    main()
