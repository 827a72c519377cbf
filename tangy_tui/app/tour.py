"""The tour of a new teacher: a few captions, and one real command with its question."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum

from tangy_tui.learning.teaching_events import Executed, TeachingEvent
from tangy_tui.learning.verification import Asked, Offered


class TourStop(Enum):
    """Where the tour is."""

    ROOM = "room"
    COMMAND = "command"
    QUESTION = "question"
    STEP = "step"
    COACH = "coach"


_ON = {
    TourStop.ROOM: TourStop.COMMAND,
    TourStop.STEP: TourStop.COACH,
    TourStop.COACH: None,
}


class Tour:
    """Goes from stop to stop: by what the teacher does, and where nothing is to be done, by Enter.

    `at` is None when it has ended, or was skipped.
    """

    def __init__(self) -> None:
        self.at: TourStop | None = TourStop.ROOM

    def go_on(self) -> None:
        """Go to the next stop, where nothing has to be done first."""
        if self.at is not None:
            self.at = _ON.get(self.at, self.at)

    def skip(self) -> None:
        """End it."""
        self.at = None

    def follow(self, events: Iterable[TeachingEvent]) -> None:
        """Go on with what the teacher did."""
        if self.at not in (TourStop.ROOM, TourStop.COMMAND, TourStop.QUESTION):
            return
        for event in events:
            if isinstance(event, Executed):
                self.at = TourStop.STEP
            elif isinstance(event, Asked | Offered):
                self.at = TourStop.QUESTION
            elif self.at is TourStop.QUESTION:
                self.at = TourStop.COMMAND  # it was answered with no
