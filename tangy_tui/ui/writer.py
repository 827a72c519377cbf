"""Output to a terminal that may disappear during a write."""

from __future__ import annotations

from collections.abc import Callable

from textual.driver import Driver
from textual.drivers import linux_driver
from textual.drivers._writer_thread import WriterThread


class OutlivingWriter(WriterThread):
    """Textual's writer thread, except that it outlives its terminal.

    If a window is closed, a write fails and Textual's writer ends. Nobody empties its queue, and
    the program waits forever to exit, with the data folder still locked. This writer continues to
    empty the queue and drops the output.
    """

    def run(self) -> None:
        """Write until told to stop; without a terminal, only empty the queue."""
        try:
            super().run()
        except OSError:
            while self._queue.get() is not None:
                pass


class HeldWrites:
    """Holds back a driver's output and writes it at once, so that it arrives together."""

    def __init__(self, find: Callable[[], Driver | None]) -> None:
        """Hold back the output of the driver that `find` returns when needed."""
        self._find = find
        self._driver: Driver | None = None
        self._parts: list[str] = []

    def hold(self) -> None:
        """Hold back output from now on."""
        driver = self._find()
        if self._driver is None and driver is not None:
            self._driver = driver
            vars(driver)["write"] = self._parts.append

    def release(self) -> None:
        """Write the held output."""
        driver, self._driver = self._driver, None
        if driver is not None:
            del vars(driver)["write"]
            if self._parts:
                driver.write("".join(self._parts))
                driver.flush()
                self._parts.clear()


def outlive_terminal() -> None:
    """Let every application started from now on write with an `OutlivingWriter`."""
    linux_driver.WriterThread = OutlivingWriter  # type: ignore[attr-defined]
