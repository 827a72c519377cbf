"""Whether a person did what a behaviour asked for."""

from __future__ import annotations

from tangy_profiles.behaviour import Behaviour
from tangy_profiles.state import ActivityState, Outcome


def refused(
    behaviour: Behaviour, before: ActivityState, outcome: Outcome, after: ActivityState
) -> bool:
    """Say whether the attended person did not do what a behaviour asked for.

    Where that cannot be seen, nothing that changed is as good as a refusal: people are not asked
    again and again because their card is out of sight.
    """
    if not behaviour.persuades or before.attended is None or not outcome.completed:
        return False
    if outcome.response is not None:
        return not outcome.response.followed
    person = before.attended
    return behaviour.effect != "none" and after.user(person) == before.user(person)
