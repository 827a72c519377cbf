"""Distinguishes keys meant for a question from keys typed before it was visible.

A key has the time at which it was read from the terminal. It answers a dialog only if the dialog
was visible a moment before: after the terminal's reply to a query sent behind it, or without a
reply after it was drawn. Queued keys and keys typed blindly are dropped.
"""

from __future__ import annotations

from collections.abc import Callable
from time import monotonic

from textual import events
from textual.widget import Widget

from tangy_tui.ui.round_trip import RoundTrip
from tangy_tui.ui.writer import HeldWrites

HELD_SECONDS = 0.2
"""The longest time for which a frame waits for the query behind it."""

SETTLE_SECONDS = 0.2
"""The shortest time in which a person can notice a question."""

Clock = Callable[[], float]
"""Returns seconds on the scale of Textual's key times, `time.monotonic`."""


def clock_of(app: object) -> Clock:
    """Return the clock of Tangy's application, or Textual's clock for any other."""
    clock: Clock = getattr(app, "clock", monotonic)
    return clock


def round_trip_of(app: object) -> RoundTrip | None:
    """Return the object that queries the terminal; None without a terminal."""
    return getattr(app, "round_trip", None)


def yes_key_of(app: object) -> str:
    """Return the key for yes to a question that starts now: "y" or a digit."""
    trip = round_trip_of(app)
    return "y" if trip is None else trip.yes


def draws_digit(app: object) -> bool:
    """Return whether the yes to a question that starts now would be a digit."""
    trip = round_trip_of(app)
    return trip is not None and trip.needs_digit


class FreshKeys:
    """Tells for each key whether it was typed after its dialog was visible."""

    def __init__(self) -> None:
        self._from: float | None = None
        self._trip: RoundTrip | None = None

    def watch(self, dialog: Widget, clock: Clock | None = None) -> None:
        """Accept keys once a dialog is visible that is being laid out now.

        Args:
            dialog: the dialog.
            clock: returns s, on the scale of `time.monotonic` (default: the app's clock).
        """
        trip, app = round_trip_of(dialog.app), dialog.app
        frames: HeldWrites | None = getattr(app, "frames", None)
        if frames is not None and trip is not None and trip.answers and not trip.needs_digit:
            frames.hold()  # send the question and the query together
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
        """Note that the dialog was drawn now, if no terminal can prove that it is visible."""
        if self._from is None:
            self._from = clock() + SETTLE_SECONDS

    @property
    def seen(self) -> bool:
        """Whether the dialog is visible, or drawn if nothing else can be known."""
        return self._from is not None

    def take(self, event: events.Key) -> bool:
        """Stop a key from bubbling, unless it asks for help; return whether it may answer."""
        if event.key != "question_mark":
            event.stop()
        return self.counts(event)

    def counts(self, event: events.Key | events.Paste) -> bool:
        """Return whether a key or a paste came after the dialog was visible."""
        if self._from is not None:
            return event.time >= self._from
        if self._trip is not None:
            self._trip.ask_again(self._answered)  # the reply may have been lost
        return False
