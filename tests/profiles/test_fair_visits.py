"""Nobody waits for ever: neither those who ask nor those who do not."""

from __future__ import annotations

from random import Random

from hypothesis import given, settings
from hypothesis import strategies as st

from tangy_profiles.activity import load_activity
from tangy_profiles.game_records import GameChange
from tangy_profiles.game_rules import GamePlan
from tangy_profiles.past_game import OpenRequests
from tangy_profiles.planned_game import PlannedGame
from tangy_profiles.state import FRONT
from tangy_profiles.tracker import Tracker

BINGO = load_activity("bingo")
LIMIT = BINGO.rules.unvisited
VISIT, CALL = 30.0, 4.0
"""The duration of a visit and of a call, in s."""


class Group(PlannedGame):
    """A game in which the robot does what its rules say, and each visit closes a request."""

    def __init__(self, count: int) -> None:
        self.activity, self.own_deck, self.pace = BINGO, BINGO.deck, 20.0
        self.people = tuple(f"user{number}" for number in range(1, count + 1))
        self.tracker = Tracker(BINGO, self.people)
        self.tracker.executed(BINGO.behaviours["greeting"])
        self.calls = 0
        self.time = 0.0
        self.served: list[str] = []
        self.choose(GamePlan(visits=True))
        self.begin_plan()

    @property
    def seconds(self) -> float:
        return self.time

    @property
    def called_now(self) -> tuple[int, ...]:
        return tuple(range(1, self.calls + 1))

    @property
    def known_cards(self) -> dict[str, int]:
        return {}

    def settle(self) -> None:
        """Apply what is due."""
        while (due := self.due) is not None:
            change = GameChange(
                game="", steps=0, what=due.what, person=due.person, number=due.number
            )
            self.change(change)

    def step(self) -> None:
        """Do the next step: visit the first in the queue, or call a number."""
        self.settle()
        if self.tracker.queue and not self.tracker.calls_first:
            person = self.tracker.queue[0]
            self.tracker.arrive(person)
            self.settle()
            self.tracker.withdraw(person)
            self.served.append(person)
            self.time += VISIT
        else:
            self.tracker.arrive(FRONT)
            self.calls += 1
            self.tracker.executed(BINGO.behaviours["call number"])
            self.time += CALL


@settings(max_examples=25, deadline=None)
@given(count=st.integers(5, 12), seed=st.randoms(use_true_random=False))
def test_nobody_waits_for_ever_asked_or_not(count: int, seed: Random) -> None:
    group, since = Group(count), dict[str, int]()
    rule = BINGO.rules.calls_first
    assert rule is not None
    quiet = group.people[-2:]  # they never ask; the others ask all the time
    longest = dict.fromkeys(quiet, 0)
    for _ in range(200):
        if group.calls >= len(BINGO.deck.numbers) - 1:
            break
        others = [*group.people[:-2]]
        seed.shuffle(others)
        for person in others:
            if person != group.tracker.place and group.tracker.ask(person):
                since[person] = len(group.served)
        group.step()
        if group.served and (last := group.served[-1]) in since:
            assert len(group.served) - since.pop(last) <= count  # each other person once at most
        for person in quiet:
            longest[person] = max(longest[person], group.calls_unvisited(person))
    row = rule.calls * (count // rule.visits + 1)  # the calls while the queue is served once
    assert all(0 < waited <= LIMIT + row for waited in longest.values())
    assert {*quiet} <= {*group.served}


def test_a_visit_that_waits_for_calls_stays_one_without_a_request() -> None:
    requests = OpenRequests()
    requests.change(GameChange(game="", steps=0, what="calls first", number=2))
    requests.change(GameChange(game="", steps=0, what="visit", person="user3"))
    assert requests.people == {"user3"}


def test_who_passed_the_limit_comes_before_those_who_ask_later() -> None:
    group = Group(6)
    group.calls = LIMIT
    group.tracker.ask("user2")
    group.settle()
    group.tracker.ask("user1")
    others = ["user1", "user3", "user4", "user5", "user6"]
    assert group.tracker.queue == ["user2", *others]
    assert group.visiting == tuple(others)
    group.step()
    group.settle()
    assert group.served == ["user2"]
