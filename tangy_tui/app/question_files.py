"""Questions with answers to choose from, read from files of other programs.

Two formats: Aiken (Moodle and others) has the question on one line, `A. answer` or `A) answer` on
the next ones, then `ANSWER: B`. Kahoot's spreadsheet as CSV has a header with question, answers 1
to 4 and the numbers of the correct ones, below any number of lines with instructions.
"""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain

MOST_OPTIONS = 6
LETTERS = "abcdef"
ROUNDS = 6
LONGEST = 300  # characters of a question or an answer
_OPTION = re.compile(r"([A-Za-z])[.)]\s*(\S.*)")
_ANSWER = re.compile(r"ANSWER:\s*([A-Za-z])\s*", re.I)
_NUMBERED = re.compile(r"answer\s*(\d)\b", re.I)


@dataclass(frozen=True, slots=True)
class ChoiceQuestion:
    """A question, its options, and the indices of the right ones, from 0."""

    ask: str
    options: tuple[str, ...]
    right: tuple[int, ...]


def read_questions(text: str, name: str) -> list[ChoiceQuestion]:
    """Read questions from a file in Aiken format or from a Kahoot CSV.

    Args:
        text: the contents of the file.
        name: its name, for error messages.

    Raises:
        TangyError: a line cannot be parsed (the message names it), or there is no question.
    """
    aiken = any(_ANSWER.fullmatch(line.strip()) for line in text.splitlines())
    found = list(_aiken(text, name) if aiken else _kahoot(text, name))
    if not found:
        raise TangyError(
            plain(f"{name}: there is no question in it, in the Aiken format or in Kahoot's CSV.")
        )
    return found


def _aiken(text: str, name: str) -> Iterator[ChoiceQuestion]:
    ask, options = list[str](), dict[str, str]()
    number = 0
    for number, line in enumerate(map(str.strip, text.splitlines()), 1):
        if answer := _ANSWER.fullmatch(line):
            letter = answer[1].upper()
            if letter not in options:
                raise _wrong(name, number, f"the answer {letter} is not one of the options")
            yield _checked(name, number, " ".join(ask), list(options.values()),
                           [list(options).index(letter)])  # fmt: skip
            ask, options = [], {}
        elif (option := _OPTION.fullmatch(line)) and ask:
            options[option[1].upper()] = option[2]
        elif line and options:
            raise _wrong(name, number, "an option or ANSWER: is expected")
        elif line:
            ask.append(line)
    if ask:
        raise _wrong(name, number, "the last question has no ANSWER:")


def _kahoot(text: str, name: str) -> Iterator[ChoiceQuestion]:
    lines = text.splitlines()
    separator = max(",;\t", key=lambda one: max((line.count(one) for line in lines), default=0))
    columns: dict[int, int] = {}
    ask = right = -1
    for number, row in enumerate(csv.reader(lines, delimiter=separator), 1):
        cells = [" ".join(cell.split()) for cell in row]
        lower = [cell.casefold() for cell in cells]
        if not columns:
            columns = {int(m[1]): n for n, one in enumerate(lower) if (m := _NUMBERED.match(one))}
            ask = next((n for n, one in enumerate(lower) if one.startswith("question")), -1)
            right = next((n for n, one in enumerate(lower) if "correct" in one), -1)
            columns = columns if ask >= 0 and right >= 0 and len(columns) > 1 else {}
            continue
        cells += [""] * (1 + max(ask, right, *columns.values()) - len(cells))
        if not cells[ask]:
            continue
        given = [(n, cells[place]) for n, place in sorted(columns.items()) if cells[place]]
        numbers = [int(one) for one in re.findall(r"\d+", cells[right])]
        places = [place for place, (n, _) in enumerate(given) if n in numbers]
        if not numbers or len(places) < len(numbers):
            raise _wrong(name, number, "the correct answer must be the number of an answer")
        yield _checked(name, number, cells[ask], [option for _, option in given], places)


def _checked(
    name: str, number: int, ask: str, options: list[str], right: list[int]
) -> ChoiceQuestion:
    if not ask:
        raise _wrong(name, number, "the question is missing")
    if not 2 <= len({one.casefold() for one in options}) == len(options) <= MOST_OPTIONS:
        raise _wrong(name, number, f"there must be from 2 to {MOST_OPTIONS} different options")
    if any(len(one) > LONGEST or plain(one) != one for one in (ask, *options)):
        raise _wrong(name, number, f"a text is longer than {LONGEST} characters, or not plain")
    return ChoiceQuestion(ask, tuple(options), tuple(right))


def _wrong(name: str, number: int, problem: str) -> TangyError:
    return TangyError(plain(f"{name}, line {number}: {problem}."))


def questions_table(questions: Sequence[ChoiceQuestion], either: str, hint: str) -> str:
    """Return the table of an activity: question, each option, all of them, the right one, a hint.

    Args:
        questions: the rows of the table.
        either: a template for the options in a sentence: all but the last one, and the last one.
        hint: a template that names a wrong option, for questions with more than two.
    """
    most = max(len(one.options) for one in questions)
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["ask", *LETTERS[:most], "choices", "lettered", "right", "hint"])
    for one in questions:
        *first, last = one.options
        wrong = [option for place, option in enumerate(one.options) if place not in one.right]
        told = hint.format(wrong[-1]) if len(one.options) > 2 and wrong else ""
        writer.writerow([
            one.ask,
            *one.options,
            *[""] * (most - len(one.options)),
            either.format(", ".join(first), last),
            "  ".join(f"{LETTERS[n].upper()} {option}" for n, option in enumerate(one.options)),
            "|".join(one.options[place] for place in one.right),
            told,
        ])  # fmt: skip
    return out.getvalue()


def questions_activity(
    base: str, name: str, title: str, questions: Sequence[ChoiceQuestion]
) -> str:
    """Return the text of an activity file with these questions.

    Args:
        base: the text of the activity file to adapt, whose questions have three options.
        name: the file name without its suffix.
        title: the title of the activity.
        questions: the rows of its table.

    Raises:
        TangyError: the base lacks a line that is to be replaced.
    """
    most = max(len(one.options) for one in questions)
    options = ", ".join(f'"{letter}"' for letter in LETTERS[:most])
    for pattern, new in (
        (r'^name = ".*"', f'name = "{name}"\ntitle = {json.dumps(title, ensure_ascii=False)}'),
        (r'file = "[^"]*"', f'file = "{name}.csv"'),
        (r"rounds = \d+", f"rounds = {min(ROUNDS, len(questions))}"),
        (r"options = \[[^]]*\]", f"options = [{options}]"),
        (r"\{a\}, \{b\} or \{c\}", "{choices}"),
        (r"A \{a\}  B \{b\}  C \{c\}", "{lettered}"),
    ):
        base, times = re.subn(pattern, new.replace("\\", r"\\"), base, flags=re.MULTILINE)
        if not times:
            raise TangyError("The activity that questions are put into has changed.")
    return base
