"""What is told of a demonstration, line by line."""

from __future__ import annotations

from tangy_tui.learning.teaching_events import (
    Begun,
    Executed,
    Finished,
    StepUndone,
    TeachingEvent,
)
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import Asked, NotUnderstood, Offered, Refused, Rejected
from tangy_tui.text.situations import step_words, verification_lines


def teaching_lines(event: TeachingEvent, teaching: TeachingSession) -> list[str]:
    """Put one event of a teaching session into lines."""
    match event:
        case Asked() | Offered() | NotUnderstood() | Refused() | Rejected():
            return verification_lines(event)
        case Executed(number, step, _, _, speech, _):
            return [
                f"{number}. {step_words(teaching.activity, step, teaching.name)}",
                f"   Tangy says: {speech}",
            ]
        case StepUndone(number, step):
            return [f"Step {number} is undone: {step.behaviour}."]
        case Begun(demonstration, resumed):
            if resumed:
                return [
                    f"Going on with {teaching.teacher}'s demonstration of "
                    f"{len(demonstration.steps)} steps (game {demonstration.seed})."
                ]
            return [f"A new demonstration by {teaching.teacher} (game {demonstration.seed})."]
        case Finished(demonstration):
            return [f"The game is over; {len(demonstration.steps)} steps were demonstrated."]
