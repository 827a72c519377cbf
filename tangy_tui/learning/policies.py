"""The policies in the log: kept by name with what they were learnt from, and learnt again from it.

A policy is not stored but its demonstrations, settings, versions and digest are; it is refitted
when it is loaded, and never used silently if it does not come out as it was.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tangy_profiles.activity import Activity
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import nearest, plain
from tangy_profiles.state import Situation
from tangy_profiles.store import Store
from tangy_tui.learning.conflicts import Resolution
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policy import ForestSettings, Policy, learn_policy

POLICY = "policy learnt"


class NoPolicy(TangyError):
    """Nothing has been learnt yet for this activity, or not what was asked for."""


@dataclass(frozen=True, slots=True)
class Change:
    """A situation that a policy learnt again answers otherwise than it did."""

    situation: Situation
    before: str
    after: str


def keep_policy(store: Store, policy: Policy) -> None:
    """Log a policy: how to learn it again, and the digest of what that must give."""
    store.append(POLICY, policy.to_json())


def kept_policies(store: Store, activity: str) -> list[Mapping[str, Any]]:
    """Return what was kept of every policy of an activity, with the time ("at"), oldest first."""
    return [
        {**event.body, "at": event.at}
        for event in store.events(POLICY)
        if event.body["activity"] == activity
    ]


def last_policy(store: Store, activity: str) -> Mapping[str, Any] | None:
    """Return what was kept of the last policy of an activity (`Policy.to_json`), or None."""
    kept = kept_policies(store, activity)
    return kept[-1] if kept else None


def need_policy(store: Store, activity: Activity, wanted: str = "") -> Mapping[str, Any]:
    """Return what was kept of a policy: of the last one, or of the last one of a name or digest.

    `wanted` is a name, or how a digest begins (four characters or more).

    Raises:
        NoPolicy: none has been learnt, says how to; or there is none of that name.
    """
    kept = kept_policies(store, activity.name)
    if not kept:
        raise NoPolicy(
            f"Tangy has not learnt {activity.title} yet: "
            "demonstrate it with `tangy teach`, then run `tangy learn`."
        )
    if not wanted:
        return kept[-1]
    by_name = [one for one in kept if one["name"] == wanted]
    enough = len(wanted) >= 4
    found = by_name or [one for one in kept if enough and one["digest"].startswith(wanted)]
    if not found:
        names = [str(one["name"]) for one in kept]
        raise NoPolicy(plain(f"There is no policy {wanted!r}: {nearest(wanted, names)}"))
    return found[-1]


def load_policy(store: Store, activity: Activity, wanted: str = "") -> tuple[Policy, list[str]]:
    """Learn a kept policy again from its demonstrations (see `need_policy`).

    Returns:
        The policy, and what a person must be told: a digest that does not match is said, with
        the rows that differ, because then the policy is not the one that was looked at.

    Raises:
        NoPolicy: there is none, or its demonstrations are gone.
    """
    kept = need_policy(store, activity, wanted)
    entries = read_library(store, activity.name).entries
    missing = [id for id in kept["demonstrations"] if id not in entries]
    if missing:
        raise NoPolicy(
            f"The policy {kept['name']!r} rests on {len(missing)} demonstrations that are not in "
            "this data folder: run `tangy learn` again."
        )
    policy = learn_policy(
        activity,
        [entries[id].demonstration for id in kept["demonstrations"]],
        resolutions=[Resolution.from_json(one) for one in kept.get("resolved", ())],
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
