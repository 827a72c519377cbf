"""What a teacher said is all right, although no demonstration had shown it: effects learnt late."""

from __future__ import annotations

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.store import Store
from tangy_tui.interaction.facilitation import Acted
from tangy_tui.learning.effects import Effects, learn_effects
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.fault import ACCEPTED, Fault


def accept(store: Store, activity: Activity, fault: Fault, acted: Acted, by: str) -> None:
    """Log that what followed a behaviour is to be expected from now on."""
    step = Step(acted.action.behaviour.name, acted.action.target, acted.state, acted.after)
    store.append(
        ACCEPTED,
        {
            "activity": activity.name,
            "game": fault.game,
            "fault": fault.id,
            "by": by,
            **step.to_json(),
        },
    )


def expected_effects(store: Store, activity: Activity, policy: Policy) -> Effects:
    """Learn the effects from a policy's demonstrations and from what teachers accepted since."""
    steps = tuple(
        Step.from_json(event.body)
        for event in store.events(ACCEPTED)
        if event.body["activity"] == activity.name
    )
    learnt = _shown_effects(store, activity, policy)
    if not steps:
        return learnt
    accepted = Demonstration("accepted", activity.name, "", 0, (), steps, True)
    return learnt.joined(learn_effects(activity, [accepted]))


def _shown_effects(store: Store, activity: Activity, policy: Policy) -> Effects:
    """Learn the effects from a policy's demonstrations, and from answers only what none shows.

    Who answers in a game says what to do there, and not that whatever followed is all right: it
    may be the fault itself that was seen once more.
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
