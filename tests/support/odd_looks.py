"""Simulated worlds in which single looks are sometimes late, misread or unreadable.

The look is wrong, not the world: the next look may be right. In `OddCards`, each reading of a
card is a look; in `OddStates`, each observation of the whole state.
"""

from __future__ import annotations

from random import Random
from typing import Any

from tangy_profiles.behaviour import Action
from tangy_profiles.state import ActivityState, Outcome, UserState
from tangy_sim.worlds.faulty_world import FaultyWorld

LATE, MISREAD, UNREADABLE = "late", "misread", "unreadable"
ODD = (LATE, MISREAD, UNREADABLE)


class OddWorld(FaultyWorld):
    """The common part of both: how a look is odd, how often, and the counts."""

    def __init__(self, *what: Any, odd: str, share: float, **more: Any) -> None:
        """Prepare it; `odd` is one of ODD, `share` is the share of odd looks."""
        self.odd, self.share = odd, share
        self.looks = self.odd_looks = self.accused = 0
        super().__init__(*what, **more)
        self._by_chance = Random(f"{more['seed']}/looks")

    def execute(self, action: Action) -> Outcome:
        """Carry it out; count people who are asked to correct a right card."""
        wrong = action.behaviour.clears_marks
        player = self.players.get(self.tracker.place)
        if player is not None and (wrong or action.behaviour.sets_marks):
            marked, called = player.marked, player.called
            self.accused += not (marked & ~called if wrong else called & ~marked)
        return super().execute(action)

    def is_odd(self) -> bool:
        """Draw whether a look is odd."""
        self.looks += 1
        now = self._by_chance.random() < self.share
        self.odd_looks += now
        return now

    def misread(self, state: str) -> str:
        """Return another state of a card."""
        others = [one.name for one in self.activity.card_states if one.name != state]
        return others[int(self._by_chance.random() * len(others))]


class OddCards(OddWorld):
    """A world in which single readings of cards are odd."""

    def read_card(self) -> None:
        before = self.tracker.seen
        super().read_card()
        seen = self.tracker.seen
        if seen is not None and self.is_odd():
            new = {LATE: before, UNREADABLE: None, MISREAD: self.misread(seen)}
            self.tracker.seen = new[self.odd]


class OddStates(OddWorld):
    """A world in which single observations are odd."""

    def begin(self) -> ActivityState:
        """Begin a game."""
        self._now_so: ActivityState | None = None
        self._was_so: ActivityState | None = None
        return super().begin()

    def observe(self) -> ActivityState:
        """Return the observed state, which is sometimes wrong or out of date."""
        state = super().observe()
        if state != self._now_so:
            self._was_so, self._now_so = self._now_so, state
        if self.over or not self.is_odd():
            return state
        if self.odd == LATE:
            return self._was_so or state
        attended, unread = state.attended, self.activity.unread
        if attended is None or state.user(attended).activity == unread:
            return state
        seen = unread if self.odd == UNREADABLE else self.misread(state.user(attended).activity)
        users = (
            UserState(user.id, seen, user.request) if user.id == attended else user
            for user in state.users
        )
        situation = state.situation._replace(user_state=seen)
        return state._replace(situation=situation, users=tuple(users))


class StuckCards(OddWorld):
    """A world that reads one person's card as in one state, whatever its true state."""

    person = "user2"
    stuck = ""

    def read_card(self) -> None:
        super().read_card()
        if self.tracker.place == self.person and self.tracker.seen is not None and self.stuck:
            self.tracker.seen = self.stuck
