"""A teacher's own phrases: words that Tangy did not understand at first, and learnt afterwards."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tangy_tui.app.workspace import Workspace
from tangy_tui.language.commands import Command
from tangy_tui.learning.own_phrases import forget_phrase, own_phrases
from tangy_tui.learning.teaching_events import NewWording, Settle, TeachingEvent
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import NotUnderstood, Refused, Reply, Say

WORDS = "let it all begin"


@pytest.fixture
def workspace(tmp_path: Path) -> Iterator[Workspace]:
    opened = Workspace(tmp_path)
    yield opened
    opened.close()


def session(workspace: Workspace, teacher: str = "Ada") -> TeachingSession:
    teaching = workspace.teaching(teacher, 1)
    teaching.begin(resume=False)
    return teaching


def say(teaching: TeachingSession, words: str) -> list[TeachingEvent]:
    """Say words that mean nothing to Tangy."""
    return teaching.apply(Say(words, 0.2, ()))


def show(teaching: TeachingSession, phrase: str) -> list[TeachingEvent]:
    teaching.apply(Say(phrase))
    return teaching.apply(Reply(yes=True))


def asked(events: list[TeachingEvent]) -> list[NewWording]:
    return [event for event in events if isinstance(event, NewWording)]


def meant(teaching: TeachingSession, words: str) -> str | None:
    command = teaching.phrasebook.understand(words)
    return command.behaviour if command is not None and command.confidence == 1 else None


def test_only_the_next_command_can_explain_unknown_words(workspace: Workspace) -> None:
    teaching = session(workspace)
    say(teaching, WORDS)
    teaching.apply(Say("call number"))
    teaching.apply(Reply(yes=False))  # the teacher wants something else now
    assert asked(show(teaching, "greet everyone")) == []


def test_a_refused_command_was_the_next_one(workspace: Workspace) -> None:
    teaching = session(workspace)
    say(teaching, WORDS)
    assert isinstance(teaching.apply(Say("go to user nine"))[0], Refused)
    assert asked(show(teaching, "greet everyone")) == []


def test_tangy_offers_to_learn_words_after_the_meaning_was_typed(
    workspace: Workspace,
) -> None:
    teaching = session(workspace)
    assert isinstance(say(teaching, WORDS)[0], NotUnderstood)
    (remark,) = asked(show(teaching, "greet everyone"))
    assert (remark.words, remark.step.behaviour) == (WORDS, "greeting")


def test_kept_words_become_a_phrase_of_that_teacher_only(
    workspace: Workspace,
) -> None:
    teaching = session(workspace)
    say(teaching, WORDS)
    show(teaching, "greet everyone")
    assert meant(teaching, WORDS) is None
    teaching.apply(Settle("keep"))
    assert meant(teaching, WORDS) == "greeting"
    assert WORDS in teaching.phrasebook.spoken(), "it is listened for"
    assert meant(session(workspace), WORDS) == "greeting"
    assert meant(session(workspace, "Bea"), WORDS) is None


def test_tangy_offers_to_learn_words_after_a_choice(workspace: Workspace) -> None:
    teaching = session(workspace)
    offers = tuple(Command(b, {}, 0.5, WORDS, ()) for b in ("joke", "greeting"))
    teaching.apply(Say(WORDS, 0.5, offers, sure=False))
    teaching.apply(Reply(yes=False, alternative=2))
    (remark,) = asked(teaching.apply(Reply(yes=True)))
    assert (remark.words, remark.step.behaviour) == (WORDS, "greeting")


@pytest.mark.parametrize("answer", ["keep", "later"])
def test_tangy_offers_to_learn_words_only_once(workspace: Workspace, answer: str) -> None:
    teaching = session(workspace)
    say(teaching, WORDS)
    show(teaching, "greet everyone")
    teaching.apply(Settle("keep" if answer == "keep" else "later"))
    say(teaching, WORDS)
    assert asked(show(teaching, "greet everyone")) == []
    again = session(workspace)
    say(again, WORDS)
    assert asked(show(again, "greet everyone")) == []


@pytest.mark.parametrize(
    "words",
    ["stop the robot", "yes that is right", "undo that", "call number", "", "rosa's 4 numbers"],
)
def test_tangy_does_not_offer_words_with_another_meaning(workspace: Workspace, words: str) -> None:
    teaching = session(workspace)
    say(teaching, words)
    assert asked(show(teaching, "greet everyone")) == []


def test_tangy_does_not_offer_words_for_going_to_a_person(workspace: Workspace) -> None:
    teaching = session(workspace)
    say(teaching, "over there")
    assert asked(show(teaching, "go to user 1")) == []


def test_a_removed_phrase_is_not_offered_again(
    workspace: Workspace,
) -> None:
    teaching = session(workspace)
    say(teaching, WORDS)
    show(teaching, "greet everyone")
    teaching.apply(Settle("keep"))
    assert own_phrases(workspace.store, "bingo", "Ada") == {WORDS: "greeting"}
    assert forget_phrase(workspace.store, "bingo", "Ada", WORDS)
    assert not forget_phrase(workspace.store, "bingo", "Ada", WORDS)
    again = session(workspace)
    assert meant(again, WORDS) is None
    say(again, WORDS)
    assert asked(show(again, "greet everyone")) == []
