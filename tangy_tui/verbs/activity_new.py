"""`tangy activity new`: asks an author about a new activity, tries it, and writes its files."""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.verbs.common import Data

if TYPE_CHECKING:
    from tangy_tui.app.new_activity import Draft
    from tangy_tui.app.question_files import ChoiceQuestion

SHOWN, SHOWN_LAST = 8, 3
"""The first and the last steps of a game that the preview shows."""


def activity_new(
    folder: Annotated[Path, typer.Argument(help="Where the files go.")] = Path(),
    title: Annotated[str | None, typer.Option(help="What the activity is called.")] = None,
    kind: Annotated[
        str | None,
        typer.Option(help="quiz, talk, songs, exercises, memory, game, cards (called numbers)."),
    ] = None,
    questions: Annotated[
        Path | None, typer.Option(metavar="FILE", help="A quiz: Aiken format, or CSV of Kahoot.")
    ] = None,
    row: Annotated[
        list[str] | None,
        typer.Option(metavar="PARTS", help="A question, song ...: its parts, with ; between them."),
    ] = None,
    teams: Annotated[
        str | None, typer.Option(help="A quiz: teams that take turns, with commas.")
    ] = None,
    points: Annotated[bool | None, typer.Option(help="A quiz: right answers win points.")] = None,
    rounds: Annotated[
        int | None, typer.Option(help="How many questions, songs ... come up in a game.")
    ] = None,
    item: Annotated[
        str | None, typer.Option(help="Talk: what a round brings, such as poem.")
    ] = None,
    turns: Annotated[bool | None, typer.Option(help="Talk: people take turns.")] = None,
    win_at: Annotated[int | None, typer.Option(help="A game: points to win.")] = None,
    claim: Annotated[str | None, typer.Option(help="Cards: what people call out to win.")] = None,
    pattern: Annotated[str | None, typer.Option(help="Cards: what wins, such as a line.")] = None,
    numbers: Annotated[int | None, typer.Option(help="Cards: the highest number.")] = None,
    welcome: Annotated[str | None, typer.Option(help="What Tangy says to welcome people.")] = None,
    goodbye: Annotated[str | None, typer.Option(help="What Tangy says at the very end.")] = None,
    yes: Annotated[
        bool, typer.Option("--yes", help="Ask nothing: what no option says is as usual.")
    ] = False,
    data: Data = None,
) -> None:
    """Make a new activity; it asks you first.

    It shows you a game before it writes anything, and you can teach and play it at once. Each
    option answers a question.
    """
    from tangy_profiles.given_file import read_given_text
    from tangy_tui.app import new_activity as new
    from tangy_tui.app.activity_bases import examples
    from tangy_tui.app.question_files import read_questions
    from tangy_tui.text.activity_questions import ENDS_OF_TEMPLATES
    from tangy_tui.verbs.activity_writing import LARGEST_QUESTIONS

    offered = examples()
    said = {**offered.said, new.TALK: ENDS_OF_TEMPLATES, new.GAME: ENDS_OF_TEMPLATES}
    draft = new.Draft(folder, offered._replace(said=said))
    read = list["ChoiceQuestion"]()
    if questions is not None:
        text = read_given_text(questions, LARGEST_QUESTIONS).lstrip("\ufeff")
        read = read_questions(text, questions.name)
        draft.imported = len(read)
        kind = kind or new.QUIZ
    yes_no = {True: "y", False: "n", None: None}
    _give(
        draft,
        {
            new.TITLE: title,
            new.KIND: kind,
            new.TEAMS: teams,
            new.POINTS: yes_no[points],
            new.ITEM: item,
            new.TURNS: yes_no[turns],
            new.WIN_AT: win_at,
            new.CLAIM: claim,
            new.PATTERN: pattern,
            new.NUMBERS: numbers,
            new.WELCOME: welcome,
            new.GOODBYE: goodbye,
        },
    )
    if row:
        _give_rows(draft, row)
    if rounds is not None:
        _give(draft, {new.ROUNDS: rounds})
    if yes:
        while (key := draft.open()) is not None:
            _take(draft, key, "")
        problems = _made(draft, read, show=False)
        if problems:
            raise TangyError(problems[0])
    else:
        _ask_all(draft, read)
    _write(draft, read, data)


def _give(draft: Draft, answers: dict[str, str | int | None]) -> None:
    for key, said in answers.items():
        if said is not None:
            _take(draft, key, str(said))
            draft.given.add(key)


def _give_rows(draft: Draft, rows: list[str]) -> None:
    """Answer the questions about the rows of the table from options."""
    from tangy_tui.app.new_activity import MEDIA, PICTURE, QUIZ, Problem, row_key
    from tangy_tui.text.activity_questions import problem_words

    if draft.kind == QUIZ and any(row.count(";") >= _place(draft, PICTURE) for row in rows):
        _give(draft, {MEDIA: "y"})
    if not draft.fields:
        raise TangyError(plain(f"--row: {problem_words(Problem('no rows'))}"))
    for number, row in enumerate(rows, 1):
        parts = [one.strip() for one in row.split(";")]
        if not parts[0] or len(parts) > len(draft.fields):
            raise TangyError(
                plain(f"--row {row!r}: {problem_words(Problem('no fields', draft.fields))}")
            )
        for at, field in enumerate(draft.fields):
            _give(draft, {row_key(field, number): parts[at] if at < len(parts) else ""})
    _give(draft, {row_key(draft.fields[0], len(rows) + 1): ""})


def _place(draft: Draft, field: str) -> int:
    from tangy_tui.app.new_activity import ROWS

    return (*ROWS[draft.kind], field).index(field)


def _take(draft: Draft, key: str, said: str) -> None:
    """Take the answer of an option.

    Raises:
        TangyError: it cannot be taken.
    """
    from tangy_tui.app.new_activity import split_key
    from tangy_tui.text.activity_questions import problem_words

    if (problem := draft.answer(key, said)) is not None:
        option = "row" if split_key(key)[1] else key
        raise TangyError(plain(f"--{option}: {problem_words(problem)}"))


def _ask_all(draft: Draft, read: list[ChoiceQuestion]) -> None:
    """Ask until all is answered and the author has said yes."""
    from tangy_tui.text import activity_questions as words

    _show(*words.BEGIN)
    while True:
        while (key := draft.open()) is not None:
            _ask(draft, key)
        _show("", words.ONE_MOMENT)
        problems = _made(draft, read, show=True)
        _drop_typed()
        print()
        _show(*words.draft_lines(draft))
        if problems:
            _show("", words.WITH_MISTAKES, *problems)
        _ask_to_write(draft, allowed=not problems)
        if draft.open() is None:
            return


def _ask(draft: Draft, key: str) -> None:
    from tangy_tui.text import activity_questions as words

    print()
    _show(*words.question_lines(draft, key))
    said = _asked()
    if said.lower() in words.BACK:
        if not draft.back():
            print(words.AT_THE_FIRST)
        return
    if (problem := draft.answer(key, said)) is not None:
        told = words.problem_words(problem)
        print(plain(f"{told} {words.OR_BACK}" if problem.code == "empty" else told))


def _ask_to_write(draft: Draft, *, allowed: bool) -> None:
    """Ask whether to write the files; return with an open question if the author changes one."""
    from tangy_tui.language.answers import yes_or_no
    from tangy_tui.text import activity_questions as words

    print(f"\n{words.WRITE if allowed else words.WRITE_AGAIN}")
    listed = words.answers(draft)
    while True:
        said = _asked().lower()
        chosen = int(said) if said.isdecimal() else 0
        if said in words.BACK:
            draft.back()
            return
        if 1 <= chosen <= len(listed):
            draft.reopen(*listed[chosen - 1][1])
            draft.given -= set(listed[chosen - 1][1])
            return
        answer = yes_or_no({"y": "yes", "n": "no"}.get(said, said))
        if answer is False:
            print(words.NOTHING_WRITTEN)
            raise typer.Exit
        if answer and allowed:
            return
        print(words.WRITE_AGAIN)


def _made(draft: Draft, read: list[ChoiceQuestion], *, show: bool) -> list[str]:
    """Build the activity in a folder of its own and check it; return its mistakes.

    With `show`, print the first steps of a game.
    """
    from tangy_profiles.robot import load_robot
    from tangy_tui.app.new_activity import CARDS
    from tangy_tui.app.trying import tried_game
    from tangy_tui.text import activity_questions as words
    from tangy_tui.text.activities import people_did, tried_lines
    from tangy_tui.text.numbers import counted
    from tangy_tui.verbs.activity import checked_file
    from tangy_tui.verbs.activity_files import built

    toml, table = built(draft, read)
    with tempfile.TemporaryDirectory() as made:
        path = Path(made) / f"{draft.name}.toml"
        path.write_text(toml, encoding="utf-8")
        if table:
            path.with_suffix(".csv").write_text(table, encoding="utf-8")
        for one in draft.files():
            (Path(made) / one.name).write_bytes(one.read_bytes())
        checked, activity = checked_file(str(path), load_robot())
        if checked.mistakes or activity is None:
            return [plain(line) for line in checked.mistakes]
        if show and draft.kind != CARDS:
            print(f"\n{words.BEGINS}")
            steps = list(tried_game(activity, 4, 1))
            left_out = steps[SHOWN:-SHOWN_LAST]
            for step in steps:
                if step in left_out:
                    if step is left_out[0]:
                        _show(words.LEFT_OUT.format(counted(len(left_out), "step")))
                    continue
                lines = (*tried_lines(step), people_did(step.doing, step.silent))
                _show(*(line for line in lines if line))
        if show:
            print(f"\n{words.CHECKED}")
            _show(*(f"  {line}" for line in checked.warnings))
    return []


def _write(draft: Draft, read: list[ChoiceQuestion], data: Path | None) -> None:
    from tangy_tui.app.new_activity import CARDS
    from tangy_tui.verbs.activity_files import built
    from tangy_tui.verbs.activity_writing import write_new

    toml, table = built(draft, read)
    write_new(draft.folder, draft.name, toml, table, data, cards=draft.kind == CARDS)


def _show(*lines: str) -> None:
    """Print lines; at a terminal, divide long ones between words."""
    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else 0
    for line in map(plain, lines):
        hang = " " * (len(line) - len(line.lstrip()) + 2)
        parts = wrap(line, width, subsequent_indent=hang) if 20 < width < len(line) else [line]
        print("\n".join(parts))


def _drop_typed() -> None:
    """Drop what was typed at the terminal before the question was there."""
    import termios

    if sys.stdin.isatty():
        sys.stdout.flush()
        termios.tcflush(sys.stdin, termios.TCIFLUSH)


def _asked() -> str:
    """Read a line; show it if it was not typed at a terminal, which shows it itself."""
    from tangy_tui.text.activity_questions import ANSWER, NOTHING_ANSWERED

    try:
        said = input(ANSWER)
    except EOFError:
        print()
        raise TangyError(NOTHING_ANSWERED) from None
    if not sys.stdin.isatty():
        print(plain(said))
    return " ".join(said.split())
