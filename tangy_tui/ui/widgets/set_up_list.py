"""The lines of the set-up screen: people at tables, choices and checks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from textual.binding import Binding
from textual.message import Message

from tangy_tui.text.set_up import TYPES_NAME
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.choosable import Choosable
from tangy_tui.ui.widgets.rows import Row, Span, fit, shorten

LABEL = 22
"""The width of a line's label in cells."""
STATE = 6
"""The width of a person's presence at one of several tables, in cells."""

TURNS = "  ← →"
"""Shown at the cursor if left and right change a choice."""
KEYED = ("activity", "room", "patterns", "duty")
"""Choices that left and right do not change."""
TYPED = "duty"
"""The choice whose value is typed."""

LineKind = Literal["head", "person", "choice", "check"]


@dataclass(frozen=True, slots=True)
class SetUpLine:
    """One line: its kind and id, its label, its value, and the ink of the value.

    In a room of several tables, people have a `seat`: table and place, both from 0. They are shown
    side by side, table by table.
    """

    kind: LineKind
    id: str
    label: str
    value: str
    ink: str = "text"
    seat: tuple[int, int] | None = None


class SetUpList(Choosable):
    """The lines of the set-up; Enter, left and right act on the line at the cursor.

    Space picks a person up; the arrows then carry them to other seats until they are put down,
    or back.
    """

    ALLOW_MAXIMIZE = False
    BINDINGS = [  # noqa: RUF012 - as in Textual
        Binding("left", "turn(-1)", "Less, or the table to the left", show=False, id="left"),
        Binding("right", "turn(1)", "More, or the table to the right", show=False, id="right"),
        Binding("space", "carry", "Take a person to another seat", show=False, id="still"),
    ]

    class Entered(Message):
        """Enter was pressed on a line."""

        def __init__(self, line: SetUpLine) -> None:
            self.line = line
            super().__init__()

    class Turned(Message):
        """Left (-1) or right (1) was pressed on a line."""

        def __init__(self, line: SetUpLine, by: int) -> None:
            self.line, self.by = line, by
            super().__init__()

    class Carried(Message):
        """A person who is picked up was carried to another's seat."""

        def __init__(self, line: SetUpLine, to: SetUpLine) -> None:
            self.line, self.to = line, to
            super().__init__()

    class Held(Message):
        """A person was picked up (their id), or put down ("")."""

        def __init__(self, person: str) -> None:
            self.person = person
            super().__init__()

    def __init__(self) -> None:
        super().__init__(id="setup")
        self._lines: list[SetUpLine] = []
        self._cursor = 0
        self._carries = False

    def show(self, lines: Sequence[SetUpLine]) -> None:
        """Replace the lines; the cursor stays on its line."""
        on = self.chosen
        self._lines = list(lines)
        ids = [line.id for line in self.choices]
        if on is not None and on.id in ids:
            self._cursor = ids.index(on.id)
        if self.is_attached:
            self._show()

    @property
    def choices(self) -> list[SetUpLine]:
        """The lines that the cursor can be on."""
        return [line for line in self._lines if line.kind != "head"]

    @property
    def chosen(self) -> SetUpLine | None:
        """The line at the cursor."""
        lines = self.choices
        return lines[self._cursor] if self._cursor is not None and lines else None

    def action_choose(self, by: int) -> None:
        """Move the cursor, or the person who is picked up."""
        if not self._carries:
            super().action_choose(by)
        elif 0 <= (to := (self._cursor or 0) + by) < len(self.choices):
            self._carry_to(self.choices[to])

    def action_turn(self, by: int) -> None:
        """Turn the line at the cursor; from a person, go to the next table."""
        line = self.chosen
        if line is None or (line.kind == "person" and line.seat is None):
            return
        if line.kind != "person":
            self.post_message(self.Turned(line, by))
        elif (to := self._beside(line, by)) is not None and self._carries:
            self._carry_to(to)
        elif to is not None:
            self._cursor = self.choices.index(to)
            self._mark()

    def action_carry(self) -> None:
        """Pick a person up, or put them down; on any other line, act like Enter."""
        if self.chosen is not None and self.chosen.kind == "person":
            self._carries = not self._carries
            self._mark()
            self.post_message(self.Held(self.chosen.id if self._carries else ""))
        else:
            self.action_tell()

    def put_down(self) -> bool:
        """Put down the person who is picked up; False: nobody is."""
        held = self._carries
        if held:
            self.action_carry()
        return held

    def action_tell(self) -> None:
        """Choose the line at the cursor, or put down the person who is picked up."""
        if not self.put_down():
            super().action_tell()

    def _carry_to(self, to: SetUpLine) -> None:
        if self.chosen is not None and to.kind == "person":
            self.post_message(self.Carried(self.chosen, to))

    def _beside(self, line: SetUpLine, by: int) -> SetUpLine | None:
        """Return the person at the next table, at the same place or at the last one."""
        assert line.seat is not None  # noqa: S101 - only called at several tables
        table, place = line.seat[0] + by, line.seat[1]
        there = [one for one in self.choices if one.seat is not None and one.seat[0] == table]
        return there[min(place, len(there) - 1)] if there else None

    def _length(self) -> int:
        return len(self.choices)

    def _places(self, index: int) -> range:
        line = self.choices[index]
        place = next(at for at, row in enumerate(self._laid_out()) if line in row)
        return range(place, place + 1)

    def _show(self) -> None:
        self._mark()

    def _mark(self) -> None:
        """Draw all lines; a person at one of several tables is marked, not the whole line."""
        rows, chosen = self._laid_out(), self.chosen
        marks: dict[int, str] = {}
        if chosen is not None and chosen.seat is None and self._cursor is not None:
            over = "now" if self._carries else "cursor"
            marks = dict.fromkeys(self._places(self._cursor), over)
        self._rows.put([self._row(row) for row in rows], marks)
        if self._cursor is not None and chosen is not None:
            self._reveal(self._cursor)

    def _tell(self, index: int) -> None:
        self.post_message(self.Entered(self.choices[index]))

    def _laid_out(self) -> list[list[SetUpLine]]:
        """Return the items on each line of the screen: people side by side, table by table."""
        rows: list[list[SetUpLine]] = []
        first = 0
        for line in self._lines:
            if line.seat is None:
                rows.append([line])
                continue
            table, place = line.seat
            first = len(rows) if not table and not place else first
            while len(rows) <= first + place:
                rows.append([])
            rows[first + place].append(line)
        return rows

    def _row(self, lines: Sequence[SetUpLine]) -> Row:
        width, line = self._rows.width, lines[0]
        if line.kind == "head":
            return ((f"{line.label}", "strong"), (f"  {line.value}", "dim"))
        if line.seat is not None:
            tables = 1 + max(one.seat[0] for one in self.choices if one.seat is not None)
            return tuple(span for one in lines for span in self._sitting(one, width // tables))
        there = line == self.chosen
        turns = TURNS if there and line.kind == "choice" and line.id not in KEYED else ""
        if there and line.id == TYPED:
            turns = f"  {TYPES_NAME}"
        value = shorten(clean(line.value), max(0, width - LABEL - 3 - len(turns)))
        mark = "▸ " if there else "  "  # not everybody sees colour
        label = fit(clean(line.label), LABEL)
        return ((f"{mark}{label} ", "text"), (value, line.ink), (turns, "dim"))

    def _sitting(self, line: SetUpLine, width: int) -> tuple[Span, ...]:
        """Format a person at a table."""
        there = line == self.chosen
        over = ("now" if self._carries else "cursor") if there else ""
        mark = "▸" if there else " "
        name = fit(clean(line.label), max(4, width - STATE - 2))
        return (
            (f"{mark}{name} ", over or "text"),
            (fit(clean(line.value), STATE), over or line.ink),
        )
