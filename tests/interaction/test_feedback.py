"""Feedback by staff: in any order, posteriors follow exactly from the log."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from itertools import count
from pathlib import Path
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.beliefs import Beta
from tangy_profiles.errors import TangyError
from tangy_profiles.people_records import ResponseAwaited
from tangy_profiles.persuading import PAPER, PersuasionConfig
from tangy_profiles.state import Response
from tangy_profiles.store import Store
from tangy_tui.interaction.feedback import Feedback
from tangy_tui.interaction.memory import PersonModels
from tangy_tui.interaction.persuasion import Persuasion
from tangy_tui.text.people import entry_words
from tests.support.append_body import append_body
from tests.support.laws import tried

STRATEGIES = ("plain", "warm", "brisk")
FORGETFUL = PersuasionConfig(forgetting=0.9)
DAILY = PersuasionConfig("bayes-ucb", "people", 0.9, "day")

fresh = (f"p{number}" for number in count())
"""A new person for each example: examples share a log, and must not affect each other."""


class Clock:
    """A clock that the test advances."""

    def __init__(self) -> None:
        self.now = datetime(2026, 3, 1, 10, tzinfo=UTC)

    def __call__(self) -> datetime:
        return self.now


@pytest.fixture(scope="module")
def clock() -> Clock:
    return Clock()


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory, clock: Clock) -> Iterator[Store]:
    """One log for all examples."""
    with Store.open(tmp_path_factory.mktemp("log"), now=clock) as opened:
        yield opened


def respond(store: Store, person: str, strategy: str, complied: bool, game: str = "g") -> int:
    body = {"game": game, "followed": True, "seconds": 5.0}
    return append_body(store, "response", body, person=person, strategy=strategy, complied=complied)


# ------------------------------------------------------------------------ the law of counts


@dataclass
class Answer:
    """A response in the model of the log: its request, and whether it counts."""

    seq: int
    request: int
    strategy: str
    complied: bool | None
    void: bool = False


@dataclass
class Model:
    """A simple reference model of the log: every answer, and an undo stack."""

    answers: list[Answer] = field(default_factory=list)
    changes: list[tuple[str, Answer]] = field(default_factory=list)

    def answered(self, request: int) -> bool:
        return any(
            a.request == request and a.complied is not None and not a.void for a in self.answers
        )

    def undo(self) -> None:
        what, answer = self.changes.pop()
        answer.void = what == "late"

    def counts(self) -> dict[str, tuple[int, int]]:
        holding = [(a.strategy, a.complied) for a in self.answers if not a.void]
        return {s: (holding.count((s, True)), holding.count((s, False))) for s in STRATEGIES}


moves = st.lists(
    st.one_of(
        st.tuples(st.just("respond"), st.sampled_from(STRATEGIES), st.booleans()),
        st.tuples(st.just("await"), st.sampled_from(STRATEGIES), st.just(False)),
        st.tuples(st.just("late"), st.integers(0, 30), st.booleans()),
        st.tuples(st.just("unasked"), st.sampled_from(STRATEGIES), st.booleans()),
        st.tuples(st.just("void"), st.integers(0, 30), st.just(False)),
        st.tuples(st.just("undo"), st.just(0), st.just(False)),
    ),
    max_size=25,
)


def move(model: Model, store: Store, person: str, what: str, which: str | int, yes: bool) -> bool:
    """Make one move in the log and in the model; return whether the model allows it."""
    feedback = Feedback(store)
    if what == "respond":
        seq = respond(store, person, str(which), yes)
        model.answers.append(Answer(seq, seq, str(which), yes))
    elif what == "await":
        seq = append_body(store, ResponseAwaited, {"game": "g"}, person=person, strategy=str(which))
        model.answers.append(Answer(seq, seq, str(which), None))
    elif what == "unasked":
        seq = feedback.give(person, str(which), yes).seq
        model.answers.append(Answer(seq, seq, str(which), yes))
        model.changes.append(("late", model.answers[-1]))
    elif what == "undo":
        if not model.changes:
            return refused(lambda: feedback.undo(person))
        feedback.undo(person)
        model.undo()
    elif model.answers:
        answer = model.answers[int(which) % len(model.answers)]
        if what == "void":
            if answer.void or answer.complied is None:
                return refused(lambda: feedback.void(person, answer.seq))
            feedback.void(person, answer.seq, "a mistake")
            answer.void = True
            model.changes.append(("void", answer))
        else:
            if model.answered(answer.request):
                return refused(lambda: feedback.give(person, answer.strategy, yes, answer.seq))
            seq = feedback.give(person, answer.strategy, yes, answer.seq).seq
            model.answers.append(Answer(seq, answer.request, answer.strategy, yes))
            model.changes.append(("late", model.answers[-1]))
    return True


def refused(attempt: object) -> bool:
    assert callable(attempt)
    with pytest.raises(TangyError):
        attempt()
    return False


@tried(60)
@given(moves)
def test_counts_match_the_log_after_any_sequence_of_changes(
    log: Store, told: list[tuple[str, str | int, bool]]
) -> None:
    person, model = next(fresh), Model()
    memory = PersonModels(log, STRATEGIES)
    live = Persuasion([person], STRATEGIES, Random(1), memory=memory)
    with log.transaction():
        for what, which, yes in told:
            move(model, log, person, what, which, yes)
            if what == "respond":
                live.update(Response(person, str(which), True, yes, 5.0))
            else:
                live.recall(person)
            beliefs = {s: Beta(1 + y, 1 + n) for s, (y, n) in model.counts().items()}
            assert live.beliefs[person] == beliefs
        counted = {s: c for (p, s), c in log.responses().items() if p == person}
        assert counted == {s: c for s, c in model.counts().items() if any(c)}
        assert memory.recall(person).beliefs == beliefs if told else True
        history = memory.feedback.history(person)
    assert [entry.seq for entry in history] == sorted(a.seq for a in model.answers)
    assert [entry.number for entry in history] == list(range(1, len(history) + 1))
    requests = [entry.request for entry in history if entry.counts]
    assert len(requests) == len(set(requests)), "no request is counted twice"


@pytest.mark.slow
@tried(30)
@given(moves, st.sampled_from([FORGETFUL, DAILY, PersuasionConfig("bayes-ucb", "people")]))
def test_live_and_recalled_posteriors_agree_for_any_method(
    log: Store, clock: Clock, told: list[tuple[str, str | int, bool]], chosen: PersuasionConfig
) -> None:
    person, model = next(fresh), Model()
    memory = PersonModels(log, STRATEGIES, chosen)
    with log.transaction():
        live = Persuasion([person], STRATEGIES, Random(1), memory=memory)
        for hours, (what, which, yes) in enumerate(told):
            clock.now += timedelta(hours=hours)
            move(model, log, person, what, which, yes)
            if what == "respond":
                live.update(Response(person, str(which), True, yes, 5.0))
            else:
                live.recall(person)
        live.choose(person)
        recalled = memory.recall(person).beliefs
    for strategy, (yes_count, no_count) in model.counts().items():
        for belief in (live.beliefs[person][strategy], recalled[strategy]):
            assert (belief.complied, belief.trials) == (yes_count, yes_count + no_count)
        assert live.beliefs[person][strategy].alpha == pytest.approx(recalled[strategy].alpha)
        assert live.beliefs[person][strategy].beta == pytest.approx(recalled[strategy].beta)


@pytest.mark.slow
@tried(20)
@given(
    st.lists(st.tuples(st.sampled_from(STRATEGIES), st.booleans()), min_size=1, max_size=8),
    st.randoms(use_true_random=False),
)
def test_the_order_of_late_feedback_does_not_matter(
    log: Store, clock: Clock, told: list[tuple[str, bool]], rng: Random
) -> None:
    """Also if beliefs fade: an answer counts from the time of its request."""
    in_time, late = next(fresh), next(fresh)
    memory = PersonModels(log, STRATEGIES, PersuasionConfig(forgetting=0.9))
    with log.transaction():
        waiting = []
        for strategy, complied in told:
            clock.now += timedelta(hours=1)
            respond(log, in_time, strategy, complied)
            seq = log.append(ResponseAwaited(game="g"), person=late, strategy=strategy)
            waiting.append((strategy, complied, seq))
        rng.shuffle(waiting)
        for strategy, complied, seq in waiting:
            clock.now += timedelta(hours=1)
            memory.feedback.give(late, strategy, complied, seq)
        one, other = memory.recall(in_time).beliefs, memory.recall(late).beliefs
    assert one == other


# ---------------------------------------------------------------------------- single moves


def test_a_void_response_has_a_reason_and_can_be_restored(store: Store) -> None:
    feedback = Feedback(store)
    seq = respond(store, "p", "warm", True)
    assert store.responses() == {("p", "warm"): (1, 0)}
    entry = feedback.void("p", seq, "that was not compliance")
    assert (entry.void, entry.why, entry.counts) == (True, "that was not compliance", False)
    assert store.responses() == {}
    feedback.undo()
    assert store.responses() == {("p", "warm"): (1, 0)}
    assert [entry.counts for entry in feedback.history("p")] == [True]


def test_a_wrong_answer_can_be_voided_and_replaced(store: Store) -> None:
    feedback = Feedback(store)
    seq = respond(store, "p", "warm", True)
    with pytest.raises(TangyError, match="has its answer already"):
        feedback.give("p", "warm", False, seq)
    feedback.void("p", seq)
    given = feedback.give("p", "warm", False, seq)
    assert (given.late, given.game) == (True, "g")
    assert store.responses() == {("p", "warm"): (0, 1)}
    assert [entry.open for entry in feedback.history("p")] == [False, False]
    with pytest.raises(TangyError, match="has its answer already"):
        feedback.give("p", "warm", True, seq)


def test_feedback_to_another_request_is_refused(store: Store) -> None:
    feedback = Feedback(store)
    seq = append_body(store, ResponseAwaited, {"game": "g"}, person="p", strategy="warm")
    with pytest.raises(TangyError, match="was put with warm, not with brisk"):
        feedback.give("p", "brisk", True, seq)
    with pytest.raises(TangyError, match="is not a request to q"):
        feedback.give("q", "warm", True, seq)
    assert store.responses() == {}


def test_undo_reverts_one_change_of_a_person_at_a_time(store: Store) -> None:
    feedback = Feedback(store)
    feedback.switch("p", "warm", False, STRATEGIES)
    feedback.choose_method("q", FORGETFUL)
    feedback.choose_method("p", DAILY)
    assert feedback.undo("p").kind == "method chosen"
    assert feedback.method("p") is None
    assert feedback.undo("p").strategy == "warm"
    assert feedback.off("p") == frozenset()
    with pytest.raises(TangyError, match="nothing to take back"):
        feedback.undo("p")
    assert feedback.method("q") == FORGETFUL
    assert feedback.undo().person == "q"
    assert feedback.last_change() is None


def test_a_disabled_strategy_is_never_chosen_and_the_last_stays(store: Store) -> None:
    memory = PersonModels(store, STRATEGIES)
    feedback = memory.feedback
    for strategy in ("warm", "brisk"):
        feedback.switch("p", strategy, False, STRATEGIES)
    with pytest.raises(TangyError, match="plain is the last one left: one must stay on"):
        feedback.switch("p", "plain", False, STRATEGIES)
    with pytest.raises(TangyError, match="warm is switched off already"):
        feedback.switch("p", "warm", False, STRATEGIES)
    persuasion = Persuasion(["p", "q"], STRATEGIES, Random(2), memory=memory)
    assert {persuasion.choose("p").strategy for _ in range(50)} == {"plain"}
    assert {persuasion.choose("q").strategy for _ in range(50)} == set(STRATEGIES)
    feedback.switch("p", "warm", True, STRATEGIES)
    persuasion.recall("p")
    assert {persuasion.choose("p").strategy for _ in range(50)} == {"plain", "warm"}


def test_all_strategies_are_used_if_none_is_enabled(store: Store) -> None:
    feedback = Feedback(store)
    feedback.switch("p", "warm", False, STRATEGIES)
    other = Persuasion(["p"], ("warm",), Random(1), memory=PersonModels(store, ("warm",)))
    assert other.choose("p").strategy == "warm"


def test_the_method_of_a_person_overrides_that_of_the_activity(store: Store) -> None:
    memory = PersonModels(store, STRATEGIES, FORGETFUL)
    assert (memory.recall("p").chosen, memory.recall("p").own) == (FORGETFUL, False)
    memory.feedback.choose_method("p", PAPER)
    assert (memory.recall("p").chosen, memory.recall("p").own) == (PAPER, True)
    assert memory.recall("q").chosen == FORGETFUL
    memory.feedback.choose_method("p", None)
    assert memory.recall("p").own is False
    with pytest.raises(TangyError, match="the method already"):
        memory.feedback.choose_method("p", None)


def test_a_prior_from_earlier_people_excludes_void_responses(store: Store) -> None:
    memory = PersonModels(store, STRATEGIES, PersuasionConfig(prior="people"))
    for person in ("a", "b", "c", "d"):
        for _ in range(5):
            respond(store, person, "warm", True)
    assert memory.recall("new").prior["warm"].mean > 0.7
    for person in ("a", "b", "c", "d"):
        for entry in memory.feedback.history(person):
            memory.feedback.void(person, entry.seq)
    assert memory.recall("new").prior["warm"] == Beta()


def test_daily_forgetting_follows_the_clock(log: Store, clock: Clock) -> None:
    person = next(fresh)
    memory = PersonModels(log, STRATEGIES, PersuasionConfig(forgetting=0.5, forgetting_per="day"))
    for _ in range(4):
        respond(log, person, "warm", True)
    live = Persuasion([person], STRATEGIES, Random(1), memory=memory)
    clock.now += timedelta(days=2)
    live.choose(person)
    for belief in (live.beliefs[person]["warm"], memory.recall(person).beliefs["warm"]):
        assert belief.alpha == pytest.approx(2)
        assert (belief.complied, belief.trials) == (4, 4)


def test_feedback_can_be_read_from_a_read_only_log(tmp_path: Path) -> None:
    with Store.open(tmp_path / "none", write=False) as nothing:
        assert Feedback(nothing).history("p") == []
        assert PersonModels(nothing, STRATEGIES).recall("p").beliefs["warm"] == Beta()
        with pytest.raises(TangyError):
            Feedback(nothing).switch("p", "warm", False, STRATEGIES)


@pytest.mark.parametrize(
    ("complied", "followed", "told"),
    [(True, True, "did it"), (False, True, "did it a little late"),
     (False, False, "would rather not"), (False, None, "would rather not")],
)  # fmt: skip
def test_somebody_who_was_slow_did_not_refuse(
    log: Store, complied: bool, followed: bool | None, told: str
) -> None:
    person = next(fresh)
    body = {"game": "g", "followed": followed, "seconds": 19.0}
    append_body(log, "response", body, person=person, strategy="warm", complied=complied)
    (entry,) = Feedback(log).history(person)
    assert entry.followed is bool(followed) and entry_words(entry) == told
