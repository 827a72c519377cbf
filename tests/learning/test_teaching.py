"""A teaching session: questions, refusals, suggestions, undo and resuming."""

from __future__ import annotations

import gc
import sys
from collections import Counter
from dataclasses import replace
from types import FrameType

import pytest

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.errors import TangyError
from tangy_profiles.person import load_people
from tangy_profiles.state import FRONT, Situation
from tangy_profiles.store import Store
from tangy_tui.learning.library import read_demonstrations
from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.learning.teaching_events import Begun, Executed, Finished, Next, StepUndone, Undo
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import (
    Asked,
    NotUnderstood,
    Refused,
    Rejected,
    Reply,
    Say,
    Verifier,
)
from tangy_tui.text.refusals import refused_words
from tests.support.teaching import BINGO, NO, YES, begun, session, teach


def whole_game(teaching: TeachingSession) -> Demonstration:
    list(ScriptedTeacher(teaching).demonstrate())
    return teaching.demonstration


def logged(store: Store) -> list[Demonstration]:
    return read_demonstrations(store, "bingo")


# --------------------------------------------------------------------------- saying and asking


def test_nothing_is_executed_before_a_yes(store: Store) -> None:
    teaching = begun(store)
    before = teaching.world.observe()
    asked = teaching.apply(Say("greet everyone"))
    words = "greet everyone"
    assert asked == [Asked("greeting", words, words, 1.0, (), None, typed=True)]
    assert teaching.question == asked[0]
    assert teaching.world.observe() == before
    assert logged(store) == []
    executed = teaching.apply(YES)[0]
    assert isinstance(executed, Executed)
    assert (executed.number, executed.step.behaviour) == (1, "greeting")
    assert executed.step == Step("greeting", None, before, teaching.world.observe())
    assert "I am Tangy" in executed.speech
    assert teaching.question is None


def test_a_no_returns_the_words_and_does_nothing(store: Store) -> None:
    teaching = begun(store)
    teaching.apply(Say("tell a joke"))
    assert teaching.apply(NO) == [Rejected("tell a joke")]
    assert teaching.demonstration.steps == ()
    assert isinstance(teaching.apply(YES)[0], Refused), "the question is gone"


def test_unknown_words_are_returned_and_drop_the_question(store: Store) -> None:
    teaching = begun(store)
    teaching.apply(Say("tell a joke"))
    said = teaching.apply(Say("qwertz"))[0]
    assert isinstance(said, NotUnderstood)
    assert said.heard == "qwertz"
    assert teaching.question is None


def test_uncertain_words_offer_alternatives_in_turn(
    store: Store,
) -> None:
    teaching = begun(store)
    front = Say("go to the front", 0.5, teaching.phrasebook.choices("go to the front"))
    asked = teaching.apply(front)[0]
    assert isinstance(asked, Asked)
    assert 1 <= len(asked.alternatives) <= 3
    again = teaching.apply(Reply(yes=False, alternative=1))[0]
    if isinstance(again, Asked):
        assert again.behaviour == asked.alternatives[0]
        assert asked.behaviour in again.alternatives
    refused = teaching.apply(front)
    assert isinstance(teaching.apply(Reply(yes=False, alternative=9))[0], Refused)
    assert teaching.question == refused[0], "a wrong number leaves the question open"


def test_suggestions_are_never_refused_and_what_is_due_comes_before_the_frequent(
    store: Store,
) -> None:
    teaching = begun(store)
    assert len(teaching.sayable) > 1 and teaching.sayable[0] == "greet everyone"
    for phrase in teaching.sayable:
        assert isinstance(teaching.apply(Say(phrase))[0], Asked)
    for seed in (1, 2, 3):
        other = session(store, seed=seed)
        other.begin(resume=False)
        teach(other, "tell a joke" if seed > 1 else "greet everyone")
    fourth = session(store, seed=4)
    fourth.begin(resume=False)
    assert fourth.sayable[:2] == ("greet everyone", "tell a joke")
    silent = session(store, seed=5, activity=replace(BINGO, expected={}))  # it expects nothing
    silent.begin(resume=False)
    assert silent.sayable[:2] == ("tell a joke", "greet everyone")


@pytest.mark.parametrize("expected", [BINGO.expected, {}])
def test_suggestions_start_with_the_helpful_phrase(
    store: Store, expected: dict[Situation, str]
) -> None:
    teaching = session(store, activity=replace(BINGO, expected=expected))
    teaching.begin()
    beside = 0
    while not teaching.demonstration.finished:
        state = teaching.world.observe()
        best = BINGO.behaviour(BINGO.expected[state.situation])
        if expected:
            assert teaching.sayable[0] == best.phrases[0]
        elif state.place != FRONT and best.place == "attended":
            helps = sum(b.attends for b in BINGO.behaviours.values())
            assert best.phrases[0] in teaching.sayable[:helps]
            beside += 1
        teach(teaching, best.phrases[0])
    assert expected or beside


def test_a_finished_game_has_no_suggestions(store: Store) -> None:
    teaching = begun(store)
    whole_game(teaching)
    assert teaching.sayable == ()


def test_behaviours_for_a_person_are_refused_while_nobody_asks(store: Store) -> None:
    teaching = begun(store)
    for phrase in ("encourage", "remove markers", "go to user", "celebrate"):
        refused = teaching.apply(Say(phrase))[0]
        assert isinstance(refused, Refused)
        assert refused.why == "nobody asks"
    assert teaching.question is None


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("cal", "call number"),
        ("CAL", "call number"),
        (" gre", "greet everyone"),
        ("go to f", "go to front"),
    ],
)
def test_the_first_letters_of_one_command_are_enough(store: Store, typed: str, meant: str) -> None:
    teaching = begun(store)
    (whole,) = teaching.apply(Say(meant))
    (begin,) = teaching.apply(Say(typed))
    assert isinstance(whole, Asked)
    assert isinstance(begin, Asked)
    assert (begin.behaviour, begin.question, begin.others) == (whole.behaviour, whole.question, ())
    assert begin.heard == typed.strip()


@pytest.mark.parametrize("typed", ["g", "go", "go to", "ca"])
def test_letters_that_may_mean_several_commands_are_no_command(store: Store, typed: str) -> None:
    (came,) = begun(store).apply(Say(typed))
    assert not isinstance(came, Asked)


def test_the_first_letters_for_a_person_mean_who_asks_first(store: Store) -> None:
    teaching = begun(store)
    (none_asks,) = teaching.apply(Say("go to u"))
    assert isinstance(none_asks, Refused)
    teach(teaching, "greet everyone")
    while not (asking := teaching.world.scene().requests):
        teach(teaching, "cal")
    (asked,) = teaching.apply(Say("go to u"))
    assert isinstance(asked, Asked)
    assert asked.target == asking[0]
    assert teaching.name(asking[0]) in asked.question


def test_the_first_letters_of_a_name_mean_that_person(store: Store) -> None:
    people = load_people(3)
    named = [
        replace(p, name=name) for p, name in zip(people, ("Rosa", "Olga", "Rolf"), strict=True)
    ]
    verifier = begun(store, users=3).phrasebook_for(named)
    state = begun(store, users=3).world.observe
    asks = Verifier(BINGO, verifier, state, {p.id: p.name for p in named})
    (olga, ro) = asks.say(Say("go to ol")), asks.say(Say("go to ro"))
    assert isinstance(olga, Asked)
    assert olga.target == people[1].id
    assert not isinstance(ro, Asked)  # Rosa or Rolf


def test_the_robot_can_be_sent_to_a_player_by_number_or_name(store: Store) -> None:
    teaching = begun(store)
    for phrase in ("go to user 2", "go to user two"):
        asked = teaching.apply(Say(phrase))[0]
        assert isinstance(asked, Asked)
        assert (asked.target, asked.question) == ("user2", "go to the user (User 2)")
    teaching.apply(YES)
    assert teaching.world.observe().place == "user2"


@pytest.mark.parametrize("phrase", ["go to user 7", "Go to user seven, please", "go to 7"])
def test_an_absent_person_is_refused_with_the_list_of_players(store: Store, phrase: str) -> None:
    refused = begun(store).apply(Say(phrase))[0]
    everybody = ("User 1", "User 2", "User 3", "User 4")
    assert refused == Refused("no such person", phrase, "user 7", people=everybody)
    assert refused_words(refused) == (
        "There is no user 7: User 1, User 2, User 3 and User 4 take part."
    )


def test_an_unknown_name_is_refused_with_the_list_of_players(store: Store) -> None:
    teaching = begun(store)
    refused = teaching.apply(Say("go to Zorro"))[0]
    assert isinstance(refused, Refused)
    assert refused_words(refused).startswith("There is nobody called zorro: User 1, ")


def test_after_the_game_only_the_next_one_or_undo_is_possible(store: Store) -> None:
    teaching = begun(store)
    assert isinstance(teaching.apply(Next())[0], Refused)
    demonstration = whole_game(teaching)
    assert demonstration.finished
    assert demonstration.steps[-1].behaviour == "valediction"
    assert isinstance(teaching.apply(Say("tell a joke"))[0], Refused)
    following = teaching.apply(Next())[0]
    assert isinstance(following, Begun)
    assert following.demonstration.seed == demonstration.seed + 1
    assert logged(store) == [demonstration], "a game without a step is not in the log"


def test_undoing_the_last_step_reopens_a_finished_game(store: Store) -> None:
    teaching = begun(store)
    demonstration = whole_game(teaching)
    undone = teaching.apply(Undo())[0]
    assert undone == StepUndone(len(demonstration.steps), demonstration.steps[-1])
    assert not teaching.demonstration.finished
    assert logged(store) == [teaching.demonstration]
    events = [*teaching.apply(Say("goodbye")), *teaching.apply(YES)]
    assert [type(e) for e in events] == [Asked, Executed, Finished]
    assert teaching.demonstration == demonstration
    assert logged(store) == [demonstration]


def test_undo_drops_an_open_question(store: Store) -> None:
    teaching = begun(store)
    teach(teaching, "greet everyone")
    teaching.apply(Say("tell a joke"))
    teaching.apply(Undo())
    assert teaching.question is None
    assert isinstance(teaching.apply(YES)[0], Refused)


# ------------------------------------------------------------------------------ leave, resume


def test_an_unfinished_demonstration_is_resumed(store: Store) -> None:
    first = begun(store)
    teach(first, "greet everyone", *["next number"] * 6)
    second = session(store, seed=9)
    event = second.begin()[0]
    assert event == Begun(first.demonstration, resumed=True)
    assert second.demonstration == first.demonstration
    assert second.world.observe() == first.world.observe()
    assert second.world.scene() == first.world.scene()
    assert teach(first, "next number")[0].outcome == teach(second, "next number")[0].outcome


def test_a_new_demonstration_leaves_an_unfinished_one_unchanged(store: Store) -> None:
    teach(begun(store), "greet everyone")
    second = session(store, seed=2)
    assert second.begin(resume=False)[0] == Begun(second.demonstration, resumed=False)
    teach(second, "greet everyone")
    assert [len(d.steps) for d in logged(store)] == [1, 1]


def test_a_teacher_does_not_resume_the_demonstration_of_another(store: Store) -> None:
    teach(begun(store), "greet everyone")
    event = session(store, teacher="Bo", seed=2).begin()[0]
    assert isinstance(event, Begun)
    assert not event.resumed


def test_a_resumed_demonstration_keeps_its_people(store: Store) -> None:
    teach(begun(store), "greet everyone")
    with_eight = begun(store, users=8, seed=5)
    assert len(with_eight.people) == 4
    assert not isinstance(with_eight.apply(Say("go to user 7"))[0], Asked)
    assert isinstance(with_eight.apply(Say("go to user 3"))[0], Asked)


def test_a_demonstration_of_another_simulator_is_kept_but_not_resumed(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = begun(store)
    teach(first, "greet everyone", "next number")
    behaviours = dict(BINGO.behaviours)
    del behaviours["call number"]
    monkeypatch.setitem(BINGO.__dict__, "behaviours", behaviours)
    refused, new = session(store, seed=2).begin()
    assert isinstance(refused, Refused)
    assert refused.why == "another simulator"
    assert isinstance(new, Begun)
    assert logged(store) == [first.demonstration]


# ------------------------------------------------------------------------ the scripted teacher


@pytest.mark.parametrize("users", [1, 4, 8])
def test_the_scripted_teacher_demonstrates_the_expected_behaviours(
    users: int, store: Store
) -> None:
    teaching = begun(store, users=users)
    demonstration = whole_game(teaching)
    assert demonstration.finished
    for step in demonstration.steps:
        assert step.behaviour == BINGO.expected[step.state.situation]
    assert logged(store) == [demonstration]


def test_the_scripted_teacher_teaches_a_made_up_activity_too(
    lanterns: Activity, store: Store
) -> None:
    teaching = session(store, activity=lanterns)
    teaching.begin()
    demonstration = whole_game(teaching)
    assert demonstration.steps[-1].behaviour == "wave off"
    assert read_demonstrations(store, "lanterns") == [demonstration]
    assert logged(store) == []


def test_the_scripted_teacher_needs_expected_behaviours(store: Store) -> None:
    with pytest.raises(TangyError, match=r"does not say what is expected"):
        ScriptedTeacher(session(store, activity=replace(BINGO, expected={})))


def test_an_exact_phrase_needs_few_function_calls(store: Store) -> None:
    """A fifth of the 1,822 calls that it took while it also ranked unneeded alternatives."""
    teaching = begun(store)
    teach(teaching, "greet everyone", "call a number")  # finds the lines of the cards, once
    calls = Counter[str]()

    def count(frame: FrameType, event: str, _: object) -> None:
        module = frame.f_globals.get("__name__", "")
        if event == "call" and "tangy" in module:
            calls[f"{module}.{frame.f_code.co_qualname}"] += 1

    before = sys.getprofile()
    gc.disable()  # or it counts what closes objects of earlier tests
    sys.setprofile(count)
    try:
        asked = teaching.apply(Say("call a number"))
        done = teaching.apply(YES)
    finally:
        sys.setprofile(before)
        gc.enable()
    assert isinstance(asked[0], Asked) and isinstance(done[0], Executed)
    assert 0 < calls.total() <= 364, calls
