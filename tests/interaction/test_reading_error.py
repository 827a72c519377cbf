"""The error rate of looks is learnt and stored, and sets how many looks must agree."""

from __future__ import annotations

from typing import cast

import pytest

from tangy_profiles.game_records import GameBeginning, GameEnding
from tangy_profiles.game_world import BENCH, LIVE, SIMULATED
from tangy_profiles.state import ActivityState, Situation, UserState
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.observation import Observation
from tangy_tui.interaction.reading_error import (
    LEAST,
    MOST,
    FusedObservation,
    ReaderErrorRate,
    learnt_error,
)
from tangy_tui.monitoring.evidence import evidence_words
from tangy_tui.world import World


@pytest.mark.parametrize(
    ("looks", "wrong", "needed"),
    [(0, 0, 4), (2000, 10, LEAST), (2000, 100, 4), (2000, 200, 5), (2000, 1900, MOST)],
)
def test_a_higher_error_rate_needs_more_agreeing_looks(looks: int, wrong: int, needed: int) -> None:
    assert ReaderErrorRate(looks, wrong).needed == needed


def state(card: str) -> ActivityState:
    users = (UserState("user1", card, "AR"),)
    return ActivityState(3, Situation("help", "AR", card), "user1", "user1", users)


class Eyes:
    """A world with a given series of looks."""

    def __init__(self, *looks: str) -> None:
        self.looks = [state(look) for look in looks]

    def observe(self) -> ActivityState:
        return self.looks.pop(0)


def test_overruled_looks_count_as_wrong() -> None:
    eyes = Eyes("wrong", "right", "right", "right", "right")
    observation = Observation(cast(World, eyes))
    observation.after(lambda seen: seen != state("right"))
    assert (observation.counted.looks, observation.counted.wrong) == (3, 1)
    observation.after(lambda seen: seen != state("right"))
    assert (observation.counted.looks, observation.counted.wrong) == (4, 1)
    assert observation.fused is None, "nothing contradicted this time"


def test_a_fused_look_counts_its_agreeing_looks() -> None:
    observation = Observation(cast(World, Eyes("wrong", "right", "wrong", "wrong", "wrong")))
    observation.after(lambda seen: seen != state("right"))
    assert observation.fused is not None
    assert (observation.fused.agreeing, observation.fused.taken) == (4, 5)


def test_a_diagnosis_includes_the_certainty_of_its_looks(workspace: Workspace) -> None:
    words = evidence_words({}, (), workspace.robot, (), FusedObservation(4, 5, 0.005))
    assert "4 of 5" in words and "1 in 200" in words


def test_the_error_rate_is_stored_for_each_activity_and_world(workspace: Workspace) -> None:
    store = workspace.store

    def play(game: str, activity: str, world: str, looks: int, wrong: int) -> None:
        store.append(
            GameBeginning(
                game=game, number=1, activity=activity, policy="p", seed=1,
                people=("user1",), world=world,  # type: ignore[arg-type]
            )
        )  # fmt: skip
        store.append(GameEnding(game=game, steps=1, stopped=None, looks=looks, looks_wrong=wrong))

    play("a", "bingo", LIVE, 100, 5)
    play("b", "bingo", LIVE, 50, 1)
    play("c", "bingo", BENCH, 70, 70)
    play("d", "memory", LIVE, 30, 30)
    assert learnt_error(store, "bingo", LIVE) == ReaderErrorRate(150, 6)
    assert learnt_error(store, "bingo", SIMULATED) == ReaderErrorRate()
