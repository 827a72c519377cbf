"""What a teacher said is all right, although no demonstration had shown it: effects learnt late."""

from __future__ import annotations

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.store import Store
from tangy_tui.interaction.facilitation import Acted
from tangy_tui.learning.effects import Effects, learn_effects
from tangy_tui.learning.library import effects_of
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
    learnt = effects_of(store, activity, policy)
    if not steps:
        return learnt
    accepted = Demonstration("accepted", activity.name, "", 0, (), steps, True)
    return learnt.joined(learn_effects(activity, [accepted]))
