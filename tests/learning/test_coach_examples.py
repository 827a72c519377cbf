"""The coach gives examples of what to type, and does not tell which one is right."""

from __future__ import annotations

import pytest

from tangy_profiles.activity import load_activity
from tangy_profiles.state import FRONT, ActivityState, Situation
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.verification import Reply, Say
from tangy_tui.text.coach import EXAMPLES, with_examples

BINGO = load_activity("bingo")
STATE = ActivityState(0, Situation("facilitate", "ANR", "occluded"), FRONT, None, ())
SAYABLE = ("tell a joke", "call number", "say goodbye", "greet everyone")


def test_up_to_three_examples_are_given_in_an_order_that_tells_nothing() -> None:
    said = with_examples("It goes on.", BINGO, STATE, SAYABLE)
    assert said == f"It goes on. {EXAMPLES.format('call number · say goodbye · tell a joke')}"
    other = with_examples("It goes on.", BINGO, STATE, (SAYABLE[2], *SAYABLE[:2]))
    assert other == said


@pytest.mark.parametrize(("room", "count"), [(70, 3), (55, 2), (30, 0)])
def test_fewer_examples_are_given_if_there_is_little_room(room: int, count: int) -> None:
    said = with_examples("It goes on.", BINGO, STATE, SAYABLE, room)
    assert len(said) <= room
    assert sum(phrase in said for phrase in SAYABLE) == count


def test_there_are_no_examples_if_little_can_be_said_or_the_advice_names_it() -> None:
    assert with_examples("It goes on.", BINGO, STATE, SAYABLE[:1]) == "It goes on."
    trivia = load_activity("trivia")
    state = ActivityState(0, trivia.situations[0], FRONT, None, ())
    assert with_examples("Advice.", trivia, state, SAYABLE) == "Advice."


def test_the_examples_can_be_said_in_the_situation(workspace: Workspace) -> None:
    teaching = workspace.teaching("Ada", 1)
    teaching.begin()
    for phrase in ("greet everyone", "call number"):
        state = teaching.world.observe()
        said = with_examples("", teaching.activity, state, teaching.sayable)
        assert phrase in said
        assert said.count(" · ") == min(3, len(teaching.sayable)) - 1
        teaching.apply(Say(phrase))
        teaching.apply(Reply(yes=True))
