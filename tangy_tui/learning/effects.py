"""Behaviour effects (III-A-4): the observed transitions of each behaviour.

The paper stores the next state itself. A literal comparison raises several false alarms per game,
because the next state also depends on what other people did. So each transition is described by a
few variables that a behaviour can change. For each behaviour and variable, the demonstrated values
are stored; any other value is unexpected.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.game_records import Mismatch as Mismatch
from tangy_profiles.state import FRONT, ActivityState, Outcome, Progress, Variable
from tangy_tui.learning.conflicts import Resolution, joined


@dataclass(frozen=True)
class Effects:
    """The learnt effects: behaviour -> variable -> the values that were observed."""

    values: Mapping[str, Mapping[str, frozenset[str]]]

    def joined(self, other: Effects) -> Effects:
        """Return the union of both effects."""
        values = {
            behaviour: MappingProxyType(
                {
                    variable: self.values.get(behaviour, {}).get(variable, frozenset())
                    | other.values.get(behaviour, {}).get(variable, frozenset())
                    for variable in {
                        **self.values.get(behaviour, {}),
                        **other.values.get(behaviour, {}),
                    }
                }
            )
            for behaviour in {**self.values, **other.values}
        }
        return Effects(MappingProxyType(values))

    def mismatches(
        self, behaviour: str, before: ActivityState, after: ActivityState, activity: Activity
    ) -> list[Mismatch]:
        """Compare an observed transition with the learnt effects (fault detection test).

        For a behaviour or variable that was never demonstrated, the expected values are empty.
        """
        known = self.values.get(behaviour, {})
        return [
            Mismatch(behaviour, variable, tuple(sorted(known.get(variable, ()))), value)
            for variable, value in transition(before, after, activity).items()
            if value not in known.get(variable, ())
        ]


def learn_effects(
    activity: Activity,
    demonstrations: Iterable[Demonstration],
    resolutions: Iterable[Resolution] = (),
) -> Effects:
    """Collect, for each behaviour, the values that each variable took after it.

    Steps that the world could not carry out, or that a teacher called wrong, are skipped.
    """
    settled = joined(resolutions)
    values: dict[str, dict[str, set[str]]] = {}
    for demonstration in demonstrations:
        for step in demonstration.steps:
            said = settled.get(step.state.situation)
            if not step.completed or (said is not None and said.sets_aside(step)):
                continue
            of_behaviour = values.setdefault(step.behaviour, {})
            for variable, value in transition(step.state, step.after, activity).items():
                of_behaviour.setdefault(variable, set()).add(value)
    return Effects(
        MappingProxyType(
            {
                behaviour: MappingProxyType({v: frozenset(seen) for v, seen in variables.items()})
                for behaviour, variables in values.items()
            }
        )
    )


def transition(
    before: ActivityState, after: ActivityState, activity: Activity
) -> dict[Variable, str]:
    """Describe a transition by the variables (`VARIABLES`) that a behaviour can change.

    Variables about the attended person are left out if nobody was attended.
    """
    opening = {r.stage for r in activity.stage_rules if r.condition == "before"}
    closing = {r.stage for r in activity.stage_rules if r.condition == "after"}
    person = before.attended
    if before.facts or before.whom:
        return {"robot's place": "front" if after.place == FRONT else "with a person"}
    if after.place == FRONT:
        place = "front"
    elif after.place == person:
        place = "with the person who asked"
    else:
        place = "with somebody else"
    changes: dict[Variable, str] = {"robot's place": place}
    if before.stage in opening:
        changes["activity"] = "not begun" if after.stage in opening else "begun"
    changes["end"] = "reached" if after.stage in closing else "not reached"
    if _counted(before.stage, activity):
        changes["stage"] = "not left" if after.stage == before.stage else "left"
    if person is not None:
        closed = after.closed == person
        shown, now = before.situation.user_state, after.user(person).activity
        if before.place != after.place:
            changes["request"] = "closed" if closed else "open"
        elif before.place == person and shown != activity.unread:
            # Whether it closes depends on the card, and not every card need have been demonstrated.
            # But a request must never stay open when nothing is left to do.
            finished = now == activity.card_states[-1].name and not closed
            changes["request"] = "open with nothing left" if finished else "as the card asks"
        if before.place == person:
            settled = closed or now != shown or after.stage in closing
            changes["what was asked about"] = "settled" if settled else "unchanged"
        if shown != activity.unread:
            lost = now == activity.unread and not closed and after.stage not in closing
            changes["card"] = "lost from view" if lost else "kept in view"
    waiting = [user.id for user in before.users if user.request == "AR" and user.id != person]
    gone = sum(after.user(id).request == "ANR" for id in waiting)
    changes["others' requests"] = who_waits(gone, len(waiting))
    return changes


def progress(before: ActivityState, outcome: Outcome, after: ActivityState) -> Progress:
    """Return where a step led the game; if the world cannot tell, by the states."""
    if outcome.progress is not None:
        return outcome.progress
    alike = after._replace(step=before.step, closed=before.closed) == before
    called = before.attended is None and bool(outcome.numbers)
    return "none" if alike and not called else "on"


def who_waits(gone: int, waiting: int) -> str:
    """Describe how the requests of `waiting` people changed, `gone` of whom no longer ask.

    Some people may change their minds; all of several people at the same moment is suspicious.
    """
    if not gone:
        return "kept"
    return "none left" if 1 < gone == waiting else "fewer"


def _counted(stage: str, activity: Activity) -> bool:
    return any(r.condition == "count" and r.stage == stage for r in activity.stage_rules)
