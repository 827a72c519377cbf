"""Logging demonstrations as a teaching session does, with chosen answers."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime, timedelta

from tangy_profiles.codec import encode
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.store import Store
from tangy_profiles.teaching_records import (
    DemonstrationBegun,
    DemonstrationFinished,
    DemonstrationStep,
)
from tests.support.append_body import append_body


def log_demonstration(store: Store, shown: Demonstration) -> None:
    """Log a demonstration."""
    with store.transaction():
        append_body(
            store,
            DemonstrationBegun,
            {
                "demonstration": shown.id,
                "activity": shown.activity,
                "teacher": shown.teacher,
                "seed": shown.seed,
                "people": list(shown.people),
                "origin": shown.origin,
                "of": list(shown.of),
            },
        )
        for step in shown.steps:
            append_body(store, DemonstrationStep, {"demonstration": shown.id, **encode(step)})
        if shown.finished:
            append_body(store, DemonstrationFinished, {"demonstration": shown.id})


def answering(shown: Demonstration, user_state: str, behaviour: str) -> Demonstration:
    """Return a demonstration with another answer in every situation with this user state."""
    steps = tuple(
        replace(step, behaviour=behaviour)
        if step.state.situation.user_state == user_state
        else step
        for step in shown.steps
    )
    return replace(shown, steps=steps)


class SlowClock:
    """A clock that advances a second at each reading, so that pictures stay the same."""

    def __init__(self) -> None:
        self._time = datetime(2026, 3, 2, 9, 0, tzinfo=UTC)

    def __call__(self) -> datetime:
        """Return the time."""
        self._time += timedelta(seconds=1)
        return self._time
