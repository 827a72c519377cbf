"""Files of new activities that are adapted from those that come with Tangy."""

from __future__ import annotations

import csv
import io
import json
import re
import tomllib
from collections.abc import Iterable, Mapping, Sequence

from tangy_profiles.activity import known_activities
from tangy_profiles.defaults import NEW_ACTIVITIES
from tangy_profiles.errors import TangyError
from tangy_tui.app.authors_words import listed_answers
from tangy_tui.app.new_activity import CARDS, QUIZ, Examples
from tangy_tui.app.question_files import ChoiceQuestion, questions_activity

Edit = tuple[str, str]


def base_text(kind: str) -> str:
    """Return the file that a kind is made from."""
    return known_activities()[NEW_ACTIVITIES[kind]].read_text(encoding="utf-8")


def base_table(kind: str) -> str:
    """Return the table of the activity that a kind is made from."""
    path = known_activities()[NEW_ACTIVITIES[kind]].with_suffix(".csv")
    return path.read_text(encoding="utf-8")


def examples() -> Examples:
    """Read what the shipped activities offer to the author of a new one."""
    cards = tomllib.loads(base_text(CARDS))
    return Examples(
        rows={k: len(base_table(k).splitlines()) - 1 for k in NEW_ACTIVITIES if k != CARDS},
        patterns={
            one["name"]: tuple(one["shapes"]) for one in cards["patterns"] if "together" not in one
        },
        claim=cards["rules"]["claim"],
        kinds={name: kind for kind, name in NEW_ACTIVITIES.items()},
        said={k: _said(base_text(k), *_ends(base_text(k))) for k in NEW_ACTIVITIES if k != CARDS},
    )


def _ends(text: str) -> tuple[str, str]:
    """Return the behaviours of a file that begin and end a game."""
    file = tomllib.loads(text)
    last = next(name for name, one in file["behaviours"].items() if "finish" in one.get("does", ()))
    return file["expected"][0][-1], last


def _said(text: str, first: str, last: str) -> tuple[str, str]:
    """Return the first text of each of two behaviours of a file."""
    behaviours = tomllib.loads(text)["behaviours"]
    return behaviours[first]["says"][0], behaviours[last]["says"][0]


def with_ends(text: str, welcome: str, goodbye: str) -> str:
    """Return a file that begins and ends its games with these sentences.

    A behaviour that begins with its sentence already keeps its other texts.
    """
    names = _ends(text)
    for name, now, said in zip(names, _said(text, *names), (welcome, goodbye), strict=True):
        if said and said != now:
            says = rf'(^\[behaviours\."{re.escape(name)}"\]\n(?:(?!\[).*\n)*?says = )\[.*\]$'
            text = _edited(text, [(says, rf'\g<1>["{_quoted(said)}"]')])
    return text


def written_table(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table as the text of a CSV file."""
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows([columns, *rows])
    return out.getvalue()


def choice_questions(rows: Iterable[Mapping[str, str]]) -> list[ChoiceQuestion]:
    """Return questions with their options; the right one has another place in each.

    Args:
        rows: `ask`, `right`, and `wrong` with the wrong options between commas.
    """
    found = []
    for number, row in enumerate(rows, 1):
        options = listed_answers(row["wrong"])
        at = number % (len(options) + 1)
        options.insert(at, row["right"])
        found.append(ChoiceQuestion(row["ask"], tuple(options), (at,)))
    return found


def with_columns(table: str, columns: Mapping[str, Sequence[str]]) -> str:
    """Return a table in which columns have other values, or are new."""
    head, *rows = csv.reader(table.splitlines())
    for name, values in columns.items():
        if name not in head:
            head = [*head, name]
            rows = [[*row, ""] for row in rows]
        at = head.index(name)
        for row, value in zip(rows, values, strict=True):
            row[at] = value or row[at]
    return written_table(head, rows)


def quiz_file(
    comment: str,
    name: str,
    title: str,
    questions: Sequence[ChoiceQuestion],
    *,
    teams: Sequence[str] = (),
    points: bool = True,
    rounds: int = 6,
    media: Sequence[str] = (),
    words: Mapping[str, str],
) -> str:
    """Return the file of a quiz.

    Args:
        comment: the first line.
        name: the name of the file without its suffix.
        title: the title.
        questions: the rows of its table; none: the table has the base's own columns.
        teams: who takes turns in place of people.
        points: whether right answers win points.
        rounds: the questions of a game.
        media: columns of the table with files, `picture` or `sound`.
        words: sentences by name: `summary of teams`, and `talk it over` with `think it over`.
    """
    text = base_text(QUIZ)
    if questions:
        text = questions_activity(text, name, title, questions)
        edits: list[Edit] = []
    else:
        edits = [*_named(name, title), (r'file = "[^"]*"', f'file = "{name}.csv"')]
    edits += [(r"\A#.*", comment), (r"rounds = \d+", f"rounds = {rounds}")]
    if teams:
        edits += [
            (
                r"^summary = .*",
                f'summary = "{words["summary of teams"]}"\nteams = {toml_list(teams)}',
            ),
            (re.escape(words["think it over"]), words["talk it over"]),
        ]
    if not points:
        edits += [
            (r', "told"\]', "]"),
            (r", told = \[[^]]*\]", ""),
            (r', sees = \["told"\]', ""),
            (r'  \["over", "told is no".*\n', ""),
            (r"score = .*\n", ""),
            (r'"add score", ', ""),
            (r'\[behaviours\."tell scores"\](?:\n.+)*?(?=\n\[)\n', ""),
        ]
    for column in media:
        edits.append((r'(\[behaviours\."ask question"\]\n)', rf'\g<1>{column} = "{{{column}}}"\n'))
    return _edited(text, edits)


def table_activity(kind: str, comment: str, name: str, title: str, rounds: int) -> str:
    """Return the file of an activity that goes through a table of songs, movements or pairs."""
    return _edited(
        base_text(kind),
        [
            *_named(name, title, titled=True),
            (r"\A#.*", comment),
            (r'file = "[^"]*"', f'file = "{name}.csv"'),
            (r"rounds = \d+", f"rounds = {rounds}"),
        ],
    )


def cards_file(
    comment: str, name: str, title: str, *, claim: str, shapes: Sequence[str], numbers: int
) -> str:
    """Return the file of a game in which numbers are called and people mark cards.

    Args:
        comment: the first line.
        name: the name of the file without its suffix.
        title: the title.
        claim: what people call if they have won.
        shapes: any of these wins.
        numbers: the highest number, a multiple of the columns of a card.
    """
    base = base_text(CARDS)
    theirs = tomllib.loads(base)
    columns = theirs["deck"]["columns"]
    each = numbers // len(columns)
    game, won = theirs["title"], theirs["rules"]["claim"]
    return _edited(
        base,
        [
            *_named(name, title, titled=True),
            (r"\A#.*", comment),
            *(
                (
                    rf"from = {one['from']}, to = {one['to']}",
                    f"from = {first}, to = {first + each - 1}",
                )
                for one, first in zip(columns, range(1, numbers + 1, each), strict=True)
            ),
            (r"^patterns = \[[^]]*\]", f"patterns = {toml_list(shapes)}"),
            (r'^claim = "[^"]*"', f'claim = "{claim}"'),
            (rf"\b([Ww]e play) {game}\b", rf"\g<1> {_quoted(title)}"),
            (rf'^(speech\.\w+ = "){won.capitalize()}!', rf"\g<1>{claim.capitalize()}!"),
            (f"{won.upper()}!", f"{claim.upper()}!"),
        ],
    )


def toml_list(values: Sequence[str]) -> str:
    """Return a list of texts as TOML."""
    return json.dumps(list(values), ensure_ascii=False)


def _quoted(text: str) -> str:
    """Return a text as it stands between the quotes of TOML."""
    return json.dumps(text, ensure_ascii=False)[1:-1].replace("\\", r"\\")


def _named(name: str, title: str, *, titled: bool = False) -> list[Edit]:
    """Return the edits that give a file its name and title, in place of its own title if any."""
    both = f'name = "{name}"\ntitle = "{_quoted(title)}"'
    return [(r'^name = ".*"' + (r'\ntitle = ".*"' if titled else ""), both)]


def _edited(text: str, edits: Iterable[Edit]) -> str:
    """Carry out edits, the first one at most once where it names what comes once.

    Raises:
        TangyError: the base lacks a line that is to be replaced.
    """
    for pattern, new in edits:
        once = 1 if pattern.startswith((r"\A", "^name")) else 0
        text, times = re.subn(pattern, new, text, count=once, flags=re.MULTILINE)
        if not times:
            raise TangyError("The activity from which this one is made has changed.")
    return text
