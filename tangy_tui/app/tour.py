"""The tour for a new teacher: a few stops, one of them with a real command and its question."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum

from tangy_tui.learning.teaching_events import Executed, StepUndone, TeachingEvent
from tangy_tui.learning.verification import Asked, Offered


class TourStop(Enum):
    """The stops of the tour."""

    ROOM = "room"
    COMMAND = "command"
    QUESTION = "question"
    STEP = "step"
    UNDONE = "undone"
    PEOPLE = "people"
    COACH = "coach"


_ON = {
    TourStop.ROOM: TourStop.COMMAND,
    TourStop.STEP: TourStop.PEOPLE,
    TourStop.UNDONE: TourStop.PEOPLE,
    TourStop.PEOPLE: TourStop.COACH,
    TourStop.COACH: None,
}
_BEFORE_THE_STEP = (TourStop.ROOM, TourStop.COMMAND, TourStop.QUESTION)


class Tour:
    """Moves from stop to stop: at the teacher's action, or at Enter if no action is needed.

    `at` is None when the tour has ended, or was skipped.
    """

    def __init__(self) -> None:
        self.at: TourStop | None = TourStop.ROOM

    @property
    def enter_goes_on(self) -> bool:
        """Whether Enter leads to the next stop; otherwise a command or an answer does."""
        return self.at in _ON

    def go_on(self) -> None:
        """Go to the next stop, if no action is needed first."""
        if self.at is not None:
            self.at = _ON.get(self.at, self.at)

    def skip(self) -> None:
        """End the tour."""
        self.at = None

    def follow(self, events: Iterable[TeachingEvent]) -> bool:
        """Follow the teacher's actions; return whether the tour is at another stop now."""
        before = self.at
        if before is None:
            return False
        for event in events:
            if self.at not in _BEFORE_THE_STEP:
                if isinstance(event, Executed):  # a teacher who teaches on needs no Enter
                    self.go_on()
                elif isinstance(event, StepUndone) and self.at is TourStop.STEP:
                    self.at = TourStop.UNDONE
            elif isinstance(event, Executed):
                self.at = TourStop.STEP
            elif isinstance(event, Asked | Offered):
                self.at = TourStop.QUESTION
            elif self.at is TourStop.QUESTION:
                self.at = TourStop.COMMAND  # the answer was no
        return self.at is not before
