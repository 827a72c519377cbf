"""Cards and their deck: geometry, labels, and how a card is judged.

Cells are bits of an integer, row by row (bit = row x columns + column), so a line is tested with
one `and`. Both worlds use `judge`: the simulated one with what people marked, the real one
with what the camera saw.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, reduce
from itertools import combinations
from operator import or_

from tangy_profiles.reading import Table

PATTERNS = (
    "row",
    "column",
    "diagonal",
    "four corners",
    "both diagonals",
    "border",
    "whole card",
)
CHECKERS = ("unread", "complete line", "wrong marks", "missing marks", "otherwise")


@dataclass(frozen=True)
class Column:
    """One column: its letter and the inclusive range of its numbers."""

    letter: str
    low: int
    high: int


@dataclass(frozen=True)
class Deck:
    """The numbers of a game and the shape of its cards."""

    columns: tuple[Column, ...]
    rows: int
    free_centre: bool
    patterns: tuple[str, ...]
    together: int = 1
    """How many different patterns a card must have to win."""

    @cached_property
    def numbers(self) -> tuple[int, ...]:
        """Every number that can be called, in order."""
        return tuple(n for c in self.columns for n in range(c.low, c.high + 1))

    @cached_property
    def free(self) -> int:
        """The bit of the free centre cell, or 0."""
        if not self.free_centre:
            return 0
        return 1 << (self.rows // 2 * len(self.columns) + len(self.columns) // 2)

    @cached_property
    def lines(self) -> tuple[int, ...]:
        """The winning lines as bit masks."""
        rows, width = self.rows, len(self.columns)
        cell = [[1 << (row * width + column) for column in range(width)] for row in range(rows)]
        lines: list[int] = []
        if "row" in self.patterns:
            lines += [sum(cell[row]) for row in range(rows)]
        if "column" in self.patterns:
            lines += [sum(cell[row][column] for row in range(rows)) for column in range(width)]
        if "diagonal" in self.patterns and rows == width:
            lines.append(sum(cell[i][i] for i in range(rows)))
            lines.append(sum(cell[i][width - 1 - i] for i in range(rows)))
        if "four corners" in self.patterns:
            lines.append(cell[0][0] | cell[0][-1] | cell[-1][0] | cell[-1][-1])
        if "both diagonals" in self.patterns and rows == width:
            lines.append(sum({cell[i][i] for i in range(rows)} | _falling(cell)))
        if "border" in self.patterns:
            rim = {*cell[0], *cell[-1], *(row[0] for row in cell), *(row[-1] for row in cell)}
            lines.append(sum(rim))
        if "whole card" in self.patterns:
            lines.append(sum(sum(row) for row in cell))
        if self.together > 1:
            several = combinations(dict.fromkeys(lines), self.together)
            lines = list(dict.fromkeys(reduce(or_, some) for some in several))
        return tuple(lines)

    @cached_property
    def lines_through(self) -> tuple[tuple[int, ...], ...]:
        """For each cell, the winning lines through it."""
        cells = range(self.rows * len(self.columns))
        return tuple(tuple(line for line in self.lines if line >> c & 1) for c in cells)

    @cached_property
    def _letters(self) -> dict[int, str]:
        return {n: c.letter for c in self.columns for n in range(c.low, c.high + 1)}

    def label(self, number: int) -> str:
        """Format a number as callers do: letter and number, "B-5"."""
        return f"{self._letters[number]}-{number}"

    def deal(self, uniform: Callable[[], float]) -> tuple[int, ...]:
        """Deal one card: distinct numbers for each column, listed row by row.

        Only `uniform` (a generator's `random`) is used, because it is the only draw that Python
        keeps the same in every version.
        """
        width = len(self.columns)
        card = [0] * (self.rows * width)
        for place, column in enumerate(self.columns):
            left = list(range(column.low, column.high + 1))
            for row in range(self.rows):
                pick = int(uniform() * len(left))
                card[row * width + place] = left[pick]
                left[pick] = left[-1]
                left.pop()
        return tuple(card)

    def shuffled(self, uniform: Callable[[], float]) -> list[int]:
        """Shuffle all numbers into a calling order (Fisher-Yates)."""
        order = list(self.numbers)
        for end in range(len(order) - 1, 0, -1):
            pick = int(uniform() * (end + 1))
            order[end], order[pick] = order[pick], order[end]
        return order

    def wins(self, cells: int) -> bool:
        """Return whether these cells hold a winning line."""
        return any(cells & line == line for line in self.lines)


def _falling(cell: Sequence[Sequence[int]]) -> set[int]:
    """Return the cells of the anti-diagonal."""
    return {cell[row][len(cell) - 1 - row] for row in range(len(cell))}


@dataclass(frozen=True)
class CardState:
    """A user activity state and the checker that recognises it on a card."""

    name: str
    label: str
    checker: str
    hint: str
    not_yet: str = ""
    now: str = ""
    """A sentence that says what a host might do now; {name} is the person."""


def winning_state(states: Sequence[CardState]) -> str:
    """Return the user activity state of a winning card; "" if there is none."""
    return next((state.name for state in states if state.checker == "complete line"), "")


def judge(states: Sequence[CardState], deck: Deck, marked: int, called: int) -> str:
    """Return the user activity state of a read card: the first state whose checker matches.

    Args:
        states: the activity's user states in order of precedence.
        deck: the deck of the card.
        marked: the marked cells, as a mask.
        called: the cells whose number has been called (and the free centre), as a mask.

    Raises:
        ValueError: every state has a condition; `read_user_states` rejects such an activity.
    """
    for state in states:
        match state.checker:
            case "complete line" if deck.wins(marked & called):
                return state.name
            case "wrong marks" if marked & ~called:
                return state.name
            case "missing marks" if called & ~marked:
                return state.name
            case "otherwise":
                return state.name
    raise ValueError("no state without a condition")  # rejected when the activity is read


def judge_partly(
    states: Sequence[CardState], deck: Deck, marked: int, unknown: int, called: int
) -> str:
    """Return the user activity state of a card with some unknown cells.

    It is the result of `judge` if that does not depend on the unknown cells, else the unread state.
    Arguments are as of `judge`; `unknown` is the mask of unknown cells.
    """
    least, most = marked & ~unknown, marked | unknown
    for state in states:
        match state.checker:
            case "complete line":
                sure, possible = deck.wins(least & called), deck.wins(most & called)
            case "wrong marks":
                sure, possible = bool(least & ~called), bool(most & ~called)
            case "missing marks":
                sure, possible = bool(called & ~most), bool(called & ~least)
            case checker:
                sure = possible = checker == "otherwise"
        if sure:
            return state.name
        if possible:
            break
    return next(state.name for state in states if state.checker == "unread")


def is_borne_out(checker: str, deck: Deck, marked: int, unmarked: int, called: int) -> bool:
    """Return whether cells read twice confirm a checker's judgement of a card.

    A win or a mistake must be seen more than once; other judgements need no second look.

    Args:
        checker: one of `CHECKERS`.
        deck: the deck of the card.
        marked: the cells that were seen marked more than once, as a mask.
        unmarked: those that were seen unmarked more than once.
        called: as of `judge`.
    """
    match checker:
        case "complete line":
            return deck.wins((marked | deck.free) & called)
        case "wrong marks":
            return bool(marked & ~called)
        case "missing marks":
            return bool(unmarked & called)
    return True


def read_deck(table: Table) -> Deck:
    """Read a deck and check that its cards can be filled.

    Raises:
        ProfileError: a key is wrong, or no card can be filled from the columns.
    """
    rows = table.whole("rows", 1, 9)
    columns: list[Column] = []
    for entry in table.tables("columns"):
        letter = entry.text("letter")
        low = entry.whole("from", 1, 999)
        high = entry.whole("to", low, 999)
        if high - low + 1 < rows:
            raise entry.wrong("to", f"leaves fewer numbers than the {rows} rows of a card.")
        if columns and low <= columns[-1].high:
            raise entry.wrong("from", f"overlaps the column before it (to {columns[-1].high}).")
        columns.append(Column(letter, low, high))
        entry.close()
    if not columns:
        raise table.wrong("columns", "must hold at least one column.")
    free = table.flag("free_centre", False)
    if free and (rows % 2 == 0 or len(columns) % 2 == 0):
        raise table.wrong("free_centre", "needs a card with a middle: odd rows and columns.")
    patterns = table.words("patterns", PATTERNS)
    if not patterns:
        raise table.wrong("patterns", f"must hold one or more of: {', '.join(PATTERNS)}.")
    if "diagonal" in patterns and rows != len(columns):
        raise table.wrong("patterns", "a diagonal needs a square card.")
    table.close()
    return Deck(tuple(columns), rows, free, patterns)
