"""Plan of a guided game: covered situations, missing ones, and the next one.

It only knows the activity; cards and people belong to the guided world.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import calling
from tangy_profiles.cards import CardState
from tangy_profiles.state import Situation
from tangy_profiles.tracker import Tracker

LINE = "complete line"
"""Checker of a winning card, which must not occur before everything else was shown."""

DRAWN = (LINE, "missing marks")
"""Checkers of states that need called numbers."""

SPAN = 18
"""Calls over which visits are spread in an activity without its own count."""

FEWEST, MOST = 2, 6
"""Calls between the end of one request and the next."""


@dataclass
class Cue:
    """A person's cue: the state that their card is to show, and the earliest call for asking.

    `hidden` says that the card is out of view when the robot arrives. Mistakes are made from the
    call of the cue on.
    """

    person: str
    shows: CardState
    hidden: bool
    asks_at: int
    asked: bool = False


class GuidedPlan:
    """Situations of an activity shown in one game, the missing ones, and the next one."""

    def __init__(self, activity: Activity, uniform: Callable[[], float]) -> None:
        self.activity = activity
        self.shown: dict[Situation, None] = {}
        self.tried: Counter[str] = Counter()
        """Number of cues for each user state."""
        rules = activity.stage_rules
        self._reading = {r.stage for r in rules if r.condition == "beside requester"}
        self._travel = {r.stage for r in rules if r.condition == "requested or away"}
        self._ends = [r for r in rules if r.condition == "after"]
        self._closing = {r.stage for r in self._ends}
        self._final = {n for r in self._ends for n in activity.behaviours[r.behaviour].needs}
        self._final.discard(activity.unread)
        self.drawing = calling(activity.behaviours)
        able = [s for s in activity.card_states if self.drawing or s.checker not in DRAWN]
        rank = {s.name: uniform() + (s.checker == LINE) for s in able}
        self._kinds = sorted(able, key=lambda state: rank[state.name])
        counted = [
            r.at_least for r in rules if r.condition == "count" and r.behaviour in self.drawing
        ]
        self.span = min(counted, default=SPAN)

    def show(self, situation: Situation) -> None:
        """Record that the teacher acts in a situation."""
        self.shown[situation] = None

    @property
    def lacking(self) -> tuple[Situation, ...]:
        """Situations in which the teacher has not acted yet."""
        return tuple(s for s in self.activity.situations if s not in self.shown)

    @property
    def lacks_hidden(self) -> bool:
        """Whether no card was out of view yet when the robot arrived."""
        return any(s.stage in self._reading and self._unread(s) for s in self.lacking)

    def visits(self) -> list[CardState]:
        """Return the missing card states, in the order of showing them.

        States that can end the game are excluded; those tried in vain come later, and a full line
        last, because a card with a full line shows no other state.
        """
        lacking = {s.user_state for s in self.lacking if s.stage in self._reading}
        ordinary = [s for s in self._kinds if s.name not in self._final]
        found = [state for state in ordinary if state.name in lacking]
        if not [s for s in found if s.checker != LINE] and self._lacks_visit():
            found[:0] = ordinary[:1]  # any visit will do
        return sorted(found, key=lambda state: (state.checker == LINE, self.tried[state.name]))

    def wanted(self, spent: bool) -> CardState | None:
        """Return the card state of the next cue; None if only calls are missing.

        Args:
            spent: whether only an ending can still occur (no numbers are left).
        """
        visits = self.visits()
        final = [s for s in self._kinds if s.name in self._final]
        if final and (spent or not self._lacks_other()):
            return final[-1]
        return visits[0] if visits else None

    def ended(self, tracker: Tracker) -> bool:
        """Return whether the behaviour before an `after` stage was executed."""
        return any(tracker.count(rule.behaviour) for rule in self._ends)

    def ends_freely(self, tracker: Tracker) -> bool:
        """Return whether the game has ended in a way that requires no open request."""
        done = [rule for rule in self._ends if tracker.count(rule.behaviour)]
        return any(not self.activity.leaves_request(rule) for rule in done)

    def hides(self, share: float, chance: float) -> bool:
        """Return whether the next card is to be out of view when the robot arrives.

        Args:
            share: a random number from 0 to 1; below `chance` it hides the card.
            chance: probability of hidden cards; the last possible card is hidden anyway.
        """
        others = [state for state in self.visits() if state.checker != LINE]
        return self.lacks_hidden and (len(others) < 2 or share < chance)

    def gap(self, calls: int, share: float) -> int:
        """Return the number of calls until the next visit: visits are spread evenly over the game.

        Args:
            calls: number of calls in this game.
            share: a random number from 0 to 1 that varies the gap by up to a quarter.
        """
        even = (self.span - calls) / (len(self.visits()) + 1)
        return max(FEWEST, min(MOST, round(even * (0.75 + share / 2))))

    def _unread(self, situation: Situation) -> bool:
        return situation.user_state == self.activity.unread

    def _lacks_visit(self) -> bool:
        """Whether a visit is needed for another reason than the state of a card."""
        return self.lacks_hidden or any(s.stage in self._travel for s in self.lacking)

    def _lacks_other(self) -> bool:
        """Whether anything but the end of the game and its cause is missing."""
        return any(
            s.stage not in self._closing and s.user_state not in self._final for s in self.lacking
        )
