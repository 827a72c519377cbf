"""Demonstrations for tests: logged, without a situation or with another answer to it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from tangy_profiles.activity import Activity
from tangy_profiles.codec import encode
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.state import Situation
from tangy_profiles.store import Store
from tangy_profiles.teaching_records import (
    DemonstrationBegun,
    DemonstrationFinished,
    DemonstrationStep,
)
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policy import EXACT, ForestSettings, Policy, learn_policy
from tests.support.append_body import append_body


def keep(store: Store, demonstration: Demonstration) -> None:
    """Log a demonstration as a teaching session does."""
    name = {"demonstration": demonstration.id}
    append_body(
        store,
        DemonstrationBegun,
        {
            **name,
            "activity": demonstration.activity,
            "teacher": demonstration.teacher,
            "seed": demonstration.seed,
            "people": list(demonstration.people),
        },
    )
    for step in demonstration.steps:
        append_body(store, DemonstrationStep, {**name, **encode(step)})
    append_body(store, DemonstrationFinished, name)


def without(demonstration: Demonstration, *situations: Situation) -> Demonstration:
    """Return a demonstration without its steps in some situations."""
    steps = tuple(s for s in demonstration.steps if s.state.situation not in situations)
    return replace(demonstration, steps=steps)


def otherwise(
    demonstration: Demonstration, situation: Situation, behaviour: str, teacher: str
) -> Demonstration:
    """Return another teacher's copy of a demonstration, with another answer in a situation."""
    steps = tuple(
        replace(step, behaviour=behaviour) if step.state.situation == situation else step
        for step in demonstration.steps
    )
    return replace(demonstration, id=f"{demonstration.id}-{teacher}", teacher=teacher, steps=steps)


def learnt(
    store: Store,
    activity: Activity,
    demonstrations: Iterable[Demonstration],
    settings: ForestSettings = EXACT,
) -> Policy:
    """Log demonstrations and learn a policy from all those in the log."""
    with store.transaction():
        for demonstration in demonstrations:
            keep(store, demonstration)
    library = read_library(store, activity.name)
    return learn_policy(
        activity, library.finished, resolutions=library.resolutions, settings=settings
    )
