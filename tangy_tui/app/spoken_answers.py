"""Spoken answers: the choices of a question, and what an utterance answers to a remark."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_tui.language.answers import choice_in
from tangy_tui.learning.remarks import answers_to
from tangy_tui.learning.teaching_events import Remark, RemarkAnswer, Settle
from tangy_tui.learning.verification import Asked, Offered, Reply, Say

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tangy_tui.learning.verification import StopCommand


def choices_of(question: Asked | Offered | None) -> tuple[str, ...]:
    """Return the alternatives of a question, as worded in it."""
    match question:
        case Offered():
            return question.questions
        case Asked():
            return question.others
    return ()


def answer_by_yes_or_no(answers: Sequence[RemarkAnswer], *, yes: bool) -> RemarkAnswer | None:
    """Return the answer to a remark by a yes or no; None if a yes does not tell which."""
    if not yes:
        return "later"
    return answers[0] if tuple(answers) == ("keep",) else None


def spoken_settling(said: Say | Reply | StopCommand, remark: Remark | None) -> Settle | None:
    """Return the answer to the open remark that an utterance gives; None if it gives none.

    Only words that are no command answer by their number.
    """
    if remark is None:
        return None
    answers = answers_to(remark)
    if isinstance(said, Reply) and said.alternative is None:
        answer = answer_by_yes_or_no(answers, yes=said.yes)
        return None if answer is None else Settle(answer)
    if isinstance(said, Say) and said.commands == ():
        number = choice_in(said.text, answers)
        return None if number is None else Settle(answers[number - 1])
    return None
