"""The items of an activity: a CSV file beside it, with one row for each round."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from tangy_profiles.declared.judging import LETTERS, plain_words
from tangy_profiles.declared.model import Fact, Items
from tangy_profiles.declared.section import Section
from tangy_profiles.declared.source import SourceText
from tangy_profiles.errors import ProfileError
from tangy_profiles.given_file import read_given
from tangy_profiles.plain_text import plain

LARGEST_TABLE = 1_000_000  # bytes
MOST_ROWS = 5_000


def read_csv(source: SourceText, key: tuple[str, ...], path: Path) -> list[list[str]]:
    """Read a CSV file beside an activity's file, and record its mistakes.

    The text is UTF-8, with or without a byte order mark; blank lines are skipped.

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
        lines = content.decode("utf-8-sig").splitlines()
        rows = [[cell.strip() for cell in row] for row in csv.reader(lines, strict=True) if row]
    except (UnicodeDecodeError, csv.Error) as error:
        source.wrong(key, f"{plain(path.name)} cannot be read: {error}")
        return []
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
