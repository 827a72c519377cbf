"""The plan of a guided game: covered situations, missing ones, and the next one.

It knows the activity alone. Cards and people are the guided world's.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

from tangy_profiles.activity import Activity
from tangy_profiles.cards import CardState
from tangy_profiles.state import Situation
from tangy_profiles.tracker import Tracker

LINE = "complete line"
"""The checker of a card that has won; nobody's card shall before all else was shown."""

DRAWN = (LINE, "missing marks")
"""The checkers of what no card shows before a number was called."""

SPAN = 18
"""Calls over which visits are spread in an activity that counts none itself."""

FEWEST, MOST = 2, 6
"""Calls from the end of one request to the next one."""


@dataclass
class Cue:
    """What one person is to show: a state of their card, and from which call on they ask.

    `hidden`: their card is out of view when the robot arrives. They err, if they are to, from
    the call on in which they got the cue.
    """

    person: str
    shows: CardState
    hidden: bool
    asks_at: int
    asked: bool = False


class GuidedPlan:
    """The situations of an activity shown in one game, the missing ones, and the next one."""

    def __init__(self, activity: Activity, uniform: Callable[[], float]) -> None:
        self.activity = activity
        self.shown: dict[Situation, None] = {}
        self.tried: Counter[str] = Counter()
        """How often somebody got the cue to show a user state."""
        rules = activity.stage_rules
        self._reading = {r.stage for r in rules if r.condition == "beside requester"}
        self._travel = {r.stage for r in rules if r.condition == "requested or away"}
        self._ends = [r for r in rules if r.condition == "after"]
        self._closing = {r.stage for r in self._ends}
        self._final = {n for r in self._ends for n in activity.behaviours[r.behaviour].needs}
        self._final.discard(activity.unread)
        self.drawing = {b.name for b in activity.behaviours.values() if b.effect == "draw"}
        able = [s for s in activity.card_states if self.drawing or s.checker not in DRAWN]
        rank = {s.name: uniform() + (s.checker == LINE) for s in able}
        self._kinds = sorted(able, key=lambda state: rank[state.name])
        counted = [
            r.at_least for r in rules if r.condition == "count" and r.behaviour in self.drawing
        ]
        self.span = min(counted, default=SPAN)

    def show(self, situation: Situation) -> None:
        """Note that the teacher acts in a situation."""
        self.shown[situation] = None

    @property
    def lacking(self) -> tuple[Situation, ...]:
        """The situations in which the teacher has not acted yet."""
        return tuple(s for s in self.activity.situations if s not in self.shown)

    @property
    def lacks_hidden(self) -> bool:
        """Whether nobody's card was out of view yet when the robot came."""
        return any(s.stage in self._reading and self._unread(s) for s in self.lacking)

    def visits(self) -> list[CardState]:
        """Return the states that cards are still to be seen in, in the order of showing them.

        A state that can end the game is not among them; what was tried in vain comes after the
        others, and a full line last, because a card that has one shows nothing else any more.
        """
        lacking = {s.user_state for s in self.lacking if s.stage in self._reading}
        ordinary = [s for s in self._kinds if s.name not in self._final]
        found = [state for state in ordinary if state.name in lacking]
        if not [s for s in found if s.checker != LINE] and self._lacks_visit():
            found[:0] = ordinary[:1]  # any visit will do
        return sorted(found, key=lambda state: (state.checker == LINE, self.tried[state.name]))

    def wanted(self, spent: bool) -> CardState | None:
        """Return the next situation for a person's card; None while only calls are missing.

        Args:
            spent: nothing but an end can occur any more (no numbers are left to show it).
        """
        visits = self.visits()
        final = [s for s in self._kinds if s.name in self._final]
        if final and (spent or not self._lacks_other()):
            return final[-1]
        return visits[0] if visits else None

    def ended(self, tracker: Tracker) -> bool:
        """Say whether what an `after` stage comes after has been done."""
        return any(tracker.count(rule.behaviour) for rule in self._ends)

    def ends_freely(self, tracker: Tracker) -> bool:
        """Say whether it has ended in a way in which nobody's request has to be open."""
        done = [rule for rule in self._ends if tracker.count(rule.behaviour)]
        return any(not self.activity.leaves_request(rule) for rule in done)

    def hides(self, share: float, chance: float) -> bool:
        """Say whether the next card is to be out of view when the robot arrives.

        Args:
            share: a number from 0 to 1, which hides it if it is below `chance`.
            chance: how often cards are out of view; the last that can be, is in any case.
        """
        others = [state for state in self.visits() if state.checker != LINE]
        return self.lacks_hidden and (len(others) < 2 or share < chance)

    def gap(self, calls: int, share: float) -> int:
        """Return how many calls to let pass: visits are spread evenly over the rest of the game.

        Args:
            calls: how many there were in this game.
            share: a number from 0 to 1 that makes it shorter or longer by up to a quarter.
        """
        even = (self.span - calls) / (len(self.visits()) + 1)
        return max(FEWEST, min(MOST, round(even * (0.75 + share / 2))))

    def _unread(self, situation: Situation) -> bool:
        return situation.user_state == self.activity.unread

    def _lacks_visit(self) -> bool:
        """Whether a visit must be made for another reason than the state of a card."""
        return self.lacks_hidden or any(s.stage in self._travel for s in self.lacking)

    def _lacks_other(self) -> bool:
        """Whether anything lacks but the end of the game and what brings it about."""
        return any(
            s.stage not in self._closing and s.user_state not in self._final for s in self.lacking
        )
