"""Proof of full coverage: a search of all games that can occur under a policy."""

from __future__ import annotations

from dataclasses import dataclass
from time import thread_time

from tangy_profiles.activity import Activity
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.demonstrated_moves import DemonstratedMoves
from tangy_profiles.declared.search import Limit, SearchResult, explore_demonstrated
from tangy_profiles.state import Situation
from tangy_tui.learning.policy import Policy

PLAYERS = ("1", "2", "3")
"""The players of the largest group to search."""
LIMIT = Limit(states=60_000, seconds=10.0)
"""Limit of the searches of one and two players: states of each, CPU time (s) of all together."""
LARGEST = Limit(states=15_000, seconds=4.0)
"""Limit of the search of the largest group, which has many states."""


@dataclass(frozen=True, slots=True)
class CoverageProof:
    """Searches of all games that can occur under a policy, one for each group size.

    `searches` maps the number of players, ascending, to a result. They stop at the first search
    that reached its limit.
    """

    searches: tuple[tuple[int, SearchResult], ...]

    @property
    def proved(self) -> tuple[int, ...]:
        """The group sizes whose games were searched completely."""
        return tuple(size for size, one in self.searches if one.whole)

    @property
    def whole(self) -> bool:
        """Whether the games of all groups, except perhaps the largest, were searched completely."""
        return all(one.whole or size == len(PLAYERS) for size, one in self.searches)

    @property
    def reached(self) -> tuple[Situation, ...]:
        """The situations that can occur in any of the searched games."""
        return tuple(dict.fromkeys(s for _, one in self.searches for s in one.reached))

    @property
    def open(self) -> dict[Situation, str]:
        """The situations in which Tangy would ask: "" if never shown, else for whom is unclear."""
        return {s: why for _, one in self.searches for s, why in one.open.items()}

    @property
    def stuck(self) -> Situation | None:
        """A situation from which no game can end, or None."""
        return next((one.stuck for _, one in self.searches if one.stuck is not None), None)


def prove_coverage(activity: Activity, policy: Policy) -> CoverageProof | None:
    """Search all games that can occur under the sure decisions of a policy.

    Args:
        activity: the activity to search.
        policy: the policy learnt so far.

    Returns:
        The search results; None for an activity with cards, whose stage rules give its situations.
    """
    if not isinstance(activity, DeclaredActivity):
        return None
    shown = DemonstratedMoves(activity.behaviours)
    shown.whom = dict(policy.whom)
    for situation, decision in policy.table.items():
        if decision.sure:
            shown.shown[situation] = decision.behaviour
    return search_groups(activity, shown)


def search_groups(
    activity: DeclaredActivity,
    shown: DemonstratedMoves,
    limit: Limit = LIMIT,
    largest: Limit = LARGEST,
) -> CoverageProof:
    """Search all games of one to three players, or of the teams, under the shown moves.

    Args:
        activity: the activity to search.
        shown: the behaviour shown in each situation.
        limit: the states of each search, and the CPU time of all of them in s.
        largest: the same for the largest group.
    """
    groups = [activity.teams] if activity.teams else [PLAYERS[:n] for n in (1, 2, 3)]
    until = thread_time() + limit.seconds
    searches: list[tuple[int, SearchResult]] = []
    for group in groups:
        one = largest if group == PLAYERS else limit
        left = Limit(one.states, min(one.seconds, until - thread_time()))
        searches.append(
            (len(group), explore_demonstrated(activity.declaration, group, shown, left))
        )
        if not searches[-1][1].whole:
            break
    return CoverageProof(tuple(searches))
