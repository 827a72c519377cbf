"""Words after learning: the policy, its changes, and the demonstrations left out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from tangy_tui.text.numbers import counted

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_tui.learning.conflicts import DemonstratedStep
    from tangy_tui.learning.explanation import DecisionReasons
    from tangy_tui.learning.online_learning import PolicyReplay, Unsettled
    from tangy_tui.learning.policies import DecisionChange
    from tangy_tui.learning.policy import Policy


UNSETTLED: Mapping[Unsettled, str] = {
    "": "",
    "new": (
        "Nobody has given this answer before. Tangy goes on asking here until a teacher settles "
        "which answer is right."
    ),
    "otherwise": "A teacher said otherwise before: both are shown before Tangy learns again.",
}


EFFECTS: Mapping[tuple[str, str], str] = {
    ("robot's place", "front"): "Tangy is at the front",
    ("robot's place", "with a person"): "Tangy is with a person",
    ("robot's place", "with the person who asked"): "Tangy is with the person who asked",
    ("robot's place", "with somebody else"): "Tangy is with somebody else",
    ("activity", "begun"): "the activity has begun",
    ("activity", "not begun"): "the activity has not begun",
    ("end", "reached"): "the activity is over",
    ("end", "not reached"): "the activity goes on",
    ("stage", "left"): "it is no longer due",
    ("stage", "not left"): "it is still due",
    ("request", "closed"): "the request is closed",
    ("request", "open"): "the request stays open",
    ("request", "open with nothing left"): "the request stays open with nothing left to do",
    ("request", "as the card asks"): "the request is closed once all is right",
    ("what was asked about", "settled"): "what Tangy asked for is done",
    ("what was asked about", "unchanged"): "what Tangy asked for is not done",
    ("card", "kept in view"): "the card stays in view",
    ("card", "lost from view"): "the card goes out of view",
    ("others' requests", "kept"): "nobody else's request is lost",
    ("others' requests", "fewer"): "somebody else's request is lost",
}
"""Words for the effects of a behaviour, by variable and value."""

NOT_SHOWN = "Not shown to Tangy yet:"
"""The words before the result of `missing_words`, which is about demonstrations, not the room."""


def effects_words(variables: Mapping[str, Iterable[str]]) -> str:
    """Describe the effects of a behaviour; several values of a variable are joined by "or"."""
    return "; ".join(
        " or ".join(EFFECTS.get((variable, value), f"{variable} {value}") for value in sorted(seen))
        for variable, seen in variables.items()
    )


def replay_words(activity: Activity, replay: PolicyReplay) -> str:
    """Describe the changes when the new policy is replayed on all earlier steps."""
    if not replay.steps:
        first = "There were no earlier steps to compare with."
    elif replay.changed:
        rows = "; ".join(
            f"{activity.in_words(c.situation)}: was {activity.behaviour_words(c.before)}, "
            f"is now {activity.behaviour_words(c.after)}"
            for c in replay.changed
        )
        first = f"All {replay.steps} earlier steps were gone through. Changed as well: {rows}."
    else:
        first = f"All {replay.steps} earlier steps were gone through: nothing else changed."
    aside = {0: "", 1: " One earlier step said otherwise, and is set aside."}.get(
        replay.overruled, f" {replay.overruled} earlier steps said otherwise, and are set aside."
    )
    return " ".join(part for part in (first + aside, UNSETTLED[replay.unsettled]) if part)


def only_unfinished(steps: int) -> str:
    """Tell that there is no finished demonstration to learn from."""
    return (
        f"No demonstration is finished yet. {counted(steps, 'step is', 'steps are')} kept. Go on "
        "with `tangy teach`, or learn from unfinished ones with --unfinished."
    )


def learnt_lines(
    activity: Activity, policy: Policy, steps: int, left_out: int, not_shown: str
) -> list[str]:
    """Name the demonstrations of a policy, and the situations in which it asks.

    Args:
        activity: the activity of the policy.
        policy: the learnt policy.
        steps: the number of demonstrated steps.
        left_out: the number of unfinished demonstrations not used.
        not_shown: the heading of the situations not demonstrated.
    """
    unseen = [s for s in activity.situations if not policy.decide(s).seen]
    contested = [s for s in activity.situations if policy.decide(s).contested]
    seen = len(activity.situations) - len(unseen)
    lines = [
        f"Learnt {policy.name!r} from {counted(len(policy.demonstrations), 'demonstration')} "
        f"({counted(steps, 'step')}): {seen} of {len(activity.situations)} situations were shown."
    ]
    if unseen:
        lines.append(not_shown)
    for one in unseen:
        words, where = activity.not_yet(one), activity.in_words(one)
        lines.append(f"  {words}" if words == where else f"  {words} ({where})")
    if contested:
        lines.append(f"Demonstrations disagree about {counted(len(contested), 'situation')}:")
        for situation in contested:
            answers = " or ".join(
                activity.behaviour_words(b) for b, _ in policy.decide(situation).votes
            )
            lines.append(f"  {activity.in_words(situation)}: {answers}")
        lines.append(
            "Tangy will ask there. `tangy demonstrations conflicts` shows the steps, and numbers "
            "them. Settle one with `tangy demonstrations resolve NUMBER --right BEHAVIOUR`, then "
            "learn again."
        )
    if left_out:
        lines.append(
            f"{counted(left_out, 'unfinished demonstration')} left out. "
            "Learn from unfinished ones too with --unfinished."
        )
    return lines


def changed_lines(activity: Activity, before: str, changed: Sequence[DecisionChange]) -> list[str]:
    """Describe how a policy differs from the previous one, given by name."""
    if not changed:
        return [f"It does the same as {before!r}, the policy before it, in every situation."]
    lines = [f"Changes from {before!r}, the policy before it:"]
    for change in changed:
        where = activity.in_words(change.situation)
        before, after = (activity.behaviour_words(b) for b in (change.before, change.after))
        lines.append(f"  {where}: was {before}, is now {after}")
    return lines


def grounds(why: DecisionReasons) -> tuple[tuple[str, Sequence[DemonstratedStep]], ...]:
    """Return the steps that support a decision, and the others, each group with its heading."""
    return ("Based on", why.rests_on), ("Against it", why.against), ("Nearby", why.near)


NOTHING_SHOWN = "Nobody has shown Tangy anything yet."


def coverage_so_far(number: int, game: int, steps: int, shown: int, situations: int) -> str:
    """Tell the coverage up to a demonstration, given by number."""
    return (
        f"Demonstration {number} (game {game}): {counted(steps, 'step')}; "
        f"{shown} of {situations} situations were shown so far."
    )


def situations_shown(shown: int, situations: int) -> str:
    """Tell how many situations were demonstrated."""
    return f"{shown} of {situations} situations were shown."
