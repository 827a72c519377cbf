"""The proof that everything was shown: a search of all games that a policy can bring about."""

from __future__ import annotations

from dataclasses import dataclass
from time import thread_time

from tangy_profiles.activity import Activity
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.search import Limit, Reach, reach
from tangy_profiles.declared.shown_moves import ShownMoves
from tangy_profiles.state import Situation
from tangy_tui.learning.policy import Policy

PLAYERS = ("1", "2", "3")
"""The players of the largest group that is searched."""
LIMIT = Limit(states=60_000, seconds=10.0)
"""How far the searches of one and two players go, and for how many s of CPU all together."""
LARGEST = Limit(states=15_000, seconds=4.0)
"""How far the search of the largest group goes, whose states are many."""


@dataclass(frozen=True, slots=True)
class CoverageProof:
    """Searches of all games that a policy can bring about, one for each size of the group.

    `searches` are by the number of players, ascending. They end with the first one that was cut.
    """

    searches: tuple[tuple[int, Reach], ...]

    @property
    def proved(self) -> tuple[int, ...]:
        """The sizes of which every game was searched."""
        return tuple(size for size, one in self.searches if one.whole)

    @property
    def whole(self) -> bool:
        """Whether every game of all groups but the largest was searched."""
        return all(one.whole or size == len(PLAYERS) for size, one in self.searches)

    @property
    def reached(self) -> tuple[Situation, ...]:
        """The situations that can come about in any of them."""
        return tuple(dict.fromkeys(s for _, one in self.searches for s in one.reached))

    @property
    def open(self) -> dict[Situation, str]:
        """The situations in which Tangy would ask: "" nobody showed it, else for whom it is."""
        return {s: why for _, one in self.searches for s, why in one.open.items()}

    @property
    def stuck(self) -> Situation | None:
        """A situation from which no game ends, if there is one."""
        return next((one.stuck for _, one in self.searches if one.stuck is not None), None)


def prove_coverage(activity: Activity, policy: Policy) -> CoverageProof | None:
    """Search all games that can occur under the policy's sure decisions.

    Args:
        activity: the activity to search.
        policy: the policy learnt so far.

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
    return search_groups(activity, shown)


def search_groups(
    activity: DeclaredActivity,
    shown: ShownMoves,
    limit: Limit = LIMIT,
    largest: Limit = LARGEST,
) -> CoverageProof:
    """Search all games of one to three players, or of the teams, under the demonstrations.

    Args:
        activity: the activity to search.
        shown: what follows in which situation.
        limit: the states of each search, and the CPU time of all of them in s.
        largest: the same for the largest group.
    """
    groups = [activity.teams] if activity.teams else [PLAYERS[:n] for n in (1, 2, 3)]
    until = thread_time() + limit.seconds
    searches: list[tuple[int, Reach]] = []
    for group in groups:
        one = largest if group == PLAYERS else limit
        left = Limit(one.states, min(one.seconds, until - thread_time()))
        searches.append((len(group), reach(activity.declaration, group, shown, left)))
        if not searches[-1][1].whole:
            break
    return CoverageProof(tuple(searches))
