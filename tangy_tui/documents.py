"""The JSON documents that the command line prints: names in them are a contract."""

from __future__ import annotations

from typing import Any

from tangy_profiles.demonstration import Demonstration
from tangy_tui.house import House
from tangy_tui.interaction import saying
from tangy_tui.interaction.feedback import Entry
from tangy_tui.interaction.record import Record
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


def person_document(record: Record) -> dict[str, Any]:
    """Describe what is known of one person, strategy by strategy, and where it comes from."""
    known = record.known
    return {
        "id": record.person.id,
        "name": record.person.name,
        "beliefs": {
            strategy: {
                "alpha": belief.alpha,
                "beta": belief.beta,
                "mean": belief.mean,
                "p_best": record.best[strategy],
                "interval": list(belief.interval()),
                "complied": belief.complied,
                "trials": belief.trials,
                "prior": [known.prior[strategy].alpha, known.prior[strategy].beta],
                "on": strategy not in known.off,
            }
            for strategy, belief in record.beliefs.items()
        },
        "settled": record.settled,
        "method": {
            **known.chosen.to_json(),
            "own": known.own,
            "words": known.method.words,
        },
        "prior": saying.prior_words(known.prior),
        "sentence": saying.sentence(record),
        "last_seen": record.seen and record.seen.isoformat(),
        "games": [
            {
                "game": game.id,
                "at": game.begun.isoformat(),
                "responses": [entry_document(entry) for entry in game.entries],
            }
            for game in record.games
        ],
    }


def entry_document(entry: Entry) -> dict[str, Any]:
    """Describe one line of a person's history; its number is what `people void` takes."""
    return {
        "number": entry.number,
        "at": entry.at.isoformat(),
        "game": entry.game,
        "strategy": entry.strategy,
        "complied": entry.complied,
        "late": entry.late,
        "void": entry.void,
        "why": entry.why,
        "counts": entry.counts,
        "open": entry.open,
    }
