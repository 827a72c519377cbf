"""Drills line by line."""

from __future__ import annotations

from collections.abc import Callable

from tangy_profiles.drill_sheet import Sheet
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import nearest, plain
from tangy_tui.app.command_grammar import ANSWERS
from tangy_tui.app.teaching_grammar import Leave, read_teaching
from tangy_tui.language.words import words_of
from tangy_tui.learning.verification import StopCommand
from tangy_tui.monitoring.drill import Drill, Question
from tangy_tui.monitoring.drill_rounds import Round
from tangy_tui.text.drills import (
    HELP,
    NOTHING_MOVES,
    WELCOME,
    asked_words,
    left_words,
    note_words,
    option_words,
    question_words,
    round_parts,
    sheet_lines,
    told_lines,
)

Read = Callable[[], str | None]
"""Returns the next line, None at the end."""
Write = Callable[[str], None]


def drill_by_lines(drill: Drill, write: Write, read: Read, *, strict: bool = False) -> Sheet | None:
    """Rehearse line by line; the end of the input or an interrupt leaves the drill.

    Args:
        drill: the rounds.
        write: writes a line.
        read: returns the next line, None at the end.
        strict: end the drill at an invalid answer instead of asking again.

    Returns:
        The score sheet; None if nothing was answered.

    Raises:
        TangyError: only if `strict`; earlier answers are stored.
        KeyboardInterrupt: re-raised after earlier answers were stored and shown.
    """
    if drill.note:
        write(note_words(drill.note))
    write(WELCOME)
    try:
        _go_through(drill, write, read, strict)
    except KeyboardInterrupt:
        drill.leave()
        _tell(drill, write)
        raise
    return _tell(drill, write)


def _go_through(drill: Drill, write: Write, read: Read, strict: bool) -> None:
    while (shown := drill.next()) is not None:
        write("")
        write(f"Round {shown.number} of {drill.rounds}")
        for label, text in round_parts(drill.simulator, shown):
            write(f"  {label:9}  {text}")
        if not _answer_round(drill, shown, write, read, strict):
            drill.leave()
            return


def _tell(drill: Drill, write: Write) -> Sheet | None:
    """Write the score sheet; for an unfinished drill also what is stored."""
    write("")
    sheet = drill.sheet if drill.sheet.answered else None
    if sheet is not None:
        for _, text in sheet_lines(sheet, before=drill.before):
            write(text)
    if not drill.over:
        write(left_words(drill))
    return sheet


def _answer_round(drill: Drill, shown: Round, write: Write, read: Read, strict: bool) -> bool:
    """Ask the questions of a round; False if it was left."""
    asked: Question | None = None
    drill.shown()
    while (question := drill.question) is not None:
        if question is not asked:
            asked = question
            write(question_words(question, shown))
            for choice in question.choices:
                write(f"  {choice.key}  {option_words(question, choice)}")
        line = read()
        word = "quit" if line is None else line.strip().lower()
        if not word or word.startswith("#"):
            continue
        command = read_teaching(word, words_of(drill.simulator.activity.title))
        if isinstance(command, Leave):
            return False
        if isinstance(command, StopCommand):
            write(NOTHING_MOVES)
            continue
        if question.kind == "clear" and word in ANSWERS:
            word = "y" if ANSWERS[word] else "n"
        if word not in question.keys:
            if strict:
                drill.leave()
                wrong = f"Round {shown.number}, {asked_words(question.kind)}"
                wrong = f"{wrong} {word!r}: {nearest(word, question.keys)} {left_words(drill)}"
                raise TangyError(plain(wrong))
            write(HELP)
            continue
        answered = drill.answer(word)
        if answered is not None:
            for _, text in told_lines(drill.simulator, shown, answered):
                write(f"  {text}")
    return True
