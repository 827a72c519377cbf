"""The tour of a new teacher: a few stops, and at one of them a real command with its question."""

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
    PEOPLE = "people"
    COACH = "coach"


_ON = {
    TourStop.ROOM: TourStop.COMMAND,
    TourStop.STEP: TourStop.PEOPLE,
    TourStop.PEOPLE: TourStop.COACH,
    TourStop.COACH: None,
}
_BEFORE_THE_STEP = (TourStop.ROOM, TourStop.COMMAND, TourStop.QUESTION)


class Tour:
    """Steps through the stops: at the teacher's action, or at Enter where no action is needed.

    `at` is None when it has ended, or was skipped.
    """

    def __init__(self) -> None:
        self.at: TourStop | None = TourStop.ROOM

    @property
    def enter_goes_on(self) -> bool:
        """Whether Enter goes on from here; elsewhere a command or an answer does."""
        return self.at in _ON

    def go_on(self) -> None:
        """Go to the next stop, where nothing has to be done first."""
        if self.at is not None:
            self.at = _ON.get(self.at, self.at)

    def skip(self) -> None:
        """End it."""
        self.at = None

    def follow(self, events: Iterable[TeachingEvent]) -> bool:
        """Go on with what the teacher did; say whether that led to another stop."""
        before = self.at
        if before not in _BEFORE_THE_STEP:
            return False
        for event in events:
            if isinstance(event, Executed):
                self.at = TourStop.STEP
            elif isinstance(event, Asked | Offered):
                self.at = TourStop.QUESTION
            elif self.at is TourStop.QUESTION:
                self.at = TourStop.COMMAND  # it was answered with no
        return self.at is not before
