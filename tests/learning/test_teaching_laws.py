"""Laws of a teaching session: the log and the session agree after any command or error."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.codec import decode, encode
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.errors import StoreError
from tangy_profiles.events import EventRecord
from tangy_profiles.store import Store
from tangy_tui.learning.library import read_demonstrations
from tangy_tui.learning.teaching_events import Executed, Next, StepUndone, TeacherCommand, Undo
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import Asked, Refused, Reply, Say
from tests.support.laws import tried
from tests.support.teaching import BINGO, NO, YES, begun, teach


@contextmanager
def empty_store() -> Iterator[Store]:
    """Open a log that waits for the disk only once, so that tests can try many examples."""
    with TemporaryDirectory() as folder, Store.open(Path(folder)) as opened, opened.transaction():
        yield opened


def logged(store: Store) -> list[Demonstration]:
    return read_demonstrations(store, "bingo")


EXPECTED = Say("*")
LEAVE = Say("leave")
words = st.sampled_from([p for b in BINGO.behaviours.values() for p in b.phrases[:2]])
commands: st.SearchStrategy[TeacherCommand] = st.one_of(
    st.just(EXPECTED),
    st.just(EXPECTED),
    st.just(LEAVE),
    st.builds(Say, words, st.floats(0, 1)),
    st.builds(Say, st.text(max_size=30)),
    st.builds(Say, st.integers(0, 9).map("go to user {}".format)),
    st.sampled_from([YES, YES, NO, Undo(), Undo(), Next()]),
    st.builds(Reply, st.booleans(), st.integers(-1, 4)),
)


def expected_phrase(teaching: TeachingSession) -> str:
    name = BINGO.expected.get(teaching.world.observe().situation, "joke")
    return BINGO.behaviours[name].phrases[0]


@pytest.mark.slow
@tried(60)
@given(st.integers(0, 50), st.integers(1, 8), st.lists(commands, max_size=40))
def test_the_log_agrees_with_the_session_after_any_commands(
    seed: int, users: int, said: list[TeacherCommand]
) -> None:
    with empty_store() as store:
        teaching = begun(store, seed=seed, users=users)
        for command in said:
            if command is LEAVE:
                before, unfinished = teaching, not teaching.demonstration.finished
                teaching = begun(store, seed=seed + 100, users=users)
                if unfinished and before.demonstration in logged(store):
                    assert teaching.demonstration == before.demonstration
                    assert teaching.world.scene() == before.world.scene()
            elif command is EXPECTED:
                teaching.apply(Say(expected_phrase(teaching)))
                teaching.apply(YES)
            else:
                assert teaching.apply(command), "a teacher always gets an answer"
            kept = {d.id: d for d in logged(store)}
            steps = teaching.demonstration.steps
            if steps or teaching.demonstration.id in kept:
                assert kept[teaching.demonstration.id] == teaching.demonstration
            if steps:
                assert steps[-1].after == teaching.world.observe()
                assert all(a.after == b.state for a, b in pairwise(steps))
        assert store.check() == []


@pytest.mark.slow
@tried(25)
@given(st.integers(0, 50), st.integers(0, 60), st.integers(1, 5))
def test_undoing_and_repeating_steps_gives_the_same_state(
    seed: int, length: int, back: int
) -> None:
    with empty_store() as store:
        teaching = begun(store, seed=seed)
        phrases: list[str] = []
        outcomes: list[Executed] = []
        while len(phrases) <= length and not teaching.demonstration.finished:
            phrases.append(expected_phrase(teaching))
            outcomes += teach(teaching, phrases[-1])
        state, scene = teaching.world.observe(), teaching.world.scene()
        demonstration = teaching.demonstration
        back = min(back, len(phrases))
        for _ in range(back):
            assert isinstance(teaching.apply(Undo())[0], StepUndone)
        assert logged(store) == [teaching.demonstration]
        assert teach(teaching, *phrases[-back:]) == outcomes[-back:]
        assert (teaching.world.observe(), teaching.world.scene()) == (state, scene)
        assert logged(store) == [demonstration] == [teaching.demonstration]


def test_a_question_has_at_most_three_alternatives(store: Store) -> None:
    teaching = begun(store)
    asked = teaching.apply(Say("back funny everyone"))[0]
    for _ in range(8):
        assert isinstance(asked, Asked)
        assert 1 <= len(set(asked.alternatives)) == len(asked.alternatives) <= 3
        assert asked.behaviour not in asked.alternatives
        chosen = asked.alternatives[-1]
        asked = teaching.apply(Reply(yes=False, alternative=len(asked.alternatives)))[0]
        assert asked == teaching.question
        assert isinstance(asked, Asked)
        assert asked.behaviour == chosen
    assert teaching.demonstration.steps == ()


def test_a_resumed_game_is_followed_by_a_new_seed(store: Store) -> None:
    teach(begun(store, seed=7), "greet everyone")
    resumed = begun(store, seed=2)
    teach(resumed, "goodbye")
    resumed.apply(Next())
    assert resumed.demonstration.seed == 8


def test_undo_before_the_first_step_is_refused(store: Store) -> None:
    assert isinstance(begun(store).apply(Undo())[0], Refused)


def failing(monkeypatch: pytest.MonkeyPatch, store: Store, kind: str) -> None:
    append = store.append

    def refuse(record: EventRecord) -> int:
        if kind == record.KIND:
            raise StoreError("the disk is full")
        return append(record)

    monkeypatch.setattr(store, "append", refuse)


@pytest.mark.parametrize("kind", ["demonstration begun", "demonstration step"])
@pytest.mark.parametrize("length", [0, 3])
def test_a_step_that_cannot_be_stored_can_be_repeated(
    kind: str, length: int, store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    teaching = begun(store)
    teach(teaching, *["greet everyone", "next number", "next number"][:length])
    before, state = teaching.demonstration, teaching.world.observe()
    if length and kind == "demonstration begun":
        kind = "demonstration step"
    with monkeypatch.context() as full:
        failing(full, store, kind)
        teaching.apply(Say("tell a joke"))
        with pytest.raises(StoreError):
            teaching.apply(YES)
        assert (teaching.demonstration, teaching.world.observe()) == (before, state)
        assert logged(store) == ([before] if length else [])
    teach(teaching, "tell a joke")
    assert len(teaching.demonstration.steps) == length + 1
    assert logged(store) == [teaching.demonstration]


def test_an_undo_that_cannot_be_stored_changes_nothing(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    teaching = begun(store)
    teach(teaching, "greet everyone", "next number")
    before, state = teaching.demonstration, teaching.world.observe()
    with monkeypatch.context() as full:
        failing(full, store, "demonstration step undone")
        with pytest.raises(StoreError):
            teaching.apply(Undo())
    assert (teaching.demonstration, teaching.world.observe()) == (before, state)
    assert logged(store) == [before]


def test_every_step_is_encoded_and_decoded_unchanged(
    demonstrate: Callable[[str, int, int], Demonstration],
) -> None:
    for step in demonstrate("bingo", 1, 8).steps:
        assert decode(Step, json.loads(json.dumps(encode(step)))) == step
