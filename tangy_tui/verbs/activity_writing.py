"""`tangy activity import` and `convert`: write the file of an activity."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.verbs.common import Data, as_given

LARGEST_QUESTIONS = 1_000_000  # bytes of a file of questions


def activity_import(
    file: Annotated[Path, typer.Argument(help="Questions: Aiken format, or CSV of Kahoot.")],
    title: Annotated[str, typer.Option(help="What the activity is called.")],
    folder: Annotated[Path, typer.Option(help="Where the files go.")] = Path(),
    data: Data = None,
) -> None:
    """Make an activity from a file of questions.

    It writes the questions as a table, and a file that you can play.
    """
    from tangy_profiles.activity import known_activities
    from tangy_profiles.defaults import QUESTIONS_ACTIVITY
    from tangy_profiles.given_file import read_given_text
    from tangy_tui.app import question_files
    from tangy_tui.app.authors_words import name_of
    from tangy_tui.text import activity_template as template

    questions = question_files.read_questions(
        read_given_text(file, LARGEST_QUESTIONS).lstrip("\ufeff"), file.name
    )
    title = plain(title)
    if not (name := name_of(title)):
        raise TangyError("--title: must have at least one letter.")
    base = known_activities()[QUESTIONS_ACTIVITY].read_text(encoding="utf-8")
    toml = question_files.questions_activity(base, name, title, questions)
    table = question_files.questions_table(questions, template.OR, template.HINT)
    write_new(folder, name, toml, table, data)


def activity_convert(
    file: Annotated[Path, typer.Argument(help="The TOML of an activity of an older Tangy.")],
    to: Annotated[
        Path | None, typer.Option(metavar="FILE", help="The new file; default: beside it, -new.")
    ] = None,
) -> None:
    """Write an older activity's file with the keys of today.

    Its games stay the same, and the old file stays as it is.
    """
    from tangy_tui.app.activity_conversion import converted
    from tangy_tui.text.activity_conversion import (
        COMMENTS,
        converted_lines,
        is_no_activity,
        no_toml_name,
    )

    if file.suffix != ".toml":
        raise TangyError(plain(is_no_activity(str(file))))
    new = file.with_name(f"{file.stem}-new.toml") if to is None else to
    if new.suffix != ".toml":
        raise TangyError(plain(no_toml_name(str(new))))
    found = converted(file, COMMENTS)
    if found.added:
        _write(new, found.text, "choose another with --to")
    for line in converted_lines(str(file), str(new), found.added, found.lacks):
        print(plain(line))


def write_new(
    folder: Path, name: str, activity: str, items: str, data: Path | None, *, cards: bool = False
) -> None:
    """Write the file of a new activity, and its table if it has one; never overwrite a file.

    The commands to go on with get the data folder of this call.
    """
    from tangy_tui.text.activity_questions import written_lines

    toml, table = folder / f"{name}.toml", folder / f"{name}.csv"
    instead = "give it another title"
    if table.exists():
        raise _there_already(table, instead)
    _write(toml, activity, instead)
    if items:
        _write(table, items, instead)
    files = str(toml), str(table) if items else ""
    for line in written_lines(*files, cards=cards, options=as_given(data)):
        print(plain(line))


def _write(path: Path, text: str, instead: str) -> None:
    """Write a new file; `instead` says what to do if there is one of this name."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        raise _there_already(path, instead) from None
    except OSError as error:
        raise TangyError(plain(f"{path}: cannot be written ({error.strerror}).")) from None


def _there_already(path: Path, instead: str) -> TangyError:
    return TangyError(plain(f"{path} is there already: {instead}."))
