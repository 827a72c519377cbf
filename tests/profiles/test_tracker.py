"""The stage rules, the first-come queue and the closing of requests of an activity."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.activity import Activity, StageRule, load_activity
from tangy_profiles.codec import decode, encode
from tangy_profiles.game_records import GameStep
from tangy_profiles.state import FRONT, ActivityState, Situation, UserState
from tangy_profiles.tracker import Tracker

BINGO = load_activity("bingo")
IDS = ("user1", "user2", "user3", "user4")
READ = tuple(state.name for state in BINGO.card_states)
RIGHT = "correctly marked"


def begun() -> Tracker:
    tracker = Tracker(BINGO, IDS)
    tracker.executed(BINGO.behaviours["greeting"])
    return tracker


def with_user(card: str | None) -> Tracker:
    tracker = begun()
    tracker.ask("user2")
    tracker.arrive("user2")
    tracker.seen = card
    return tracker


def calling(times: int) -> Tracker:
    tracker = begun()
    for _ in range(times):
        tracker.executed(BINGO.behaviours["call number"])
    return tracker


def asked() -> Tracker:
    tracker = begun()
    tracker.ask("user3")
    return tracker


def helped() -> Tracker:
    tracker = with_user(RIGHT)
    tracker.executed(BINGO.behaviours["encourage"])
    return tracker


def won() -> Tracker:
    tracker = with_user("bingo")
    tracker.executed(BINGO.behaviours["celebrate"])
    return tracker


@pytest.mark.parametrize(
    ("tracker", "row", "behaviour"),
    [
        (Tracker(BINGO, IDS), ("start", "ANR", "occluded"), "greeting"),
        (calling(18), ("socialize", "ANR", "occluded"), "joke"),
        (calling(17), ("facilitate", "ANR", "occluded"), "call number"),
        (begun(), ("facilitate", "ANR", "occluded"), "call number"),
        (with_user("bingo"), ("help", "AR", "bingo"), "celebrate"),
        (with_user("incorrectly marked"), ("help", "AR", "incorrectly marked"), "remove markers"),
        (with_user("missing numbers"), ("help", "AR", "missing numbers"), "mark numbers"),
        (with_user(RIGHT), ("help", "AR", RIGHT), "encourage"),
        (with_user(None), ("help", "AR", "occluded"), "move card closer"),
        (asked(), ("navigate", "AR", "occluded"), "navigate to user"),
        (helped(), ("navigate", "ANR", "occluded"), "navigate to front"),
        (won(), ("end", "AR", "occluded"), "valediction"),
    ],
)
def test_the_rules_produce_every_row_of_table_two(
    tracker: Tracker, row: tuple[str, str, str], behaviour: str
) -> None:
    situation = tracker.state().situation
    assert situation == row
    assert BINGO.expected[situation] == behaviour


def facts() -> st.SearchStrategy[list[tuple[str, str]]]:
    fact = st.one_of(
        st.tuples(st.just("ask"), st.sampled_from(IDS)),
        st.tuples(st.just("arrive"), st.sampled_from((*IDS, FRONT))),
        st.tuples(st.just("read"), st.sampled_from(READ)),
        st.tuples(st.just("done"), st.sampled_from(tuple(BINGO.behaviours))),
        st.tuples(st.just("failed"), st.sampled_from(tuple(BINGO.behaviours))),
        st.tuples(st.just("calls"), st.sampled_from(("17", "18", "19"))),
    )
    return st.lists(fact, max_size=40)


def happen(tracker: Tracker, kind: str, what: str) -> None:
    match kind:
        case "ask":
            tracker.ask(what)
        case "arrive":
            tracker.arrive(what)
        case "read" if tracker.place in tracker.queue:
            tracker.seen = what
        case "done":
            tracker.executed(BINGO.behaviours[what])
        case "failed":
            tracker.executed(BINGO.behaviours[what], succeeded=False)
        case "calls":
            for _ in range(int(what)):
                tracker.executed(BINGO.behaviours["call number"])


@given(facts())
def test_the_first_matching_rule_gives_the_stage(told: list[tuple[str, str]]) -> None:
    tracker = Tracker(BINGO, IDS)
    done: list[str] = []
    for kind, what in told:
        happen(tracker, kind, what)
        done += [what] if kind == "done" else ["call number"] * int(what) if kind == "calls" else []
        jokes = [place for place, name in enumerate(done) if name == "joke"]
        calls = done[jokes[-1] if jokes else 0 :].count("call number")
        if "greeting" not in done:
            stage = "start"
        elif "celebrate" in done:
            stage = "end"
        elif tracker.place in tracker.queue:
            stage = "help"
        elif tracker.queue or tracker.place != FRONT:
            stage = "navigate"
        else:
            stage = "socialize" if calls >= 18 else "facilitate"
        assert tracker.state().stage == stage


@given(facts())
def test_the_state_includes_the_data_of_the_rules(told: list[tuple[str, str]]) -> None:
    tracker = Tracker(BINGO, IDS)
    for kind, what in told:
        happen(tracker, kind, what)
        state = tracker.state()
        assert decode(ActivityState, json.loads(json.dumps(encode(state)))) == state
        assert (state.step, state.place, state.closed) == (
            tracker.step, tracker.place, tracker.closed,
        )  # fmt: skip
        situation = state.situation
        if state.attended is None:
            assert situation[1:] == ("ANR", "occluded")
            assert all(user == UserState(user.id, "occluded", "ANR") for user in state.users)
            continue
        beside = tracker.place in tracker.queue
        assert state.attended == (tracker.place if beside else tracker.queue[0])
        assert [u.id for u in state.users if u.request == "AR"] == sorted(tracker.queue)
        assert situation.request == "AR"
        assert state.user(state.attended).activity == situation.user_state
        if situation.stage != "help" or tracker.seen is None:
            assert situation.user_state == "occluded"
        else:
            assert situation.user_state == tracker.seen
        others = [u for u in state.users if u.id != state.attended]
        assert all(u.activity == "occluded" for u in others)


@given(st.lists(st.sampled_from(IDS), max_size=12))
def test_requests_are_served_first_come_first(presses: list[str]) -> None:
    tracker = begun()
    fresh = [tracker.ask(person) for person in presses]
    first_come = list(dict.fromkeys(presses))
    assert fresh == [person not in presses[:i] for i, person in enumerate(presses)]
    for person in first_come:
        assert tracker.state().attended == person
        tracker.arrive(person)
        tracker.seen = RIGHT
        tracker.executed(BINGO.behaviours["encourage"])
    assert tracker.queue == []
    assert tracker.state().attended is None


def test_a_request_that_comes_during_a_visit_waits_its_turn() -> None:
    tracker = with_user(RIGHT)
    tracker.ask("user1")
    assert tracker.state().attended == "user2"
    tracker.executed(BINGO.behaviours["encourage"])
    assert tracker.state().attended == "user1"
    assert tracker.state().stage == "navigate"


@pytest.mark.parametrize("behaviour", list(BINGO.behaviours))
@pytest.mark.parametrize("card", [*READ, None])
def test_a_request_closes_by_encouragement_or_a_corrected_card(
    behaviour: str, card: str | None
) -> None:
    tracker = with_user(card)
    tracker.ask("user4")
    tracker.executed(BINGO.behaviours[behaviour])
    closes = behaviour == "encourage" or (
        behaviour in ("remove markers", "mark numbers") and card == RIGHT
    )
    assert tracker.closed == ("user2" if closes else None)
    assert tracker.queue == (["user4"] if closes else ["user2", "user4"])
    tracker.executed(BINGO.behaviours["joke"])
    assert tracker.closed is None, "closing belongs to the one step that did it"


def test_a_request_closes_only_beside_its_person() -> None:
    tracker = asked()
    tracker.executed(BINGO.behaviours["encourage"])
    assert tracker.queue == ["user3"]


@pytest.mark.parametrize("behaviour", list(BINGO.behaviours))
def test_a_failed_behaviour_only_counts_as_a_step(behaviour: str) -> None:
    tracker = with_user(RIGHT)
    before = tracker.state()
    tracker.executed(BINGO.behaviours[behaviour], succeeded=False)
    assert tracker.state() == before._replace(step=before.step + 1)


def test_leaving_a_person_clears_the_card_state() -> None:
    tracker = with_user("missing numbers")
    tracker.arrive("user2")
    assert tracker.state().situation == Situation("help", "AR", "occluded")


def test_a_win_is_celebrated_only_beside_a_winner_whose_card_was_read() -> None:
    celebrate = BINGO.behaviours["celebrate"]
    assert with_user("bingo").allows(celebrate)
    for tracker in (begun(), asked(), helped(), *(with_user(c) for c in (None, *READ[1:]))):
        assert not tracker.allows(celebrate)
        assert tracker.allows(BINGO.behaviours["joke"])


def test_the_winners_request_stays_open_to_the_end() -> None:
    tracker = won()
    assert tracker.queue == ["user2"]
    assert tracker.state().user("user2") == UserState("user2", "occluded", "AR")


def test_two_counts_since_the_same_behaviour_are_kept_apart(activity: Activity) -> None:
    rules = (
        StageRule("stretch", "count", "encourage", "joke", 2),
        StageRule("socialize", "count", "call number", "joke", 3),
        StageRule("facilitate", "otherwise"),
    )
    tracker = Tracker(replace(activity, stage_rules=rules), IDS)
    stages = []
    for name in ("call number", "call number", "encourage", "call number", "encourage", "joke"):
        tracker.executed(activity.behaviours[name])
        stages.append(tracker.state().stage)
    assert stages == [*["facilitate"] * 3, "socialize", "stretch", "facilitate"]


def test_an_unknown_id_has_no_state() -> None:
    with pytest.raises(KeyError):
        begun().state().user("user9")


def test_the_game_has_begun_after_all_required_behaviours(activity: Activity) -> None:
    rules = (
        StageRule("start", "before", "greeting"),
        StageRule("warm up", "before", "joke"),
        StageRule("facilitate", "otherwise"),
    )
    tracker = Tracker(replace(activity, stage_rules=rules), IDS)
    assert not tracker.begun()
    told = []
    for name in ("greeting", "call number", "joke"):
        tracker.executed(activity.behaviours[name])
        told.append((tracker.begun(), tracker.state().stage))
    assert told == [(False, "warm up"), (False, "warm up"), (True, "facilitate")]


@pytest.mark.parametrize("jokes", [{}, {10: True}, {10: False}, {5: False, 10: False}])
def test_a_joke_without_effect_is_inferred_from_a_later_stage(
    jokes: dict[int, bool],
) -> None:
    """The log records each joke that the robot told; only the stages show whether it counts."""
    truth, followed = begun(), begun()
    for call in range(1, 30):
        told = [("call number", True)]
        told += [("joke", jokes[call])] if call in jokes else []
        for name, counts in told:
            before = truth.state()
            truth.executed(BINGO.behaviours[name], succeeded=counts)
            numbers = (call,) if name == "call number" else ()
            step = GameStep(
                game="g", behaviour=name, target=None, numbers=numbers, state=before,
                after=truth.state(),
            )  # fmt: skip
            assert followed.follow(step), f"{name} {call}"
    assert followed.state() == truth.state()
    assert truth.state().stage == "socialize"
