"""Telling keys that were meant for a question from keys that were typed before it was seen.

A key is stamped when it is read from the terminal. It answers a dialog only if that was a moment
after the dialog was seen: after the terminal has answered what was written behind it, or, where
nothing answers, after it was written. What was queued, or typed blindly, is dropped.
"""

from __future__ import annotations

from collections.abc import Callable
from time import monotonic

from textual import events
from textual.widget import Widget

from tangy_tui.ui.round_trip import RoundTrip
from tangy_tui.ui.writer import HeldWrites

HELD_SECONDS = 0.2
"""The longest that a frame waits for what asks the terminal behind it."""

SETTLE_SECONDS = 0.2
"""How long a person needs at the least to see that there is a question."""

Clock = Callable[[], float]
"""Gives seconds on the scale on which Textual stamps keys, `time.monotonic`."""


def clock_of(app: object) -> Clock:
    """Return the clock of Tangy's app; of any other app, the one that Textual stamps keys by."""
    clock: Clock = getattr(app, "clock", monotonic)
    return clock


def round_trip_of(app: object) -> RoundTrip | None:
    """Return what asks the terminal of Tangy's app; None where there is no terminal."""
    return getattr(app, "round_trip", None)


def yes_key_of(app: object) -> str:
    """Return the key that says yes to a question that begins now: "y" or a digit."""
    trip = round_trip_of(app)
    return "y" if trip is None else trip.yes


def draws_digit(app: object) -> bool:
    """Say whether the yes of a question that begins now would be a digit."""
    trip = round_trip_of(app)
    return trip is not None and trip.needs_digit


class FreshKeys:
    """Says of each key whether it was typed after its dialog was seen."""

    def __init__(self) -> None:
        self._from: float | None = None
        self._trip: RoundTrip | None = None

    def watch(self, dialog: Widget, clock: Clock | None = None) -> None:
        """Let keys count from when a dialog is seen, that is being laid out now.

        Args:
            dialog: what is laid out.
            clock: s, on the scale of `time.monotonic` (default: the app's).
        """
        trip, app = round_trip_of(dialog.app), dialog.app
        frames: HeldWrites | None = getattr(app, "frames", None)
        if frames is not None and trip is not None and trip.answers and not trip.needs_digit:
            frames.hold()  # what asks the terminal is to travel with what it asks about
            app.set_timer(HELD_SECONDS, frames.release)
        dialog.call_after_refresh(self._drawn, dialog, clock or clock_of(app))

    def _drawn(self, dialog: Widget, clock: Clock) -> None:
        trip = round_trip_of(dialog.app)
        if trip is None or not trip.answers or trip.needs_digit:
            self.painted(clock)
        else:
            self._trip = trip
            trip.ask(self._answered)
        frames: HeldWrites | None = getattr(dialog.app, "frames", None)
        if frames is not None:
            frames.release()

    def _answered(self, time: float) -> None:
        if self._from is None:
            self._from = time

    def painted(self, clock: Clock) -> None:
        """Note that the dialog has now been painted, where no terminal tells that it was seen."""
        if self._from is None:
            self._from = clock() + SETTLE_SECONDS

    @property
    def seen(self) -> bool:
        """Whether the dialog has been seen, or painted where nothing more can be known."""
        return self._from is not None

    def take(self, event: events.Key) -> bool:
        """Keep a key from going further, unless it asks for help; say whether it may answer."""
        if event.key != "question_mark":
            event.stop()
        return self.counts(event)

    def counts(self, event: events.Key | events.Paste) -> bool:
        """Say whether a key or a paste came after the dialog was seen."""
        if self._from is not None:
            return event.time >= self._from
        if self._trip is not None:
            self._trip.ask_again(self._answered)  # the terminal's answer may have been lost
        return False
