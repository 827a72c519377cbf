"""Telling keys that were meant for a question from keys that were typed before it was seen.

A key is stamped when it is read from the terminal. It answers a dialog only if that was a moment
after the dialog was painted; what was queued, or typed blindly, is dropped.
"""

from __future__ import annotations

from collections.abc import Callable
from time import monotonic

from textual import events

SETTLE_SECONDS = 0.2
"""How long a person needs at the least to see that there is a question."""

Clock = Callable[[], float]
"""Gives seconds on the scale on which Textual stamps keys, `time.monotonic`."""


def clock_of(app: object) -> Clock:
    """Return the clock of Tangy's app; of any other app, the one that Textual stamps keys by."""
    clock: Clock = getattr(app, "clock", monotonic)
    return clock


class FreshKeys:
    """Says of each key whether it was typed after its dialog was on the screen."""

    def __init__(self) -> None:
        self._from: float | None = None

    def painted(self, clock: Clock) -> None:
        """Note that the dialog has now been painted."""
        if self._from is None:
            self._from = clock() + SETTLE_SECONDS

    @property
    def seen(self) -> bool:
        """Whether the dialog has been painted."""
        return self._from is not None

    def take(self, event: events.Key) -> bool:
        """Keep a key from going further, unless it asks for help; say whether it may answer."""
        if event.key != "question_mark":
            event.stop()
        return self._from is not None and event.time >= self._from
