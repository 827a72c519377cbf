"""The demonstrations and policies in the log: read from its events, never kept beside it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.errors import TangyError
from tangy_profiles.state import Situation
from tangy_profiles.store import Store

if TYPE_CHECKING:  # home counts demonstrations before anybody needs a forest
    from tangy_tui.learning.effects import Effects
    from tangy_tui.learning.policy import Policy

BEGUN = "demonstration begun"
STEP = "demonstration step"
UNDONE = "demonstration step undone"
FINISHED = "demonstration finished"
POLICY = "policy learnt"


class NoPolicy(TangyError):
    """Nothing has been learnt yet for this activity."""


def read_demonstrations(store: Store, activity: str) -> list[Demonstration]:
    """Return the demonstrations of an activity in the order in which they were begun."""
    found: dict[str, Demonstration] = {}
    for event in store.events(BEGUN, STEP, UNDONE, FINISHED):
        body = event.body
        id = str(body["demonstration"])
        if event.kind == BEGUN:
            if body["activity"] == activity:
                found[id] = Demonstration(
                    id, activity, str(body["teacher"]), int(body["seed"]), tuple(body["people"])
                )
        elif id not in found:
            continue
        elif event.kind == STEP:
            found[id] = found[id].with_step(Step.from_json(body))
        elif event.kind == UNDONE:
            found[id] = found[id].without_last()
        else:
            found[id] = replace(found[id], finished=True)
    return list(found.values())


def effects_of(store: Store, activity: Activity, policy: Policy) -> Effects:
    """Learn the effects from the demonstrations that a policy rests on."""
    from tangy_tui.learning.effects import learn_effects

    shown = read_demonstrations(store, activity.name)
    return learn_effects(activity, [d for d in shown if d.id in policy.demonstrations])


@dataclass(frozen=True, slots=True)
class Change:
    """A situation that a policy learnt again answers otherwise than it did."""

    situation: Situation
    before: str
    after: str


def keep_policy(store: Store, policy: Policy) -> None:
    """Log a policy: how to learn it again, and the digest of what that must give."""
    store.append(POLICY, policy.to_json())


def last_policy(store: Store, activity: str) -> Mapping[str, Any] | None:
    """Return what was kept of the last policy of an activity (`Policy.to_json`), or None."""
    kept: Mapping[str, Any] | None = None
    for event in store.events(POLICY):
        if event.body["activity"] == activity:
            kept = event.body
    return kept


def need_policy(store: Store, activity: Activity) -> Mapping[str, Any]:
    """Return what was kept of the last policy of an activity.

    Raises:
        NoPolicy: none has been learnt; says how to.
    """
    kept = last_policy(store, activity.name)
    if kept is None:
        raise NoPolicy(
            f"Tangy has not learnt {activity.title} yet: "
            "demonstrate it with `tangy teach`, then run `tangy learn`."
        )
    return kept


def load_policy(store: Store, activity: Activity) -> tuple[Policy, list[str]]:
    """Learn the last kept policy of an activity again from its demonstrations.

    Returns:
        The policy, and what a person must be told: a digest that does not match is said, with
        the rows that differ, because then the policy is not the one that was looked at.

    Raises:
        NoPolicy: none has been learnt, or its demonstrations are gone.
    """
    from tangy_tui.learning.policy import ForestSettings, learn_policy

    kept = need_policy(store, activity)
    shown = {d.id: d for d in read_demonstrations(store, activity.name)}
    missing = [id for id in kept["demonstrations"] if id not in shown]
    if missing:
        raise NoPolicy(
            f"The policy {kept['name']!r} rests on {len(missing)} demonstrations that are not in "
            "this data folder: run `tangy learn` again."
        )
    policy = learn_policy(
        activity,
        [shown[id] for id in kept["demonstrations"]],
        settings=ForestSettings(**kept["forest"]),
        name=str(kept["name"]),
    )
    if policy.digest == kept["digest"]:
        return policy, []
    return policy, _explain(kept, policy)


def changes(rows: Sequence[Sequence[Any]], policy: Policy) -> list[Change]:
    """Compare kept rows (stage, request, user state, behaviour, share) with a policy."""
    found: list[Change] = []
    for stage, request, user_state, behaviour, _ in rows:
        situation = Situation(stage, request, user_state)
        decision = policy.table.get(situation)
        now = decision.behaviour if decision else "nothing"
        if now != behaviour:
            found.append(Change(situation, behaviour, now))
    return found


def _explain(kept: Mapping[str, Any], policy: Policy) -> list[str]:
    was, now = dict(kept["versions"]), dict(policy.versions)
    moved = [f"{part} {was.get(part)} -> {now[part]}" for part in now if was.get(part) != now[part]]
    why = f" ({', '.join(moved)})" if moved else " (its demonstrations have changed since)"
    notices = [f"The policy {policy.name!r} does not come out as it was kept{why}."]
    different = changes(kept["rows"], policy)
    if not different:
        notices.append("It decides the same everywhere; only the votes differ.")
    for change in different:
        notices.append(
            f"{' / '.join(change.situation)}: was {change.before}, is now {change.after}."
        )
    notices.append("Look at it with `tangy policy`, and keep it with `tangy learn`.")
    return notices
