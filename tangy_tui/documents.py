"""The JSON documents that the command line prints: names in them are a contract."""

from __future__ import annotations

from random import Random
from typing import Any

from tangy_profiles.beliefs import probability_best
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.person import Person
from tangy_tui.house import House
from tangy_tui.learning.library import effects_of
from tangy_tui.learning.policy import Policy
from tangy_tui.learning.reachable import joint_states


def demonstration_document(demonstration: Demonstration) -> dict[str, Any]:
    """Describe one demonstration: who, in which game, and its trajectory."""
    return {
        "id": demonstration.id,
        "teacher": demonstration.teacher,
        "seed": demonstration.seed,
        "finished": demonstration.finished,
        "steps": len(demonstration.steps),
        "trajectory": [
            {
                "behaviour": step.behaviour,
                "target": step.target,
                "situation": list(step.state.situation),
            }
            for step in demonstration.steps
        ],
    }


def policy_document(house: House, policy: Policy) -> dict[str, Any]:
    """Describe a policy: its rows, its effects, and on how many joint states it is as expected."""
    activity = house.activity
    people = [person.id for person in house.people]
    states = list(joint_states(activity, people))
    right = sum(
        policy.decide(state.situation).behaviour == activity.expected.get(state.situation)
        for state in states
    )
    effects = effects_of(house.store, activity, policy)
    return {
        **policy.to_json(),
        "rows": [
            {
                "stage": situation.stage,
                "request": situation.request,
                "user_state": situation.user_state,
                "behaviour": decision.behaviour,
                "share": decision.share,
                "seen": decision.seen,
                "votes": dict(decision.votes),
            }
            for situation in activity.situations
            for decision in [policy.decide(situation)]
        ],
        "joint_states": {"people": len(people), "reachable": len(states), "as_expected": right},
        "exact": policy.exact(activity),
        "effects": {
            behaviour: {variable: sorted(values) for variable, values in variables.items()}
            for behaviour, variables in effects.values.items()
        },
    }


def person_document(house: House, person: Person) -> dict[str, Any]:
    """Describe what is believed of one person, strategy by strategy."""
    profile = house.persuasion(Random(0)).beliefs[person.id]
    best = probability_best(profile)
    return {
        "id": person.id,
        "name": person.name,
        "beliefs": {
            strategy: {
                "alpha": belief.alpha,
                "beta": belief.beta,
                "mean": belief.mean,
                "p_best": best[strategy],
            }
            for strategy, belief in profile.items()
        },
    }
