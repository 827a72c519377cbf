"""Writing to a terminal that may go away while we write to it."""

from __future__ import annotations

from collections.abc import Callable

from textual.driver import Driver
from textual.drivers import linux_driver
from textual.drivers._writer_thread import WriterThread


class OutlivingWriter(WriterThread):
    """Textual's writer, except that it outlives its terminal.

    When a window is closed, a write fails, Textual's writer ends, nobody empties its queue, and
    the program waits for ever to say goodbye: with the data folder still locked. This one goes on
    taking what is written, and drops it.
    """

    def run(self) -> None:
        """Write until told to stop; once the terminal is gone, only take."""
        try:
            super().run()
        except OSError:
            while self._queue.get() is not None:
                pass


class HeldWrites:
    """Keeps back what a driver writes, and writes it in one piece: it travels together then."""

    def __init__(self, find: Callable[[], Driver | None]) -> None:
        """Make it for the driver that is found when it is needed."""
        self._find = find
        self._driver: Driver | None = None
        self._parts: list[str] = []

    def hold(self) -> None:
        """Keep back what is written from now on."""
        driver = self._find()
        if self._driver is None and driver is not None:
            self._driver = driver
            vars(driver)["write"] = self._parts.append

    def release(self) -> None:
        """Write what was kept back."""
        driver, self._driver = self._driver, None
        if driver is not None:
            del vars(driver)["write"]
            if self._parts:
                driver.write("".join(self._parts))
                driver.flush()
                self._parts.clear()


def outlive_terminal() -> None:
    """Let every program that is started from here on write with an `OutlivingWriter`."""
    linux_driver.WriterThread = OutlivingWriter  # type: ignore[attr-defined]
