"""Steering commands to the program itself, typed and spoken."""

from __future__ import annotations

import pytest

from tangy_profiles.activity import load_activity, shipped_activities
from tangy_profiles.person import load_people
from tangy_tui.app.command_grammar import read_command
from tangy_tui.app.game_commands import CallAgain, ChangePace, GoOn, Pause
from tangy_tui.app.teaching_grammar import read_teaching
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.steering import WAYS, steering_of
from tangy_tui.learning.teaching_events import Redo, Undo
from tangy_tui.learning.verification import Say
from tangy_tui.speech.evidence import USUAL, AcousticEvidence
from tangy_tui.speech.understanding import clearly_heard, understand

BOOK = Phrasebook(load_activity("bingo"), load_people(4))


def nobody(name: str) -> str:
    raise AssertionError(name)


@pytest.mark.parametrize("text", WAYS["undo"])
def test_many_phrases_undo_a_step(text: str) -> None:
    assert read_teaching(text) == Undo()


def test_redo_help_pause_and_resume_have_several_phrases() -> None:
    assert read_teaching("please redo that") == Redo()
    assert read_teaching("What can I say?") == "phrases"
    assert read_teaching("I need help") == "help"
    assert read_command("let's take a break", nobody) == Pause()
    assert read_command("please carry on", nobody) == GoOn()
    assert read_command("what was that?", nobody) == CallAgain()
    assert read_command("That's too fast.", nobody) == ChangePace(-1)
    assert read_command("please go a little faster", nobody) == ChangePace(1)


@pytest.mark.parametrize("name", list(shipped_activities()))
def test_no_phrase_of_an_activity_steers_the_program(name: str) -> None:
    book = Phrasebook(load_activity(name), load_people(4))
    assert [phrase for phrase in book.phrases if steering_of(phrase)] == []


def test_spoken_steering_needs_an_agreeing_sound() -> None:
    assert understand(clearly_heard("undo that"), BOOK, USUAL) == Say("undo that", 1.0, None)
    agreed = AcousticEvidence("take that back", "take that back", -1.0, 1.0, 1.0)
    assert understand(agreed, BOOK, USUAL) == Say("take that back", 1.0, None)
    doubtful = AcousticEvidence("take that back", "", -1.0, 1.0, 1.0)
    said = understand(doubtful, BOOK, USUAL)
    assert isinstance(said, Say) and said.commands == ()


@pytest.mark.parametrize("text", ["I undid my coat", "help the user", "the step was high", ""])
def test_other_words_are_no_steering(text: str) -> None:
    assert steering_of(text) is None
