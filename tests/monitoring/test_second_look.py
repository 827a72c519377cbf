"""The second look: an observation that contradicts the expectation is repeated first."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import pytest

from tangy_profiles.state import ActivityState, Situation, UserState
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.observation import MORE_LOOKS, Observation
from tangy_tui.interaction.reading_error import ReaderErrorRate
from tangy_tui.learning.policy import Policy
from tangy_tui.world import World
from tests.support.games import codes, ended, moves, play
from tests.support.odd_looks import ODD, OddCards, OddStates, OddWorld, StuckCards

GAMES = 12


def state(card: str) -> ActivityState:
    """Return the state beside a person with this card."""
    users = (UserState("user1", card, "AR"),)
    return ActivityState(3, Situation("help", "AR", card), "user1", "user1", users)


RIGHT, WRONG, OTHER = state("right"), state("wrong"), state("other")


class Eyes:
    """A world with a given series of looks; the last one repeats."""

    def __init__(self, looks: Sequence[ActivityState]) -> None:
        self.looks = list(looks)
        self.taken = 0

    def observe(self) -> ActivityState:
        self.taken += 1
        return self.looks[min(self.taken, len(self.looks)) - 1]


def after(*looks: ActivityState) -> tuple[ActivityState, int]:
    """Return the state that counts after a behaviour that should leave all right, and the looks."""
    eyes = Eyes(looks)
    seen = Observation(cast(World, eyes)).after(lambda one: one != RIGHT)
    return seen, eyes.taken


@pytest.mark.parametrize(
    ("looks", "seen", "taken"),
    [
        ((RIGHT,), RIGHT, 1),
        ((WRONG, RIGHT), RIGHT, 3),
        ((WRONG,), WRONG, 4),
        ((WRONG, WRONG, WRONG, RIGHT), RIGHT, 5),
        ((WRONG, WRONG, RIGHT), RIGHT, 4),
        ((WRONG, OTHER, RIGHT), RIGHT, 4),
        ((WRONG, OTHER, WRONG, OTHER, WRONG), WRONG, 6),
    ],
)
def test_a_contradiction_counts_only_after_a_second_look(
    looks: tuple[ActivityState, ...], seen: ActivityState, taken: int
) -> None:
    assert after(*looks) == (seen, taken)


def test_disagreeing_looks_are_bounded() -> None:
    _, taken = after(*(state(f"never {number}") for number in range(20)))
    assert taken == ReaderErrorRate().needed + MORE_LOOKS


@pytest.mark.slow
@pytest.mark.parametrize("odd", ODD)
@pytest.mark.parametrize("kind", [OddCards, OddStates])
def test_a_single_odd_look_causes_no_fault_and_no_request(
    kind: type[OddWorld], odd: str, workspace: Workspace, learnt: Policy
) -> None:
    world = kind(workspace.activity, list(workspace.names), seed=4, odd=odd, share=0.05)
    game = workspace.supervision(learnt, 4, asks=True, world=world)
    with workspace.store.transaction():
        told = [event for _ in range(GAMES) for event in play(game)]
    assert world.odd_looks > 5  # else the test shows nothing
    assert (codes(told), moves(told), world.accused) == ([], [], 0)


@pytest.mark.slow
@pytest.mark.parametrize("effect", ["clear wrong marks", "set missing marks"])
def test_a_persistently_wrong_reading_is_left_to_staff_once(
    effect: str, workspace: Workspace, learnt: Policy
) -> None:
    activity = workspace.activity
    (behaviour,) = (b.name for b in activity.behaviours.values() if b.effect == effect)
    (stuck,) = {s.user_state for s, name in activity.expected.items() if name == behaviour}
    world = StuckCards(activity, list(workspace.names), seed=5, odd="late", share=0.0)
    world.stuck = stuck
    game = workspace.supervision(learnt, 5, asks=True, world=world)
    told = []
    with workspace.store.transaction():
        for _ in range(GAMES):
            events = play(game)
            assert ended(events).stopped is None
            doubted = [fault for fault in game.faults if fault.code == "reading-doubtful"]
            told += doubted
            assert len(doubted) <= 1 and all(fault.person == world.person for fault in doubted)
            first = [fault.code for fault in game.faults if fault.person == world.person][:1]
            assert not doubted or first == ["unexplained"]  # a single look may be a different mark
            assert not any(fault.critical for fault in game.faults)
    assert len(told) >= 3  # else the test shows nothing
