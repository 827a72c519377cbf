"""Why a decision: the situation, the votes, the steps it rests on, what else was considered.

For every decision alike: one that Tangy takes in a game, one that it would take while it is
taught, and one that somebody looks up.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.state import Situation
from tangy_profiles.store import Store
from tangy_tui.learning.conflicts import Shown, shown_steps
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policy import SURE, Decision, Policy, learn_policy


@dataclass(frozen=True, slots=True)
class Why:
    """The grounds of one decision.

    `rests_on` are the steps in this situation that gave the answer decided for, `against` those
    that gave another one (set aside or not); `near` are, where the situation was never shown, the
    steps in situations that differ from it in one part, from which the trees guess.
    """

    situation: Situation
    decision: Decision
    rests_on: tuple[Shown, ...]
    against: tuple[Shown, ...]
    near: tuple[Shown, ...]

    @property
    def steps(self) -> tuple[Shown, ...]:
        """All of these steps, in the order in which they are told."""
        return (*self.rests_on, *self.against, *self.near)


def explain(policy: Policy, demonstrations: Sequence[Demonstration], situation: Situation) -> Why:
    """Find the grounds of a policy's decision among the demonstrations that it rests on.

    Args:
        policy: by which is played.
        demonstrations: all there are; those that the policy was not learnt from are passed over.
        situation: which one.

    Raises:
        KeyError: the situation is none of the activity's.
    """
    decision = policy.decide(situation)
    used = set(policy.demonstrations)
    shown = list(shown_steps(d for d in demonstrations if d.id in used))
    here = [s for s in shown if s.step.state.situation == situation]
    near = () if decision.seen else (s for s in shown if _differ(s, situation) == 1)
    return Why(
        situation,
        decision,
        tuple(s for s in here if s.step.behaviour == decision.behaviour),
        tuple(s for s in here if s.step.behaviour != decision.behaviour),
        tuple(near),
    )


def foresee(store: Store, activity: Activity, present: Demonstration | None) -> Policy:
    """Learn what Tangy would do by now: from what is finished, and from what is being shown.

    Nothing of it is kept.

    Raises:
        NothingToLearnFrom: nobody has shown anything yet.
    """
    library = read_library(store, activity.name)
    shown = {d.id: d for d in library.finished}
    if present is not None and present.steps:
        for id in present.of:
            shown.pop(id, None)
        shown[present.id] = present
    return learn_policy(activity, list(shown.values()), resolutions=library.resolutions)


def why_words(activity: Activity, why: Why, *, votes: bool = True) -> list[str]:
    """Put the grounds of a decision into sentences, the most important first.

    Args:
        activity: what is played.
        why: the grounds.
        votes: with a sentence on the votes; without it, they are drawn beside the sentences.
    """
    decision = why.decision
    sentences = [f"Situation: {activity.in_words(why.situation)}."]
    teachers = dict.fromkeys(shown.teacher for shown in why.rests_on)
    times = "once" if len(why.rests_on) == 1 else f"{len(why.rests_on)} times"
    if decision.contested:
        sentences.append(
            "Demonstrations disagree about it, and nobody has said yet which is right: "
            "Tangy does not act here, it asks."
        )
    elif not decision.seen:
        sentences.append("Nobody has shown Tangy what to do here: it does not act, it asks.")
    elif not why.rests_on:
        sentences.append(f"A teacher said that {decision.behaviour!r} is right here.")
    else:
        sentences.append(
            f"{decision.behaviour!r} was shown here {times}, by {', '.join(teachers)}."
        )
        if decision.right and why.against:
            sentences.append(f"A teacher said that {_either(decision.right)} is right here.")
        if not decision.sure:
            sentences.append(
                f"Fewer than {SURE:.0%} of the trees agree: Tangy does not act here, it asks."
            )
    if votes:
        shares = ", ".join(f"{behaviour} {share:.0%}" for behaviour, share in decision.votes)
        sentences.append(f"Votes of the trees: {shares}.")
    if why.near:
        guesses = dict.fromkeys(activity.in_words(s.step.state.situation) for s in why.near)
        sentences.append(f"The trees guess from what was shown nearby: {'; '.join(guesses)}.")
    return sentences


def shown_words(shown: Shown, name: Callable[[str], str]) -> str:
    """Name a demonstrated step: what, where it stands, by whom.

    Args:
        shown: a demonstrated step, and of which demonstration.
        name: what to call a demonstration, by its id.
    """
    where = f"step {shown.number} of {name(shown.demonstration)}"
    return f"{shown.step.behaviour}: {where}, by {shown.teacher}"


def _either(answers: Sequence[str]) -> str:
    return " or ".join(repr(answer) for answer in answers)


def _differ(shown: Shown, situation: Situation) -> int:
    """Count the parts of the triple in which a step's situation is another one."""
    return sum(a != b for a, b in zip(shown.step.state.situation, situation, strict=True))
