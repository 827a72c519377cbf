"""Asking: if Tangy is not sure, it only asks, and learns the answer at once."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.events import EventRecord
from tangy_profiles.game_records import GameEnding, GameStep
from tangy_profiles.state import Situation
from tangy_profiles.store import Store
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.interaction.facilitation import Facilitation
from tangy_tui.interaction.game_events import Acted, GameEnded, GameEvent, Taught, Unsure
from tangy_tui.interaction.persuasion import Persuasion
from tangy_tui.learning.editing import Editor
from tangy_tui.learning.library import read_library
from tangy_tui.learning.online_learning import OnlineLearning
from tangy_tui.learning.policies import load_policy
from tangy_tui.learning.policy import PAPER, SURE, Policy
from tangy_tui.learning.verification import Asked, Reply, Say, Verified
from tangy_tui.text.learnt import replay_words
from tests.interaction.conftest import FEW, acts
from tests.interaction.gaps import learnt, otherwise, without

Cover = Callable[[str, int, int], tuple[Demonstration, ...]]

IDS = ("user1", "user2")


def asking(store: Store, activity: Activity, policy: Policy, seed: int = 1) -> Facilitation:
    """Make a run of games with a teacher who can be asked."""
    return Facilitation(
        SimulatedWorld(activity, IDS, seed=seed),
        policy,
        Persuasion(IDS, tuple(activity.strategies), Random(seed)),
        store,
        names={"user1": "Rosa"},
        seed=seed,
        answers=OnlineLearning(store, activity),
    )


def until_asked(facilitation: Facilitation, games: int = 20) -> Unsure:
    """Play until Tangy asks."""
    for _ in range(games):
        facilitation.begin()
        while not facilitation.over:
            for event in facilitation.step():
                if isinstance(event, Unsure):
                    return event
    raise AssertionError("Tangy did not ask")


def reply(facilitation: Facilitation, activity: Activity, teacher: str = "ann") -> list[GameEvent]:
    """Give the activity's expected answer."""
    question = facilitation.question
    assert question is not None
    behaviour = activity.behaviours[activity.expected[question.state.situation]]
    target = question.state.attended if behaviour.attends else None
    return facilitation.answer(behaviour, target, teacher)


def found(activity: Activity, behaviour: str) -> Situation:
    """Return the situation in which this behaviour is expected."""
    return next(s for s in activity.situations if activity.expected[s] == behaviour)


@pytest.fixture
def facilitation(store: Store, activity: Activity, cover: Cover) -> Facilitation:
    """A run by a policy that was never shown how a game begins."""
    gap = found(activity, "greeting")
    shown = [without(d, gap) for d in cover("bingo", 1, 4)]
    return asking(store, activity, learnt(store, activity, shown, FEW))


def test_an_undemonstrated_situation_asks_and_waits_for_the_answer(
    facilitation: Facilitation, store: Store
) -> None:
    question = until_asked(facilitation)
    assert "Nobody has shown Tangy" in question.reason
    before = facilitation.world.observe()
    events = [event.seq for event in store.events()]
    for _ in range(3):
        assert facilitation.step() == []
    assert facilitation.world.observe() == before == question.state
    assert [event.seq for event in store.events()] == events
    assert not facilitation.over


@pytest.mark.slow
def test_contradicting_demonstrations_cause_a_question(
    store: Store, activity: Activity, cover: Cover
) -> None:
    shown = cover("bingo", 1, 4)
    where = found(activity, "encourage")
    source = next(d for d in shown if any(s.state.situation == where for s in d.steps))
    other = otherwise(source, where, "joke", "ben")
    facilitation = asking(store, activity, learnt(store, activity, [*shown, other], FEW))
    question = until_asked(facilitation)
    assert question.state.situation == where
    assert "disagree" in question.reason
    _, taught, *_ = reply(facilitation, activity)
    assert isinstance(taught, Taught)
    assert taught.lesson.replay.overruled > 0
    assert "set aside" in replay_words(activity, taught.lesson.replay)
    assert facilitation.policy.decide(where).sure


@pytest.mark.slow
def test_a_vote_below_the_threshold_causes_a_question(
    store: Store, activity: Activity, cover: Cover
) -> None:
    policy = learnt(store, activity, cover("bingo", 1, 4), PAPER)
    low = [s for s in activity.situations if policy.decide(s).share < SURE]
    assert low, "the paper's bagging leaves rare situations unsure"
    facilitation = asking(store, activity, policy)
    question = until_asked(facilitation)
    assert question.state.situation in low
    assert question.decision.seen
    assert "% sure of" in question.reason
    reply(facilitation, activity)
    assert facilitation.policy.settings == PAPER


def test_an_answer_becomes_a_demonstration_and_a_policy(
    facilitation: Facilitation, store: Store, activity: Activity
) -> None:
    question = until_asked(facilitation)
    before = facilitation.policy
    acted, taught, *_ = reply(facilitation, activity)
    assert isinstance(acted, Acted)
    assert isinstance(taught, Taught)
    made = read_library(store, activity.name).finished[-1]
    assert (made.origin, made.teacher, made.people) == ("asked", "ann", IDS)
    assert [(s.state, s.behaviour, s.after) for s in made.steps] == [
        (question.state, acted.action.behaviour.name, acted.after)
    ]
    assert made == taught.lesson.demonstration
    assert facilitation.policy is taught.lesson.policy
    assert facilitation.policy.demonstrations == (*before.demonstrations, made.id)
    assert facilitation.policy.decide(question.state.situation).sure
    again, notices = load_policy(store, activity)
    assert (again.digest, notices) == (facilitation.policy.digest, [])


def test_the_replay_goes_through_every_earlier_step(
    facilitation: Facilitation, store: Store, activity: Activity
) -> None:
    earlier = sum(len(d.steps) for d in read_library(store, activity.name).finished)
    until_asked(facilitation)
    _, taught, *_ = reply(facilitation, activity)
    assert isinstance(taught, Taught)
    replay = taught.lesson.replay
    assert (replay.steps, replay.changed, replay.overruled) == (earlier, (), 0)
    assert "nothing else changed" in replay_words(activity, replay)


def test_the_game_continues_and_does_not_ask_twice(
    facilitation: Facilitation, store: Store, activity: Activity
) -> None:
    until_asked(facilitation)
    events = reply(facilitation, activity)
    while not facilitation.over:
        events += facilitation.step()
    assert not any(isinstance(event, Unsure) for event in events)
    assert isinstance(events[-1], GameEnded)
    assert events[-1].stopped is None
    steps = list(store.events(GameStep))
    assert len(steps) == len(acts(events))
    assert [bool(step.body["teacher"]) for step in steps] == [True] + [False] * (len(steps) - 1)


def test_a_command_is_verified_before_it_is_an_answer(
    facilitation: Facilitation, activity: Activity
) -> None:
    until_asked(facilitation)
    door = facilitation.verifier()
    phrase = activity.behaviours["greeting"].phrases[0]
    assert isinstance(door.say(Say(phrase)), Asked)
    assert facilitation.question is not None
    said = door.reply(Reply(yes=True))
    assert isinstance(said, Verified)
    assert said.behaviour.name == "greeting"
    assert facilitation.steps == 0


def test_giving_up_ends_the_game_without_learning(
    facilitation: Facilitation, store: Store, activity: Activity
) -> None:
    question = until_asked(facilitation)
    before = read_library(store, activity.name).entries
    (ended,) = facilitation.give_up()
    assert isinstance(ended, GameEnded)
    assert ended.stopped is not None
    assert question.reason in ended.stopped
    assert facilitation.over
    assert facilitation.give_up() == []
    assert read_library(store, activity.name).entries == before
    assert facilitation.answer(activity.behaviours["greeting"], None, "ann") == []


@pytest.mark.parametrize("asked", [False, True])
def test_leaving_ends_the_game_in_the_log(
    facilitation: Facilitation, store: Store, activity: Activity, asked: bool
) -> None:
    until_asked(facilitation)
    if not asked:
        reply(facilitation, activity)
    (ended,) = facilitation.leave()
    assert isinstance(ended, GameEnded)
    kept = store.last(GameEnding)
    assert kept is not None
    assert kept.body["stopped"] == ended.stopped == "It was left before its end."
    assert (facilitation.over, facilitation.question) == (True, None)
    assert facilitation.leave() == facilitation.step() == []


@pytest.mark.parametrize("fails", ["game step", "policy learnt", "demonstration step"])
def test_an_unstorable_answer_loses_nothing(
    facilitation: Facilitation,
    store: Store,
    activity: Activity,
    monkeypatch: pytest.MonkeyPatch,
    fails: str,
) -> None:
    until_asked(facilitation)
    policy, beliefs = facilitation.policy, deepcopy(facilitation.persuasion.beliefs)
    events = [event.seq for event in store.events()]
    append = store.append

    def refuse(record: EventRecord, **more: Any) -> int:
        if fails == record.KIND:
            raise OSError("full")
        return append(record, **more)

    with monkeypatch.context() as broken:
        broken.setattr(store, "append", refuse)
        with pytest.raises(OSError, match="full"):
            reply(facilitation, activity)
    assert [event.seq for event in store.events()] == events
    assert facilitation.policy is policy
    assert facilitation.persuasion.beliefs == beliefs
    assert not facilitation.over
    while not facilitation.over:  # the log is writable again, and the game goes on
        facilitation.step()
        if facilitation.question is not None:
            reply(facilitation, activity)


@pytest.mark.slow
@settings(max_examples=12)
@given(data=st.data(), seed=st.integers(1, 10_000))
def test_each_missing_situation_is_asked_about_once(
    activity: Activity, cover: Cover, data: st.DataObject, seed: int
) -> None:
    gaps = data.draw(st.sets(st.sampled_from(activity.situations), min_size=1, max_size=5))
    with TemporaryDirectory() as folder, Store.open(Path(folder)) as store:
        shown = [without(d, *gaps) for d in cover("bingo", 1, 4)]
        facilitation = asking(store, activity, learnt(store, activity, shown, FEW), seed)
        asked: list[Situation] = []
        facilitation.begin()
        while not facilitation.over:
            if facilitation.question is None:
                facilitation.step()
                continue
            asked.append(facilitation.question.state.situation)
            _, taught, *_ = reply(facilitation, activity)
            assert isinstance(taught, Taught)
            assert taught.lesson.replay.changed == ()
        assert len(asked) == len(set(asked))
        assert set(asked) <= gaps
        for situation in set(activity.situations) - (gaps - set(asked)):
            decision = facilitation.policy.decide(situation)
            assert decision.sure
            assert decision.behaviour == activity.expected[situation]


# ------------------------------------------------------------------- the effect of an answer


def disagreeing(store: Store, activity: Activity, cover: Cover) -> tuple[Situation, Policy]:
    """Let ben tell a joke in the first situation, against all others; return it and the policy."""
    shown = cover("bingo", 1, 4)
    where = activity.situations[0]
    other = otherwise(shown[0], where, "joke", "ben")
    return where, learnt(store, activity, [*shown, other], FEW)


def answered(facilitation: Facilitation, activity: Activity, behaviour: str) -> Taught:
    until_asked(facilitation)
    events = facilitation.answer(activity.behaviours[behaviour], None, "ann")
    (taught,) = [event for event in events if isinstance(event, Taught)]
    return taught


def test_an_answer_given_before_resolves_the_conflict_for_later_learning(
    store: Store, activity: Activity, cover: Cover
) -> None:
    where, policy = disagreeing(store, activity, cover)
    facilitation = asking(store, activity, policy)
    lesson = answered(facilitation, activity, activity.expected[where]).lesson
    assert lesson.policy.decide(where).sure
    assert lesson.replay.unsettled == ""
    assert "One earlier step said otherwise" in replay_words(activity, lesson.replay)
    assert read_library(store, "bingo").conflicts == []


def test_a_new_answer_does_not_resolve_the_conflict(
    store: Store, activity: Activity, cover: Cover
) -> None:
    where, policy = disagreeing(store, activity, cover)
    facilitation = asking(store, activity, policy)
    lesson = answered(facilitation, activity, "celebrate").lesson
    assert lesson.policy.decide(where).contested
    assert lesson.replay.overruled == 0
    assert "goes on asking here" in replay_words(activity, lesson.replay)
    (conflict,) = read_library(store, "bingo").conflicts
    assert set(conflict.answers) == {activity.expected[where], "joke", "celebrate"}
    assert until_asked(facilitation).state.situation == where


def test_an_answer_to_an_older_policy_does_not_reopen_a_resolution(
    store: Store, activity: Activity, cover: Cover
) -> None:
    where, policy = disagreeing(store, activity, cover)
    editor = Editor(store, activity)
    (conflict,) = editor.library.conflicts
    editor.resolve(conflict, activity.expected[where])
    settled = read_library(store, "bingo").resolutions
    facilitation = asking(store, activity, policy)
    lesson = answered(facilitation, activity, "joke").lesson
    assert lesson.policy.decide(where).behaviour == "joke"  # the game goes on
    assert "A teacher said otherwise before" in replay_words(activity, lesson.replay)
    library = read_library(store, "bingo")
    assert library.resolutions == settled
    (left,) = library.conflicts
    assert [s.teacher for s in left.answers["joke"]] == ["ann"]


@pytest.mark.slow
def test_one_agreeing_answer_settles_a_split_vote(
    store: Store, activity: Activity, cover: Cover
) -> None:
    policy = learnt(store, activity, cover("bingo", 1, 4), PAPER)
    unsure = [s for s, d in policy.table.items() if d.seen and not d.sure]
    assert unsure  # bagging leaves votes below the threshold on rare rows
    facilitation = asking(store, activity, policy)
    question = until_asked(facilitation)
    reply(facilitation, activity)
    decision = facilitation.policy.decide(question.state.situation)
    assert decision.sure
    assert read_library(store, "bingo").conflicts == []
