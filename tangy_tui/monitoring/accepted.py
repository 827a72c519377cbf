"""Effects that a teacher accepted although no demonstration shows them.

Each acceptance can be undone; the effect is then a fault again.
"""

from __future__ import annotations

from dataclasses import dataclass

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.errors import TangyError
from tangy_profiles.game_records import AcceptanceTakenBack, EffectAccepted
from tangy_profiles.store import Store
from tangy_tui.interaction.game_events import Acted
from tangy_tui.learning.effects import Effects, Mismatch, learn_effects
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.fault import Fault, read_faults


@dataclass(frozen=True)
class Acceptance:
    """An accepted effect: its number in the log, time, teacher, step and mismatches."""

    number: int
    at: str
    by: str
    step: Step
    mismatches: tuple[Mismatch, ...]


def accept(store: Store, activity: Activity, fault: Fault, acted: Acted, by: str) -> None:
    """Log that an observed effect of a behaviour is expected from now on."""
    step = Step(acted.action.behaviour.name, acted.action.target, acted.state, acted.after)
    store.append(
        EffectAccepted(activity=activity.name, game=fault.game, fault=fault.id, by=by, step=step)
    )


def read_accepted(store: Store, activity: str) -> list[Acceptance]:
    """Return the accepted effects of an activity that were not withdrawn, oldest first."""
    there: dict[int, Acceptance] = {}
    what: dict[str, tuple[Mismatch, ...]] = {}
    for event in store.events(EffectAccepted, AcceptanceTakenBack):
        match event.record:
            case AcceptanceTakenBack(number=number):
                there.pop(number, None)
            case EffectAccepted(activity=of, by=by, step=step, fault=id) if of == activity:
                what = what or {fault.id: fault.mismatches for fault in read_faults(store)}
                there[event.seq] = Acceptance(event.seq, event.at, by, step, what.get(id, ()))
    return list(there.values())


def take_back(store: Store, activity: str, place: int) -> Acceptance:
    """Withdraw an accepted effect, by its number in the list (from 1).

    Raises:
        TangyError: the list has no such number.
    """
    accepted = read_accepted(store, activity)
    if not 1 <= place <= len(accepted):
        there = f"choose from 1 to {len(accepted)}" if accepted else "nothing was accepted"
        raise TangyError(f"There is no number {place} in the list: {there}.")
    taken = accepted[place - 1]
    store.append(AcceptanceTakenBack(number=taken.number))
    return taken


def expected_effects(store: Store, activity: Activity, policy: Policy) -> Effects:
    """Learn the effects from a policy's demonstrations and from accepted effects."""
    learnt = _shown_effects(store, activity, policy)
    steps = tuple(one.step for one in read_accepted(store, activity.name))
    if not steps:
        return learnt
    accepted = Demonstration("accepted", activity.name, "", 0, (), steps, True)
    return learnt.joined(learn_effects(activity, [accepted]))


def _shown_effects(store: Store, activity: Activity, policy: Policy) -> Effects:
    """Learn the effects from demonstrations; use answers only for effects that none of them shows.

    A teacher who answers in a game says what to do, not that the observed effect is right: it may
    be the same fault again.
    """
    entries = read_library(store, activity.name).entries
    used = [entries[id].demonstration for id in policy.demonstrations if id in entries]
    shown = learn_effects(
        activity, [one for one in used if one.origin != "asked"], policy.resolutions
    )
    answered = learn_effects(
        activity, [one for one in used if one.origin == "asked"], policy.resolutions
    )
    return shown.joined(
        Effects(
            {
                behaviour: {
                    variable: values
                    for variable, values in variables.items()
                    if variable not in shown.values.get(behaviour, {})
                }
                for behaviour, variables in answered.values.items()
            }
        )
    )
