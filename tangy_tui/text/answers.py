"""Answers to the questions of staff about a game, for the screen and for lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, assert_never

from tangy_tui.app.game_moment import game_moment
from tangy_tui.app.game_questions import AsksGame
from tangy_tui.app.inquiry_grammar import (
    AsksAbout,
    AsksHowLong,
    AsksNext,
    AsksWhoWaits,
    AsksWhoWon,
    Question,
)
from tangy_tui.text.game_answers import WHAT_YOU_ASKED, game_answer_lines
from tangy_tui.text.next_up import WHAT_NEXT, next_lines
from tangy_tui.text.planned_time import HOW_LONG, time_lines
from tangy_tui.text.whose_turn import WHO_WAITS, WHOSE_TURN, about_lines, waiting_lines
from tangy_tui.text.winners import WHO_WON, won_lines

if TYPE_CHECKING:
    from tangy_tui.app.game_controller import GameController
    from tangy_tui.text.situations import Name


class GameAnswer(NamedTuple):
    """The answer to a question, with a title for a dialog."""

    title: str
    lines: list[str]


def answer_to(question: Question, control: GameController, name: Name) -> GameAnswer:
    """Answer a question about the present game; `name` returns a person's name for an id."""
    match question:
        case AsksHowLong():
            return GameAnswer(HOW_LONG, time_lines(control))
        case AsksWhoWaits():
            return GameAnswer(WHO_WAITS, waiting_lines(game_moment(control), name))
        case AsksWhoWon():
            return GameAnswer(WHO_WON, won_lines(control, name))
        case AsksGame():
            return GameAnswer(WHAT_YOU_ASKED, game_answer_lines(question, control, name))
        case AsksNext():
            activity = control.supervision.world.activity
            return GameAnswer(WHAT_NEXT, next_lines(activity, game_moment(control), name))
        case AsksAbout():
            return GameAnswer(WHOSE_TURN, about_lines(control, question, name))
        case forgotten:
            assert_never(forgotten)
