"""The log of a game: each step is written completely or not at all, before it is returned."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from typing import Any

import pytest

from tangy_profiles.codec import encode
from tangy_profiles.events import EventRecord
from tangy_profiles.game_records import GameBeginning, GameEnding, GameStep
from tangy_profiles.people_records import ResponseGiven
from tangy_profiles.store import Store
from tangy_tui.interaction.facilitation import Facilitation
from tangy_tui.interaction.game_events import Acted, BeliefUpdated, GameEnded
from tangy_tui.learning.policy import Policy
from tests.interaction.conftest import acts, play

Make = Callable[..., Facilitation]


def test_events_are_logged_before_they_are_returned(facilitate: Make, store: Store) -> None:
    facilitation = facilitate(6)
    facilitation.begin()
    kinds = {
        Acted: GameStep.KIND,
        BeliefUpdated: ResponseGiven.KIND,
        GameEnded: GameEnding.KIND,
    }
    told: list[str] = [GameBeginning.KIND]
    while not facilitation.over:
        told += [kinds[type(event)] for event in facilitation.step()]
        assert [event.kind for event in store.events()] == told


def test_the_log_replays_the_game(facilitate: Make, store: Store, policy: Policy) -> None:
    events = play(facilitate(7, users=2))
    begun = store.last(GameBeginning)
    assert begun is not None
    assert begun.body["policy"] == policy.digest
    assert (begun.body["seed"], begun.body["people"]) == (7, ["user1", "user2"])
    for act, kept in zip(acts(events), store.events(GameStep), strict=True):
        assert kept.body["behaviour"] == act.action.behaviour.name
        assert kept.body["target"] == act.action.target
        assert kept.body["strategy"] == act.action.strategy
        assert kept.body["numbers"] == list(act.outcome.numbers)
        assert kept.body["state"] == encode(act.state)
        assert (kept.body["draws"] or {}) == (dict(act.choice.draws) if act.choice else {})


def test_posteriors_are_restored_from_logged_responses(facilitate: Make, store: Store) -> None:
    first = facilitate(8)
    play(first, 5)
    assert store.responses()
    assert facilitate(9).persuasion.beliefs == first.persuasion.beliefs


def test_a_failed_step_leaves_no_part_in_the_log(
    facilitate: Make, store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    facilitation = facilitate(10)
    facilitation.begin()
    append = store.append

    def refuse(record: EventRecord, **row: Any) -> int:
        if isinstance(record, ResponseGiven):
            raise OSError("full")
        return append(record, **row)

    monkeypatch.setattr(store, "append", refuse)
    steps, beliefs = 0, deepcopy(facilitation.persuasion.beliefs)
    with pytest.raises(OSError, match="full"):
        while steps < 1000:
            steps += len(acts(facilitation.step() or facilitation.begin()))
    assert sum(1 for _ in store.events(GameStep)) == steps
    assert facilitation.persuasion.beliefs == beliefs
