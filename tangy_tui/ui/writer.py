"""Writing to a terminal that may go away while we write to it."""

from __future__ import annotations

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


def outlive_terminal() -> None:
    """Let every program that is started from here on write with an `OutlivingWriter`."""
    linux_driver.WriterThread = OutlivingWriter  # type: ignore[attr-defined]
