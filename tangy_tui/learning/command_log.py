"""The log lines of a teacher's commands: a command, its question and its answer share one id."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from tangy_profiles.process_log import command_id, serving
from tangy_tui.learning.teaching_events import Executed, TeacherCommand, TeachingEvent
from tangy_tui.learning.verification import Asked, Offered, Reply

_LOG = logging.getLogger("tangy_tui.learning.teaching_session")


class CommandLog:
    """Logs commands and what followed from them."""

    def __init__(self) -> None:
        """Begin without an open question."""
        self._asked: str | None = None

    @contextmanager
    def carrying_out(self, command: TeacherCommand) -> Iterator[None]:
        """Carry out a command in this context; a reply has the id of what it answers."""
        with serving(self._asked if isinstance(command, Reply) else None):
            self._asked = None
            yield

    def followed(self, command: TeacherCommand, events: Sequence[TeachingEvent]) -> None:
        """Log the events of the current command."""
        if any(isinstance(event, Asked | Offered) for event in events):
            self._asked = command_id()
        words = ", ".join(map(_words, events))
        _LOG.info("teaching: %s -> %s", type(command).__name__, words)


def _words(event: TeachingEvent) -> str:
    kind = type(event).__name__
    match event:
        case Executed():
            whom = event.step.target
            return f"{kind} {event.step.behaviour}{f' ({whom})' if whom else ''}"
        case Asked():
            return f"{kind} {event.behaviour}"
        case _:
            return kind
