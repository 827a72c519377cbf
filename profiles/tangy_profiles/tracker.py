"""The rule-based tracker of stage, turn, and open requests.

Observed events (a button was pressed, the robot arrived, a card was read, a behaviour succeeded) go
in, and the activity state comes out. The stage rules are the activity's data. Both worlds use this
tracker, and nothing in it is learnt.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

from tangy_profiles.activity import Activity, StageRule
from tangy_profiles.behaviour import Behaviour
from tangy_profiles.game_records import GameStep
from tangy_profiles.state import FRONT, ActivityState, Request, Situation, UserState

READS = ("beside requester",)
"""The conditions of stages in which the robot reads the card beside it."""

ATTENDS = ("beside requester", "requested or away", "after")
"""The conditions of stages in which open requests matter."""


MOST_POSSIBLE = 8
"""The most kinds of progress that are followed at the same time."""


class _Progress(NamedTuple):
    """All that changes in a tracker during a game."""

    counts: dict[str, int]
    since: dict[tuple[str, str], int]
    queue: list[str]
    numbers: tuple[int, int, int]
    here: tuple[str, str | None, str | None]


class Tracker:
    """The rule-based part of the activity state of one game."""

    def __init__(self, activity: Activity, people: Sequence[str]) -> None:
        self._activity = activity
        self._unread = activity.unread
        self.people = tuple(people)
        self.place = FRONT
        self.queue: list[str] = []
        """The ids of those who ask for help, first come first served."""
        self.seen: str | None = None
        """The user activity state read from the card beside the robot, or None."""
        self.closed: str | None = None
        """The person whose request the last behaviour closed."""
        self.visits = 0
        """How many people the robot has visited since the last call."""
        self.calls_first = 0
        """How many calls come before requests, which wait meanwhile."""
        self.step = 0
        self._counts = dict.fromkeys(activity.behaviours, 0)
        self._since = {
            (r.behaviour, r.since): 0 for r in activity.stage_rules if r.condition == "count"
        }
        self._rules = [(self._test(rule), rule.stage) for rule in activity.stage_rules]
        self._openers = [r.behaviour for r in activity.stage_rules if r.condition == "before"]
        self._closers = [r.behaviour for r in activity.stage_rules if r.condition == "after"]
        self._reading = {r.stage for r in activity.stage_rules if r.condition in READS}
        self._attending = {r.stage for r in activity.stage_rules if r.condition in ATTENDS}
        self._settled = activity.user_states[-1].name
        self._situations: dict[tuple[str, str, str], Situation] = {
            s: s for s in activity.situations
        }
        self._possible: list[_Progress] = []
        """What else fits the log that is being followed."""
        self._idle = tuple(UserState(id, self._unread, "ANR") for id in self.people)
        self._users = self._idle
        self._users_key: tuple[str, ...] = ()

    def _test(self, rule: StageRule) -> Callable[[], bool]:
        counts, since, name = self._counts, self._since, rule.behaviour
        match rule.condition:
            case "before":
                return lambda: not counts[name]
            case "after":
                return lambda: counts[name] > 0
            case "beside requester":
                return lambda: self.place in self.queue and not self.calls_first
            case "requested or away":
                return lambda: (bool(self.queue) and not self.calls_first) or self.place != FRONT
            case "count":
                pair = (name, rule.since)
                return lambda: since[pair] >= rule.at_least
            case _:
                return lambda: True

    @property
    def finished(self) -> bool:
        """Whether the goal of the game was reached: only its `after` stage is left."""
        return any(self._counts[name] for name in self._closers)

    def set_aside(self, person: str) -> None:
        """Continue a game that a person finished, and remove their request."""
        for name in self._closers:
            self._counts[name] = 0
        if person in self.queue:
            self.queue.remove(person)
        self.seen = self.closed = None

    def begun(self) -> bool:
        """Return whether all `before` behaviours (a greeting) were done."""
        return all(self._counts[name] for name in self._openers)

    def count(self, behaviour: str) -> int:
        """Return how often a behaviour has succeeded in this game."""
        return self._counts[behaviour]

    def ask(self, person: str) -> bool:
        """Add a person's request; return False if it was open already."""
        if person in self.queue:
            return False
        self.queue.append(person)
        return True

    def first(self, person: str) -> None:
        """Move a person's request to the head of the queue."""
        if person in self.queue:
            self.queue.remove(person)
            self.queue.insert(0, person)

    def withdraw(self, person: str) -> None:
        """Remove the request of a person who no longer asks, without having been helped."""
        if person in self.queue:
            self.queue.remove(person)

    def arrive(self, place: str) -> None:
        """Record that the robot arrived at a place, where no card has been read yet."""
        if place not in (FRONT, self.place):
            self.visits += 1
            self.calls_first = 0
        self.place = place
        self.seen = None

    def allows(self, behaviour: Behaviour) -> bool:
        """Return whether a behaviour can succeed here: a win is celebrated only beside a winner."""
        return not behaviour.needs or (self.place in self.queue and self.seen in behaviour.needs)

    def executed(self, behaviour: Behaviour, *, succeeded: bool = True) -> None:
        """Count an executed behaviour, and close the request that it settled.

        Set the place and the card's new state first: a request that closes "when correct" depends
        on the card after the behaviour. A failed behaviour only counts as a step.
        """
        self.step += 1
        self.closed = None
        if not succeeded:
            return
        name = behaviour.name
        self._counts[name] += 1
        if behaviour.calls:
            self.visits, self.calls_first = 0, max(0, self.calls_first - 1)
        for pair in self._since:
            if name == pair[0]:
                self._since[pair] += 1
            elif name == pair[1]:
                self._since[pair] = 0
        if self.place in self.queue and (
            behaviour.closes == "always"
            or (behaviour.closes == "when correct" and self.seen == self._settled)
        ):
            self.queue.remove(self.place)
            self.closed = self.place
            self.seen = None

    def follow(self, step: GameStep) -> bool:
        """Apply a step from the log; return whether the resulting state is the logged one.

        A behaviour without success is not counted. Only the state reveals that, and sometimes only
        a later one, so all that is possible so far is followed. One that named numbers succeeded.
        """
        behaviour, after = self._activity.behaviours.get(step.behaviour), step.after
        if behaviour is None or after is None:
            return False
        certain = step.completed and step.numbers
        outcomes = (True,) if certain else dict.fromkeys((step.completed, False))
        found: list[_Progress] = []
        for before in (self._progress(), *self._possible):
            for succeeded in outcomes:
                self._go_to(before)
                self._see(behaviour, after, succeeded=succeeded)
                now = self._progress()
                if self.state() == after and not any(map(partial(self._alike, now), found)):
                    found.append(now)
        if found:
            self._go_to(found[0])
        self._possible = found[1:MOST_POSSIBLE]
        return bool(found)

    def _progress(self) -> _Progress:
        return _Progress(
            {**self._counts},
            {**self._since},
            [*self.queue],
            (self.step, self.visits, self.calls_first),
            (self.place, self.seen, self.closed),
        )

    def _alike(self, one: _Progress, other: _Progress) -> bool:
        """Return whether two kinds of progress lead to the same stages from here on."""
        names = (*self._openers, *self._closers)
        return one[1:] == other[1:] and all(one.counts[n] == other.counts[n] for n in names)

    def _go_to(self, progress: _Progress) -> None:
        self._counts.update(progress.counts)
        self._since.update(progress.since)
        self.queue = [*progress.queue]
        self.step, self.visits, self.calls_first = progress.numbers
        self.place, self.seen, self.closed = progress.here

    def _see(self, behaviour: Behaviour, after: ActivityState, *, succeeded: bool) -> None:
        """Count a behaviour, and take requests and card from the state after it."""
        self.arrive(after.place)
        self.executed(behaviour, succeeded=succeeded)
        if self.calls_first:  # requests are hidden meanwhile, but stay open
            return
        asking = [user.id for user in after.users if user.request == "AR"]
        self.queue = [person for person in self.queue if person in asking]
        self.queue += [person for person in asking if person not in self.queue]
        self.closed, first = after.closed, after.attended
        if first is None or first not in self.queue:
            return
        shown = after.user(first).activity
        if after.place == first:
            self.seen = shown if shown != self._unread else None
        else:  # the attended one is at the head
            self.queue.remove(first)
            self.queue.insert(0, first)

    def state(self) -> ActivityState:
        """Return the current joint state."""
        for holds, stage in self._rules:  # noqa: B007 - the last rule always holds
            if holds():
                break
        queue, place = [] if self.calls_first else self.queue, self.place
        if not queue or stage not in self._attending:
            situation = self._situation(stage, "ANR", self._unread)
            return ActivityState(self.step, situation, place, None, self._idle, self.closed)
        beside = place in queue
        attended = place if beside else queue[0]
        shown = (self.seen if beside and stage in self._reading else None) or self._unread
        key = (attended, shown, *queue)
        if key != self._users_key:
            self._users_key = key
            self._users = tuple(
                UserState(
                    id,
                    shown if id == attended else self._unread,
                    "AR" if id in queue else "ANR",
                )
                for id in self.people
            )
        situation = self._situation(stage, "AR", shown)
        return ActivityState(self.step, situation, place, attended, self._users, self.closed)

    def _situation(self, stage: str, request: Request, user_state: str) -> Situation:
        known = self._situations.get((stage, request, user_state))  # hashes as the tuple
        return known or Situation(stage, request, user_state)
