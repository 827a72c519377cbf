"""The JSON documents that the command line prints; their keys are a stable interface."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from tangy_tui.learning.coverage import coverage
from tangy_tui.learning.coverage_proof import prove_coverage
from tangy_tui.learning.library import effects_of, read_library
from tangy_tui.learning.reachable import joint_states
from tangy_tui.text.decisions import why_words
from tangy_tui.text.learnt import replay_words
from tangy_tui.text.people import prior_words, sentence

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_profiles.demonstration import Demonstration
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.interaction.feedback import FeedbackEntry
    from tangy_tui.interaction.record import PersonSummary
    from tangy_tui.learning.comparison import SituationComparison
    from tangy_tui.learning.conflicts import Conflict, DemonstratedStep
    from tangy_tui.learning.explanation import DecisionReasons
    from tangy_tui.learning.online_learning import Lesson
    from tangy_tui.learning.policy import Decision, Policy


def demonstration_document(demonstration: Demonstration) -> dict[str, Any]:
    """Describe one demonstration: teacher, game, and trajectory."""
    return {
        "id": demonstration.id,
        "teacher": demonstration.teacher,
        "seed": demonstration.seed,
        "finished": demonstration.finished,
        "guided": demonstration.guided,
        "origin": demonstration.origin,
        "of": list(demonstration.of),
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


def _searched(activity: Activity, policy: Policy) -> dict[str, Any]:
    """Describe the targets of behaviours, and the results of a search of all games."""
    found = prove_coverage(activity, policy)
    if found is None:
        return {}
    return {
        "whom": [[*key, list(selectors)] for key, selectors in policy.whom.items()],
        "searched": {
            "whole": found.whole,
            "sizes": [
                {"players": size, "states": one.states, "cut": one.cut}
                for size, one in found.searches
            ],
            "reached": [list(situation) for situation in found.reached],
            "asks": [list(situation) for situation in found.open],
        },
    }


def policy_document(workspace: Workspace, policy: Policy) -> dict[str, Any]:
    """Describe a policy: its rows, its effects, and on how many joint states it is as expected."""
    activity = workspace.activity
    people = [person.id for person in workspace.people]
    states = list(joint_states(activity, people))
    right = sum(
        policy.decide(state.situation).behaviour == activity.expected.get(state.situation)
        for state in states
    )
    effects = effects_of(workspace.store, activity, policy)
    return {
        **policy.record().body,
        "rows": [
            {
                "stage": situation.stage,
                "request": situation.request,
                "user_state": situation.user_state,
                "behaviour": decision.behaviour,
                "share": decision.share,
                "seen": decision.seen,
                "votes": dict(decision.votes),
                "sure": decision.sure,
                "contested": decision.contested,
            }
            for situation in activity.situations
            for decision in [policy.decide(situation)]
        ],
        "joint_states": {"people": len(people), "reachable": len(states), "as_expected": right},
        **_searched(activity, policy),
        "exact": policy.exact(activity),
        "asks": [list(s) for s in activity.situations if not policy.decide(s).sure],
        "effects": {
            behaviour: {variable: sorted(values) for variable, values in variables.items()}
            for behaviour, variables in effects.values.items()
        },
        **library_document(workspace),
    }


def library_document(workspace: Workspace) -> dict[str, Any]:
    """Describe the coverage of the finished demonstrations, and their conflicts."""
    activity = workspace.activity
    library = read_library(workspace.store, activity.name)
    found = coverage(activity, library.finished)
    return {
        "coverage": {
            "seen": len(found.seen),
            "situations": len(found.times),
            "missing": [
                {"situation": list(situation), "words": activity.not_yet(situation)}
                for situation in found.missing
            ],
        },
        "conflicts": [conflict_document(workspace, conflict) for conflict in library.conflicts],
    }


def conflict_document(workspace: Workspace, conflict: Conflict) -> dict[str, Any]:
    """Describe a conflict: the situation, and the answers with their steps."""
    return {
        "situation": list(conflict.situation),
        "words": workspace.activity.in_words(conflict.situation),
        "answers": [
            {"behaviour": behaviour, "steps": [shown_document(shown) for shown in steps]}
            for behaviour, steps in conflict.answers.items()
        ],
    }


def shown_document(shown: DemonstratedStep) -> dict[str, Any]:
    """Describe the place of a demonstrated step."""
    return {
        "demonstration": shown.demonstration,
        "teacher": shown.teacher,
        "number": shown.number,
        "behaviour": shown.step.behaviour,
        "situation": list(shown.step.state.situation),
    }


def decision_document(decision: Decision) -> dict[str, Any]:
    """Describe a decision and the votes behind it."""
    return {
        "behaviour": decision.behaviour,
        "share": decision.share,
        "votes": dict(decision.votes),
        "seen": decision.seen,
        "sure": decision.sure,
        "contested": decision.contested,
        "right": list(decision.right),
    }


def why_document(workspace: Workspace, why: DecisionReasons) -> dict[str, Any]:
    """Describe the explanation of a decision."""
    return {
        "situation": list(why.situation),
        **decision_document(why.decision),
        "rests_on": [shown_document(shown) for shown in why.rests_on],
        "against": [shown_document(shown) for shown in why.against],
        "near": [shown_document(shown) for shown in why.near],
        "sentences": why_words(workspace.activity, why),
    }


def lesson_document(workspace: Workspace, lesson: Lesson) -> dict[str, Any]:
    """Describe the lesson of an answer in a game."""
    made, found = lesson.demonstration, lesson.replay
    return {
        "demonstration": made.id,
        "teacher": made.teacher,
        "situation": list(made.steps[-1].state.situation),
        "behaviour": made.steps[-1].behaviour,
        "policy": lesson.policy.name,
        "replayed": found.steps,
        "changed": [[list(c.situation), c.before, c.after] for c in found.changed],
        "overruled": found.overruled,
        "words": replay_words(workspace.activity, found),
    }


def comparison_document(
    workspace: Workspace, a: Policy, b: Policy, rows: list[SituationComparison]
) -> dict[str, Any]:
    """Describe the differences of two policies."""
    return {
        "a": {"name": a.name, "digest": a.digest, "demonstrations": list(a.demonstrations)},
        "b": {"name": b.name, "digest": b.digest, "demonstrations": list(b.demonstrations)},
        "same": all(row.same for row in rows),
        "different": sum(not row.same for row in rows),
        "rows": [
            {
                "situation": list(row.situation),
                "words": workspace.activity.in_words(row.situation),
                "a": decision_document(row.a),
                "b": decision_document(row.b),
                "same": row.same,
            }
            for row in rows
        ],
    }


def person_document(record: PersonSummary) -> dict[str, Any]:
    """Describe one person's model: the posterior of each strategy, and its data."""
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
        "world": record.world,
        "method": {
            **asdict(known.chosen),
            "own": known.own,
            "words": known.method.words,
        },
        "prior": prior_words(known.prior),
        "sentence": sentence(record),
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


def entry_document(entry: FeedbackEntry) -> dict[str, Any]:
    """Describe one line of a person's history; `people void` takes its number."""
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
