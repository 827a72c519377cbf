"""Whether a person refused a behaviour's request."""

from __future__ import annotations

from tangy_profiles.behaviour import Behaviour
from tangy_profiles.state import ActivityState, Outcome


def refused(
    behaviour: Behaviour, before: ActivityState, outcome: Outcome, after: ActivityState
) -> bool:
    """Return whether the attended person did not do what a behaviour asked for.

    If no response was seen, an unchanged state counts as a refusal, so that people are not asked
    endlessly because their card is out of sight.
    """
    if not behaviour.persuades or before.attended is None or not outcome.completed:
        return False
    if outcome.response is not None:
        return not outcome.response.followed
    person = before.attended
    return behaviour.effect != "none" and after.user(person) == before.user(person)
