"""The tally: totals of games in the document that `tangy play --json` prints."""

from __future__ import annotations

import json

import pytest

from tangy_profiles.activity import Activity
from tangy_profiles.beliefs import Beta, uniform_beliefs
from tangy_profiles.state import FRONT, ActivityState, Outcome, Response, Situation
from tangy_tui.interaction.game_events import Acted, BeliefUpdated, GameBegun, GameEnded
from tangy_tui.interaction.tally import Tally
from tangy_tui.learning.policy import Decision

START = Situation("start", "ANR", "occluded")
CALL = Situation("facilitate", "ANR", "occluded")
ODD = Situation("socialize", "AR", "bingo")


def acted(activity: Activity, situation: Situation, behaviour: str, right: bool = True) -> Acted:
    state = ActivityState(0, situation, FRONT, None, ())
    return Acted(
        1, state, Decision(behaviour, 1.0, ((behaviour, 1.0),), 3), None,
        activity.action(activity.behaviours[behaviour], None, None),
        Outcome(True, 31.0, (), None), state, "", "", right,
    )  # fmt: skip


@pytest.fixture
def tally(activity: Activity) -> Tally:
    counted = Tally()
    learnt = BeliefUpdated(Response("a", "praise", True, True, 3.0), Beta(2, 1))
    counted.add([GameBegun("g", 1, ActivityState(0, START, FRONT, None, ()))])
    counted.add([acted(activity, ODD, "joke"), acted(activity, CALL, "call number"), learnt])
    counted.add([acted(activity, CALL, "call number"), acted(activity, CALL, "joke", False)])
    counted.add([acted(activity, CALL, "call number", False), learnt, GameEnded("g", 5, None)])
    counted.add([GameEnded("h", 0, "Nobody knew.")])
    return counted


def test_games_steps_and_interactions_are_counted(tally: Tally) -> None:
    assert (tally.games, tally.steps, tally.interactions) == (2, 5, 2)
    assert tally.stopped == [(2, "Nobody knew.")]


def test_rows_come_in_the_given_order_with_instances_and_success(
    tally: Tally, activity: Activity
) -> None:
    rows = [
        (row.situation, row.behaviour, row.instances, round(row.success, 3))
        for row in tally.rows(activity.situations)
    ]
    assert rows == [
        (CALL, "call number", 3, 0.667),
        (CALL, "joke", 1, 0.0),
        (ODD, "joke", 1, 1.0),
    ]


def test_the_document_has_exactly_the_agreed_keys(tally: Tally, activity: Activity) -> None:
    beliefs = {"a": {**uniform_beliefs(["praise", "neutral"]), "praise": Beta(3, 1)}, "b": {}}
    document = tally.to_json(activity.situations, beliefs)
    assert json.loads(json.dumps(document)) == document
    assert list(document) == [
        "games", "steps", "behaviours", "rows", "interactions_per_user_game", "beliefs", "faults",
        "finished", "stopped", "asked", "pauses",
    ]  # fmt: skip
    assert document["behaviours"] == {"call number": 3, "joke": 2}
    assert list(document["rows"][0]) == [
        "stage", "request", "user_state", "behaviour", "instances", "success",
    ]  # fmt: skip
    assert document["interactions_per_user_game"] == 2 / (2 * 2)
    assert document["beliefs"]["a"] == {"praise": [3.0, 1.0], "neutral": [1.0, 1.0]}
    assert document["faults"] == [{"reason": "Nobody knew."}]


def test_an_empty_tally_has_zeros(activity: Activity) -> None:
    document = Tally().to_json(activity.situations, {})
    assert (document["games"], document["rows"], document["faults"]) == (0, [], [])
    assert document["interactions_per_user_game"] == 0


def test_games_that_ended_early_are_listed_with_what_was_due(activity: Activity) -> None:
    counted = Tally()
    counted.add([GameEnded("g", 5, None), GameEnded("h", 2, None, due="joke", rounds_left=4)])
    document = counted.to_json(activity.situations, {})
    assert document["ended_early"] == [{"game": 2, "due": "joke", "rounds_left": 4}]
