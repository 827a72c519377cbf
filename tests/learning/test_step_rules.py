"""Rules from steps: they cover undemonstrated situations, are learnt, and can be undone."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.situations import seen_facts
from tangy_tui.app.teaching_grammar import read_teaching
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.confirming import ConfirmingTeacher
from tangy_tui.console.typed_yes import TypedYes
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policy import learn_policy
from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.learning.teaching_events import (
    NoRule,
    Ruled,
    RuleUndone,
    SameWhatever,
    StepUndone,
    Undo,
)
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.text.teaching import rule_words, rule_words_asked
from tests.support.teaching import taught_until

STAGE = "listen"


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    return Workspace(tmp_path, activity="trivia")


@pytest.fixture
def teaching(workspace: Workspace) -> TeachingSession:
    """Return a session that waits for an answer about its last step."""
    return taught_until(workspace, STAGE)


def ruled(teaching: TeachingSession, *facts: str) -> Ruled:
    (event,) = teaching.apply(SameWhatever(facts))
    assert isinstance(event, Ruled)
    return event


@pytest.mark.parametrize(
    ("words", "facts"),
    [
        ("the same whatever clock", ("clock",)),
        ("It is the same whatever the clock is", ("clock",)),
        ("always the same whatever the clock and hinted are", ("clock", "hinted")),
        ("the same whatever the value of clock or hinted", ("clock", "hinted")),
        ("the same whatever happens", ()),
    ],
)
def test_a_rule_can_be_given_in_words(words: str, facts: tuple[str, ...]) -> None:
    assert read_teaching(words) == SameWhatever(facts)


def test_a_rule_covers_situations_that_differ_only_in_its_fact(teaching: TeachingSession) -> None:
    own = teaching.demonstration.steps[-1].state.situation
    rule = ruled(teaching, "clock")
    assert rule.covers and own not in rule.covers
    for situation in rule.covers:
        assert situation.stage == own.stage
        assert seen_facts(situation)["hinted"] == seen_facts(own)["hinted"]


def test_covered_situations_are_decided_by_the_rule(
    workspace: Workspace, teaching: TeachingSession
) -> None:
    rule, done = ruled(teaching, "clock"), teaching.demonstration.steps[-1].behaviour
    library = read_library(workspace.store, "trivia")
    shown = [teaching.demonstration]
    policy = learn_policy(teaching.activity, shown, resolutions=library.resolutions)
    for situation in rule.covers:
        decision = policy.decide(situation)
        assert (decision.behaviour, decision.sure, decision.seen) == (done, True, 0)
        assert decision.whatever
    others = [s for s in teaching.activity.situations if s.stage == "judge"]
    assert not any(policy.decide(situation).sure for situation in others)


def test_undo_removes_the_rule_before_the_step(
    workspace: Workspace, teaching: TeachingSession
) -> None:
    ruled(teaching, "clock")
    steps = len(teaching.demonstration.steps)
    (event,) = teaching.apply(Undo())
    assert isinstance(event, RuleUndone) and len(teaching.demonstration.steps) == steps
    assert read_library(workspace.store, "trivia").resolutions == ()
    assert isinstance(teaching.apply(Undo())[0], StepUndone)


@pytest.mark.parametrize("facts", [("weather",), ("answer",)])
def test_a_rule_about_an_unused_fact_is_refused(
    workspace: Workspace, teaching: TeachingSession, facts: tuple[str, ...]
) -> None:
    assert isinstance(teaching.apply(SameWhatever(facts))[0], NoRule)
    assert read_library(workspace.store, "trivia").resolutions == ()


def test_an_activity_without_facts_says_that_it_has_no_rules(tmp_path: Path) -> None:
    session = Workspace(tmp_path).teaching("Mary", 1)
    session.begin()
    teacher = ScriptedTeacher(session)
    while not session.demonstration.steps or not session.demonstration.steps[-1].target:
        session.apply(teacher.command())
    assert session.rules.choices(session.demonstration) == NoRule("no facts")
    assert session.apply(SameWhatever()) == [NoRule("no facts")]


def test_a_typed_rule_is_only_made_after_a_yes(
    workspace: Workspace, teaching: TeachingSession
) -> None:
    written: list[str] = []
    asks = ConfirmingTeacher(teaching, TypedYes(terminal=True, setting="y"), written.append)
    rule = SameWhatever(("clock",))
    assert asks.ask(rule) is None and asks.open
    assert "value" not in written[0] and "clock" not in written[0].partition("?")[0]
    assert read_library(workspace.store, "trivia").resolutions == ()
    would = teaching.rules.would(teaching.demonstration, rule)
    assert isinstance(would, Ruled)
    for situation in would.covers:
        assert teaching.activity.in_words(situation) in written[0]
    assert asks.ask(SameWhatever(("weather",))) == SameWhatever(("weather",)), "tells why not"


@pytest.mark.parametrize(("line", "stays"), [("y", True), ("N", False), ("no", False)])
def test_a_script_is_not_asked_about_a_rule_but_may_hold_the_answer(
    workspace: Workspace, teaching: TeachingSession, line: str, stays: bool
) -> None:
    asks = ConfirmingTeacher(teaching, TypedYes(), list[str]().append)
    rule = asks.ask(SameWhatever(("clock",)))
    assert rule is not None and not asks.open
    assert isinstance(teaching.apply(rule)[0], Ruled)
    assert asks.takes(line)
    if (then := asks.answer(line)) is not None:
        assert isinstance(teaching.apply(then)[0], RuleUndone)
    assert bool(read_library(workspace.store, "trivia").resolutions) == stays
    assert not asks.takes("n"), "the step itself stays"


def test_a_line_after_a_rule_of_a_script_that_answers_nothing_is_a_command(
    teaching: TeachingSession,
) -> None:
    asks = ConfirmingTeacher(teaching, TypedYes(), list[str]().append)
    assert asks.ask(SameWhatever(("clock",))) is not None
    assert not asks.takes("2") and not asks.takes("n")
    assert asks.ask(SameWhatever(("weather",))) is not None and not asks.takes("n"), "no rule"


def test_a_rule_names_facts_by_the_words_of_the_activity_and_leaves_others_out(
    teaching: TeachingSession,
) -> None:
    activity = teaching.activity
    assert isinstance(activity, DeclaredActivity)
    facts = dict(activity.declaration.facts)
    facts["clock"] = replace(facts["clock"], words=())
    facts["hinted"] = replace(facts["hinted"], words=("no hint yet", "a hint was given"))
    told = replace(activity, declaration=replace(activity.declaration, facts=facts))
    rule = teaching.rules.would(teaching.demonstration, SameWhatever(("clock", "hinted")))
    assert isinstance(rule, Ruled)
    question, _ = rule_words_asked(rule, told)
    assert question.endswith(", no matter whether no hint yet or a hint was given?")
    assert "clock" not in question


def test_a_step_that_cannot_be_a_rule_is_refused_in_plain_words(tmp_path: Path) -> None:
    activity = Workspace(tmp_path).activity
    assert "depends on nothing that changes" in rule_words(NoRule("no facts"), activity)
