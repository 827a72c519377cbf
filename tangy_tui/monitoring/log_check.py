"""Check of a log: its file, its rows, and events that are inconsistent with earlier ones."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.errors import ProfileError
from tangy_profiles.events import kinds
from tangy_profiles.game_records import GameBeginning, GameChange, GameStep
from tangy_profiles.reading import plain
from tangy_profiles.rows import wrong_row
from tangy_profiles.state import ActivityState
from tangy_profiles.store import Store
from tangy_profiles.teaching_records import (
    DemonstrationBegun,
    DemonstrationsEdited,
    DemonstrationStep,
    PolicyLearnt,
)
from tangy_tui.learning import library
from tangy_tui.learning.policies import MANY, LeftOut, without_strange_steps

LogProblem: TypeAlias = str | LeftOut
"""A problem in a log: a sentence, or a step that Tangy does not learn from."""


def log_problems(store: Store) -> list[LogProblem]:
    """Read a whole log and return its problems."""
    wrong = store.check()
    known = set(store.aside)
    strange: list[LogProblem] = list(_strange_people(store))
    for activity in _activities(store):
        strange += _strange_steps(store, activity)
    out_of_place = [store.aside[seq] for seq in sorted(store.aside.keys() - known)]
    return [*wrong, *out_of_place, *strange, *unknown_kinds(store)]


def _strange_steps(store: Store, name: str) -> list[LogProblem]:
    """Return the steps of demonstrations and games that an activity does not know."""
    demonstrations = library.read_demonstrations(store, name)
    try:
        activity = load_activity(name)
    except ProfileError:  # not installed, so it cannot be checked
        return []
    strange = without_strange_steps(activity, demonstrations)[1]
    return [*strange, *_strange_game_steps(store, activity)]


def _strange_game_steps(store: Store, activity: Activity) -> list[str]:
    """Return the game steps that an activity does not know; none if many (the activity changed)."""
    games, steps, strange = set[str](), 0, list[str]()
    for event in store.events(GameBeginning, GameStep):
        match event.record:
            case GameBeginning(game=game, activity=activity.name):
                games.add(game)
            case GameStep(game=game, behaviour=behaviour) if game in games:
                steps += 1
                if behaviour not in activity.behaviours:
                    wrong = f": {activity.title} has no {behaviour[:40]!r}"
                    strange.append(wrong_row(event.seq, event.kind, wrong))
    return strange if len(strange) * MANY <= steps else []


def _strange_people(store: Store) -> Iterator[str]:
    """Report the steps that refer to people who do not take part in the game."""
    people = dict[str, frozenset[str]]()
    told = (DemonstrationBegun, DemonstrationStep, GameBeginning, GameChange, GameStep)
    for event in store.events(*told):
        match event.record:
            case DemonstrationBegun(demonstration=of, people=ids):
                people[of] = frozenset(ids)
            case GameBeginning(game=of, people=ids):
                people[of] = frozenset(ids)
            case GameChange(game=of, what="joined", person=person) if of in people:
                people[of] |= {person}
            case DemonstrationStep(demonstration=of, step=step):
                others = _others(people.get(of), step.target, step.state)
            case GameStep(game=of, target=target, state=state):
                others = _others(people.get(of), target, state)
        if isinstance(event.record, DemonstrationStep | GameStep) and others:
            wrong = f": {', '.join(others)} took no part in the game"
            yield wrong_row(event.seq, event.kind, wrong)


def _others(people: frozenset[str] | None, target: str | None, state: ActivityState) -> list[str]:
    """Return the people in a step who do not take part; none if the participants are unknown."""
    named = {user.id for user in state.users} | ({target} if target else set())
    return [repr(one[:40]) for one in sorted(named - people)] if people else []


def unknown_kinds(store: Store) -> list[str]:
    """Return a sentence for each unknown kind of event in a log."""
    return [
        plain(f"tangy.db: events of the kind {kind[:60]!r} are not known and left out.")
        for kind in store.kinds()
        if kind not in kinds()
    ]


def _activities(store: Store) -> list[str]:
    """Return the names of the activities in a log."""
    events = store.events(DemonstrationBegun, DemonstrationsEdited, GameBeginning, PolicyLearnt)
    return sorted({getattr(event.record, "activity", "") for event in events} - {""})
