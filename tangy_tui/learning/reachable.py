"""All joint activity states that the stage rules can reach, to check a whole policy."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

from tangy_profiles.activity import Activity, StageRule
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.state import FRONT, ActivityState, Request, Situation, UserState


def joint_states(activity: Activity, people: Sequence[str]) -> Iterator[ActivityState]:
    """Yield every reachable joint state.

    These are: one for each stage without requests; every set of requests with the robot at the
    front or beside someone who does not ask; the robot beside someone who asks, for every user
    state and every set of other requests; and the same after the win. For Bingo's stages and four
    people that is 242. There are none for an activity declared by facts, whose states
    `coverage_proof` searches.
    """
    for rule in () if isinstance(activity, DeclaredActivity) else activity.stage_rules:
        yield from _states_of(rule, activity, tuple(people))


def _states_of(
    rule: StageRule, activity: Activity, people: tuple[str, ...]
) -> Iterator[ActivityState]:
    unread = activity.unread
    for flags in product((False, True), repeat=len(people)):
        asking = {person for person, flag in zip(people, flags, strict=True) if flag}
        idle = [person for person in people if person not in asking]
        match rule.condition:
            case "beside requester":
                for place, shown in product(sorted(asking), activity.user_states):
                    yield _state(rule.stage, people, asking, place, place, shown.name, unread)
            case "after":
                anywhere = () if activity.leaves_request(rule) else (FRONT, *idle)
                for place in (*sorted(asking), *anywhere):
                    head = place if place in asking else min(asking, default=None)
                    yield _state(rule.stage, people, asking, place, head, unread, unread)
            case "requested or away" if asking:
                head = min(asking)  # the triple does not depend on who comes first
                for place in (FRONT, *idle):
                    yield _state(rule.stage, people, asking, place, head, unread, unread)
            case "requested or away":
                for place in people:
                    yield _state(rule.stage, people, asking, place, None, unread, unread)
            case _ if not asking:
                yield _state(rule.stage, people, asking, FRONT, None, unread, unread)


def _state(
    stage: str,
    people: tuple[str, ...],
    asking: set[str],
    place: str,
    attended: str | None,
    shown: str,
    unread: str,
) -> ActivityState:
    def request(person: str) -> Request:
        return "AR" if person in asking else "ANR"

    users = tuple(
        UserState(person, shown if person == attended else unread, request(person))
        for person in people
    )
    situation = Situation(stage, "ANR" if attended is None else "AR", shown)
    return ActivityState(0, situation, place, attended, users)
