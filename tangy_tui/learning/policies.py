"""The policies in the log: stored as their training data, and refitted from it.

A stored policy is its demonstrations, settings, versions and digest. It is refitted when it is
loaded, and never used silently if the digest differs.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeAlias

from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import nearest, plain
from tangy_profiles.teaching_records import PolicyLearnt
from tangy_tui.learning.forest_cache import ForestCache
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policy import SURE, Decision, Grow, Policy, all_situations, learn_policy

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_profiles.state import Situation
    from tangy_profiles.store import Store

ASKS = "to ask"
"""The decision of a policy in situations where it is not sure."""
GONE = "no situation any more"
MANY = 20
"""If one step in this many is unknown to the activity, the activity itself was changed."""
RESERVED = ("last", "policy", "teacher")
"""Words that a policy's name must not begin with, because they select a policy."""


@dataclass(frozen=True, slots=True)
class DecisionChange:
    """A situation whose decision changed when the policy was refitted."""

    situation: Situation
    before: str
    after: str


@dataclass(frozen=True, slots=True)
class LeftOut:
    """Step `number` of a demonstration that the activity (by its title) does not know."""

    demonstration: str
    number: int
    behaviour: str
    situation: Situation
    activity: str


@dataclass(frozen=True, slots=True)
class NotAsKept:
    """A policy that differs from the stored one after refitting.

    Args:
        policy: its name.
        versions: changed versions (part, then, now); if empty, its demonstrations have changed.
        changes: changed decisions; if empty, only the votes differ.
    """

    policy: str
    versions: tuple[tuple[str, str | None, str], ...]
    changes: tuple[DecisionChange, ...]


PolicyNotice: TypeAlias = LeftOut | NotAsKept
"""A notice that people must see before a policy is used."""


class NoPolicy(TangyError):
    """There is no policy for this activity, or not the requested one."""


def keep_policy(store: Store, policy: Policy) -> None:
    """Log a policy: its training data, settings and digest."""
    store.append(policy.record())


def stored_policies(store: Store, activity: str) -> list[PolicyLearnt]:
    """Return the stored policies of an activity, oldest first."""
    return [
        replace(event.record, at=event.at)
        for event in store.events(PolicyLearnt)
        if event.record.activity == activity
    ]


def last_policy(store: Store, activity: str) -> PolicyLearnt | None:
    """Return the latest stored policy of an activity, or None."""
    kept = stored_policies(store, activity)
    return kept[-1] if kept else None


def need_policy(store: Store, activity: Activity, wanted: str = "") -> PolicyLearnt:
    """Return a stored policy: the latest, or the latest that matches `wanted`.

    `wanted` is `last` or `last~N` (the N-th before it), a name, or a prefix of a digest (four
    characters or more).

    Raises:
        NoPolicy: no policy was learnt yet, or none matches.
    """
    kept = stored_policies(store, activity.name)
    if not kept:
        raise NoPolicy(
            f"Tangy has not learnt {activity.title} yet: "
            "demonstrate it with Teach (`tangy teach`), then choose Learn (`tangy learn`)."
        )
    place = place_of(wanted or "last")
    if place is not None:
        if place >= len(kept):
            there = "1 policy was" if len(kept) == 1 else f"{len(kept)} policies were"
            raise NoPolicy(f"{wanted}: only {there} learnt.")
        return kept[-1 - place]
    by_name = [one for one in kept if one.name == wanted]
    enough = len(wanted) >= 4
    found = by_name or [one for one in kept if enough and one.digest.startswith(wanted)]
    if not found:
        names = [one.name for one in kept]
        raise NoPolicy(plain(f"There is no policy {wanted!r}: {nearest(wanted, names)}"))
    return found[-1]


def place_of(word: str) -> int | None:
    """Return how far before the latest policy a word points: 0 for last, 2 for last~2."""
    head, tilde, number = word.partition("~")
    if head != "last" or (tilde and not number.isdecimal()):
        return None
    return int(number) if tilde else 0


def check_name(name: str) -> None:
    """Reject a policy name that is reserved.

    Raises:
        TangyError: the name is a word that selects another policy.
    """
    if name.partition("~")[0].partition(":")[0] in RESERVED:
        raise TangyError(plain(f"A policy cannot be called {name!r}: choose another name."))


def unused_name(store: Store, policy: Policy) -> Policy:
    """Make the name of a policy unique, if it was named by count."""
    taken = {kept.name: kept.digest for kept in stored_policies(store, policy.activity)}
    name, count = policy.name, 1
    while policy.named_by_count and taken.get(name, policy.digest) != policy.digest:
        count += 1
        name = f"{policy.name}.{count}"
    return policy if name == policy.name else replace(policy, name=name)


def load_policy(
    store: Store, activity: Activity, wanted: str = ""
) -> tuple[Policy, list[PolicyNotice]]:
    """Refit a stored policy from its demonstrations (see `need_policy`).

    Returns:
        The policy, and notices for people: if the digest differs, the changed situations, because
            then it is not the policy that people looked at.

    Raises:
        NoPolicy: there is none, or its demonstrations are gone.
    """
    kept = need_policy(store, activity, wanted)
    entries = read_library(store, activity.name).entries
    missing = [id for id in kept.demonstrations if id not in entries]
    if missing:
        raise NoPolicy(
            f"The policy {kept.name!r} rests on {len(missing)} demonstrations that are not in "
            "this data folder: run `tangy learn` again."
        )
    cache = ForestCache(store.folder)
    used, left_out = without_strange_steps(
        activity, [entries[id].demonstration for id in kept.demonstrations]
    )

    def again(grow: Grow) -> Policy:
        return learn_policy(
            activity,
            used,
            resolutions=kept.resolved,
            settings=kept.forest,
            name=kept.name,
            grow=grow,
        )

    policy = again(cache.grown)
    if policy.digest != kept.digest:
        policy = again(cache.afresh)  # the cache may be corrupt; grow the forest again
    if policy.digest != kept.digest:
        return policy, [*left_out, _explain(kept, policy)]
    return policy, [*left_out]


def without_strange_steps(
    activity: Activity, demonstrations: Sequence[Demonstration]
) -> tuple[list[Demonstration], list[LeftOut]]:
    """Leave out single steps that the activity does not know, and report them.

    If there are many, the activity was changed, and all steps are kept.
    """
    situations = frozenset(all_situations(activity))
    kept, notices, count = list[Demonstration](), list[LeftOut](), 0
    for one in demonstrations:
        known = []
        for number, step in enumerate(one.steps, 1):
            if step.behaviour in activity.behaviours and step.state.situation in situations:
                known.append(step)
                continue
            where = step.state.situation
            notices.append(LeftOut(one.id, number, step.behaviour, where, activity.title))
        count += len(one.steps)
        kept.append(one if len(known) == len(one.steps) else replace(one, steps=tuple(known)))
    if len(notices) * MANY > count:
        return list(demonstrations), []
    return kept, notices


def changes(kept: PolicyLearnt, policy: Policy) -> list[DecisionChange]:
    """Compare a stored policy with a refitted one: changed behaviours, or that it asks."""
    was: dict[Situation, str] = {}
    for row in kept.rows:
        asks = row.share < SURE if kept.asks is None else row.situation in kept.asks
        was[row.situation] = ASKS if asks else row.behaviour
    situations = dict.fromkeys([*was, *policy.table])
    found = []
    for situation in situations:
        decision = policy.table.get(situation)
        now = GONE if decision is None else does(decision)
        before = was.get(situation, ASKS)
        if now != before:
            found.append(DecisionChange(situation, before, now))
    return found


def does(decision: Decision) -> str:
    """Return the behaviour of a decision, or `ASKS` if it is not sure."""
    return decision.behaviour if decision.sure else ASKS


def _explain(kept: PolicyLearnt, policy: Policy) -> NotAsKept:
    was, now = dict(kept.versions), dict(policy.versions)
    moved = [(part, was.get(part), now[part]) for part in now if was.get(part) != now[part]]
    return NotAsKept(policy.name, tuple(moved), tuple(changes(kept, policy)))
