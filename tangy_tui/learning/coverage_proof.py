"""The proof that everything was shown: a search of all games that a policy can bring about."""

from __future__ import annotations

from collections.abc import Sequence

from tangy_profiles.activity import Activity
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.search import Reach, reach
from tangy_profiles.declared.shown_moves import ShownMoves
from tangy_tui.learning.policy import Policy


def prove_coverage(activity: Activity, policy: Policy, players: Sequence[str]) -> Reach | None:
    """Search the games that can occur where Tangy does what it is sure of.

    Args:
        activity: the activity to search.
        policy: the policy learnt so far.
        players: those who take turns.

    Returns:
        What can occur, and in which of it Tangy would ask; None for an activity with cards,
        whose situations its stage rules tell.
    """
    if not isinstance(activity, DeclaredActivity):
        return None
    shown = ShownMoves(activity.behaviours)
    shown.whom = dict(policy.whom)
    for situation, decision in policy.table.items():
        if decision.sure:
            shown.shown[situation] = decision.behaviour
    return reach(activity.declaration, tuple(players), shown)
