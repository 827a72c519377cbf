"""The items of an activity: a CSV file beside it, with one row for each round."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from tangy_profiles.declared.judging import LETTERS, plain_words
from tangy_profiles.declared.model import Declaration, Fact, Items
from tangy_profiles.declared.section import Section
from tangy_profiles.declared.source import SourceText
from tangy_profiles.declared.table_text import table_rows
from tangy_profiles.declared.vocabulary import SLOT
from tangy_profiles.errors import ProfileError
from tangy_profiles.given_file import read_given
from tangy_profiles.plain_text import plain

LARGEST_TABLE = 1_000_000  # bytes
MOST_ROWS = 5_000


@dataclass(frozen=True, slots=True)
class EmptyCell:
    """An empty cell that leaves a behaviour without words: its row as in the file, from 1."""

    row: int
    column: str
    behaviour: str


def empty_cells(declaration: Declaration) -> Iterator[EmptyCell]:
    """Yield the empty cells without which a behaviour has no text to say."""
    items = declaration.items
    for behaviour in declaration.behaviours.values():
        for texts in behaviour.says.values():
            slots = [[one for one in SLOT.findall(t) if one in items.columns] for t in texts]
            for row in range(len(items.rows)):
                lacks = [[one for one in of_it if not items.value(row, one)] for of_it in slots]
                if lacks and all(lacks):
                    yield EmptyCell(row + 2, lacks[0][0], behaviour.name)


def read_csv(source: SourceText, key: tuple[str, ...], path: Path) -> list[list[str]]:
    """Read a CSV file beside an activity's file, and record its mistakes.

    It is read as spreadsheet programs save it (see `table_rows`); blank lines are skipped.

    Args:
        source: records the mistakes.
        key: the key of the activity's file that names it.
        path: the CSV file.

    Returns:
        The rows, the header first; empty if it cannot be read.
    """
    try:
        content = read_given(path, LARGEST_TABLE, ProfileError, called=plain(path.name))
    except ProfileError as error:
        source.wrong(key, str(error))
        return []
    try:
        rows, read_as = table_rows(content, plain(path.name))
    except ValueError as error:
        source.wrong(key, f"{plain(path.name)}: {error}")
        return []
    source.tables.append(read_as)
    rows = [row for row in rows if any(row)]
    if len(rows) < 2:
        source.wrong(key, f"{plain(path.name)} has no row under its header")
        return []
    if len(rows) > MOST_ROWS:
        source.wrong(key, f"{plain(path.name)} has more than {MOST_ROWS} rows")
        return []
    width = len(rows[0])
    if len(set(rows[0])) < width or not all(rows[0]):
        source.wrong(key, f"{plain(path.name)}: each column of its header must have its own name")
        return []
    for number, row in enumerate(rows, 1):
        if len(row) != width:
            problem = f"row {number} has {len(row)} cells in place of {width}"
            source.wrong(key, f"{plain(path.name)}: {problem}")
            return []
        for cell in row:
            if plain(cell) != cell:
                source.wrong(key, f"{plain(path.name)}: row {number} cannot be shown")
                return []
    return rows


def check_right_answers(top: Section, items: Items, facts: Iterable[Fact]) -> None:
    """Record the rows without a right answer to compare a free answer with."""
    for fact in facts:
        for number in range(len(items.rows) if fact.checks and not fact.options else 0):
            if not items.value(number, fact.checks):
                problem = f"{items.file}: row {number + 2}, column {fact.checks} is empty"
                why = f"{fact.name!r} compares answers with it"
                top.table("items").wrong("file", f"{problem}; {why}", items.file)


def with_right_options(top: Section, items: Items, facts: Iterable[Fact]) -> Items:
    """Return items in which each right answer is the text of an option.

    Authors may write its letter or column name instead. A right answer that is no option is a
    mistake: nobody could give it.
    """
    for fact in facts:
        if fact.checks and fact.options:
            rows = tuple(_right_in(top, items, fact, number) for number in range(len(items.rows)))
            items = replace(items, rows=rows)
    return items


def _right_in(top: Section, items: Items, fact: Fact, number: int) -> tuple[str, ...]:
    """Return a row with the right answer as the text of an option; record a mistake in it."""
    row = items.rows[number]
    options = [items.value(number, column) for column in fact.options]
    known = [plain_words(option) for option in options if option]
    right = items.value(number, fact.checks)
    ways = right.split("|")
    if {plain_words(way) for way in ways} & set(known):
        return row
    names = dict(zip(LETTERS, options, strict=False))
    names |= dict(zip(map(plain_words, fact.options), options, strict=True))
    chosen = [names.get(plain_words(way), "") for way in ways]
    if not any(chosen):
        problem = f"row {number + 2}: {fact.checks} {right!r} is none of its options"
        top.wrong("items", f"{problem}; write the words of one, or its letter", right)
        return row
    place = items.columns.index(fact.checks)
    told = "|".join(words or way for words, way in zip(chosen, ways, strict=True))
    return (*row[:place], told, *row[place + 1 :])
