"""`tangy activity new` and `import`: write the file of a new activity."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain

LARGEST_QUESTIONS = 1_000_000  # bytes of a file of questions


def activity_import(
    file: Annotated[Path, typer.Argument(help="Questions: Aiken format, or CSV of Kahoot.")],
    title: Annotated[str, typer.Option(help="What the activity is called.")],
    folder: Annotated[Path, typer.Option(help="Where the files go.")] = Path(),
) -> None:
    """Make an activity from a file of questions.

    It writes the questions as a table, and a file that you can play.
    """
    from tangy_profiles.activity import known_activities
    from tangy_profiles.defaults import QUESTIONS_ACTIVITY
    from tangy_profiles.given_file import read_given_text
    from tangy_tui.app import question_files
    from tangy_tui.text import activity_template as template

    questions = question_files.read_questions(
        read_given_text(file, LARGEST_QUESTIONS).lstrip("\ufeff"), file.name
    )
    new = template.NewActivity(plain(title), "", turns=True)
    if not new.name:
        raise TangyError("--title: must have at least one letter.")
    base = known_activities()[QUESTIONS_ACTIVITY].read_text(encoding="utf-8")
    toml = question_files.questions_activity(base, new.name, new.title, questions)
    table = question_files.questions_table(questions, template.OR, template.HINT)
    _write_new(folder, new.name, toml, table)


def activity_new(
    folder: Annotated[Path, typer.Argument(help="Where the files go.")] = Path(),
) -> None:
    """Write the file of a new activity; it asks you.

    You can play it at once.
    """
    from tangy_tui.text import activity_template as template
    from tangy_tui.text.game_template import ASK_POINTS, game_file

    title = _asked(template.ASK_TITLE)
    while not template.NewActivity(title, "", turns=False).name:
        title = _asked(template.ASK_AGAIN)
    item = _asked(template.ASK_ITEMS)
    while item and _yes_or_no(item):
        item = _asked(template.ASK_WHICH_ITEM)
    item = "" if _yes_or_no(item) is False else template.without_article(item)
    turns = _asked_yes(template.ASK_TURNS)
    new = template.NewActivity(title, item, turns)
    if turns and not item and _asked_yes(ASK_POINTS):
        _write_new(folder, new.name, game_file(new.name, new.title), "")
        return
    table = template.items_table(new) if item else ""
    _write_new(folder, new.name, template.activity_file(new), table)


def _write_new(folder: Path, name: str, activity: str, items: str) -> None:
    """Write the file of a new activity, and its table if it has one; never overwrite a file."""
    from tangy_tui.text import activity_template as template

    toml, table = folder / f"{name}.toml", folder / f"{name}.csv"
    for path in (toml, table):
        if path.exists():
            raise TangyError(plain(f"{path} is there already: give it another title."))
    try:
        folder.mkdir(parents=True, exist_ok=True)
        toml.write_text(activity, encoding="utf-8")
        if items:
            table.write_text(items, encoding="utf-8")
    except OSError as error:
        raise TangyError(plain(f"{toml}: cannot be written ({error.strerror}).")) from None
    for line in template.written_lines(str(toml), str(table) if items else ""):
        print(plain(line))


def _asked_yes(question: str) -> bool:
    """Ask until the answer is yes or no."""
    from tangy_tui.text.activity_template import ASK_YES_OR_NO

    while (said := _yes_or_no(_asked(question))) is None:
        question = ASK_YES_OR_NO
    return said


def _yes_or_no(text: str) -> bool | None:
    from tangy_tui.language.answers import yes_or_no

    return yes_or_no({"y": "yes", "n": "no"}.get(text.lower(), text))


def _asked(question: str) -> str:
    """Ask for a line; drop characters that would break a TOML string."""
    try:
        said = input(question)
    except EOFError:
        raise TangyError("Nothing was answered: nothing is written.") from None
    return " ".join("".join(c for c in plain(said) if c not in '"\\{}').split())[:60]
