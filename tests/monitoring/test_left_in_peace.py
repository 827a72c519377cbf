"""Limits of requests: Tangy gives up on people who do not comply, seen or unseen."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from itertools import pairwise
from random import Random

import pytest

from tangy_profiles.activity_parts import AskingLimits
from tangy_profiles.fault_file import load_faults
from tangy_profiles.robot import load_robot
from tangy_sim.worlds import faulty_world
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Acted
from tangy_tui.interaction.persuasion import Persuasion
from tangy_tui.monitoring.fault import Diagnosed, Moved
from tangy_tui.monitoring.games import read_games
from tangy_tui.monitoring.supervision import Event
from tests.monitoring.conftest import Supervise
from tests.support.games import codes, ended, play, vain_requests

MOST = 3
"""Requests that a person who refuses hears in a visit."""


@pytest.mark.parametrize("kind", ["never-complies@8", "card-out-of-sight~1"])
@pytest.mark.parametrize("seed", range(1, 9))
def test_a_visit_has_at_most_three_requests_in_vain(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch, kind: str, seed: int
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 0.0)
    events = play(supervise(kind, seed=seed))
    visits = Counter(one.visit for one in vain_requests(events))
    assert max(visits.values(), default=0) <= MOST
    assert ended(events).stopped is None


@pytest.mark.parametrize("seed", range(1, 13))
def test_a_card_hidden_after_a_request_counts_as_in_vain(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch, seed: int
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 0.0)
    events = play(supervise("never-complies@8", "card-out-of-sight~.3", seed=seed))
    visits = Counter(one.visit for one in vain_requests(events))
    assert max(visits.values(), default=0) <= MOST
    assert ended(events).stopped is None


@pytest.mark.parametrize("seed", [18, 19])
def test_a_card_that_comes_back_does_not_begin_the_count_of_the_visit_anew(
    supervise: Supervise, seed: int
) -> None:
    events = play(supervise("never-complies@8", "card-out-of-sight~.3", seed=seed))
    assert any(one.move.kind == "recovered" for one in events if isinstance(one, Moved))
    visits = Counter(one.visit for one in vain_requests(events))
    assert max(visits.values()) == MOST
    assert ended(events).stopped is None


@pytest.mark.slow
@pytest.mark.parametrize("beside", ["arm-failed@3", "requests-silent@3", "voice-dead@3"])
def test_other_faults_do_not_raise_the_limit_of_requests(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch, beside: str
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 0.0)
    for seed in range(1, 7):
        events = play(supervise("card-out-of-sight~1", beside, seed=seed))
        visits = Counter(one.visit for one in vain_requests(events))
        assert max(visits.values(), default=0) <= MOST


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["never-complies@8", "card-out-of-sight~1"])
def test_pressing_strategies_are_not_used_after_a_refusal(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 0.0)
    pressed, refusals = [], 0
    for seed in range(1, 25):
        game = supervise(kind, seed=seed)
        refused: set[int] = set()
        for visit, _, strategy in vain_requests(play(game)):
            refusals += visit in refused
            pressed += [strategy] if visit in refused else []
            refused.add(visit)
    assert refusals > 20
    assert not set(pressed) & set(game.world.activity.pressing)


@pytest.mark.parametrize("seed", [2, 7, 9])
def test_an_unseen_response_counts_as_a_refusal(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch, seed: int
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 0.0)
    events = play(supervise("card-out-of-sight~1", seed=seed))
    assert "never-complies" in codes(events)


@pytest.mark.slow
def test_a_repeated_refusal_with_a_hidden_card_is_no_new_card_fault(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 0.0)
    again = 0
    for seed in range(1, 13):
        told: Counter[tuple[str, str | None]] = Counter()
        for event in play(supervise("card-out-of-sight~1", seed=seed)):
            if isinstance(event, Diagnosed) and event.fault.person is not None:
                fault = event.fault
                hidden = fault.code == "card-out-of-sight" and fault.behaviour == "move card closer"
                if hidden:
                    assert not told["never-complies", fault.person]
                again += fault.code == "never-complies" and told[fault.code, fault.person] > 0
                told[fault.code, fault.person] += 1
    assert again > 3  # from people who asked again and refused again


@pytest.mark.slow
def test_a_covered_camera_is_no_refusal(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 0.0)
    for seed in range(1, 13):
        assert "never-complies" not in codes(play(supervise("camera-occluded@3", seed=seed)))


def test_the_game_continues_after_a_person_is_left_in_peace(supervise: Supervise) -> None:
    events = play(supervise("never-complies@8", seed=5))
    last = max(n for n, e in enumerate(events) if isinstance(e, Moved) and e.move.speech)
    assert any(isinstance(e, Acted) and e.outcome.numbers for e in events[last:])
    said = [
        e.move.speech for e in events if isinstance(e, Moved) and e.fault.code == "never-complies"
    ]
    assert any("all right" in words for words in said)


def test_a_choice_can_exclude_strategies() -> None:
    people = Persuasion(["a"], ["calm", "pressing"], Random(1))
    assert {people.choose("a", ["pressing"]).strategy for _ in range(50)} == {"calm"}
    assert {people.choose("a").strategy for _ in range(50)} == {"calm", "pressing"}


def asked(events: list[Event], person: str) -> int:
    """Count the requests in a game that a person refused, by behaviours and aloud."""
    found = 0
    for event in events:
        if isinstance(event, Acted):
            response, behaviour = event.outcome.response, event.action.behaviour
            asks = behaviour.persuades and not behaviour.only_talks
            here = event.state.attended == person == event.after.place
            found += asks and here and not (response and response.followed)
        elif isinstance(event, Moved) and event.move.kind == "asked":
            found += event.fault.person == person
    return found


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(1, 13))
def test_a_game_has_at_most_six_requests_in_vain_for_a_person(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch, seed: int
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 0.0)
    game = supervise("never-complies@4", "card-out-of-sight~1", seed=seed)
    events = play(game)
    most = max(asked(events, person) for person in game.world.people)
    assert most <= game.world.activity.asking.game
    assert ended(events).stopped is None


@pytest.mark.slow
def test_an_activity_can_lower_the_limits_of_requests(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 0.0)
    for seed in range(1, 9):
        game = supervise("card-out-of-sight~1", seed=seed)
        limits = AskingLimits(visit=2, game=3)
        activity = replace(game.world.activity, asking=limits)
        game.detector.activity = activity
        events = play(game)
        assert max(Counter(one.visit for one in vain_requests(events)).values(), default=0) <= 2
        assert max(asked(events, person) for person in game.world.people) <= 3


@pytest.mark.slow
def test_no_sentence_is_repeated_in_succession(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 0.0)
    pairs = 0
    for seed in range(1, 13):
        said: list[tuple[int, str]] = []
        visit = 0
        for event in play(supervise("never-complies@8", "card-out-of-sight~.3", seed=seed)):
            if isinstance(event, Acted):
                visit += event.state.place != event.after.place
                if event.action.target is not None and event.action.behaviour.persuades:
                    said.append((visit, event.speech))
            elif isinstance(event, Moved) and event.move.kind == "asked" and event.fault.person:
                said.append((visit, event.move.speech))
        pairs += sum(one[0] == two[0] for one, two in pairwise(said))
        assert not [one for one, two in pairwise(said) if one == two]
    assert pairs > 20


def test_excluded_strategies_stay_excluded_when_avoiding_repetition() -> None:
    people = Persuasion(["a"], ["calm", "pressing", "kind"], Random(1))
    assert {people.choose("a", ["pressing"], again="kind").strategy for _ in range(50)} == {"calm"}
    chosen = {people.choose("a", ["pressing", "calm"], again="kind").strategy for _ in range(50)}
    assert chosen == {"kind"}  # no other strategy is available


def test_repeated_recovery_requests_have_two_wordings() -> None:
    rules = load_faults(load_robot()).rules
    again = [rule for rule in rules if "user" in rule.recovery and rule.tries > 1]
    assert again and all(rule.aloud_again not in ("", rule.aloud) for rule in again)


def test_the_log_records_the_limits_of_requests(supervise: Supervise, workspace: Workspace) -> None:
    play(supervise())
    (game,) = read_games(workspace.store)
    assert game.asks == (3, 6)
