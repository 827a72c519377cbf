"""The lines of the page on which a game is set up: people, choices and checks, with a cursor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from textual.binding import Binding
from textual.message import Message

from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.choosable import Choosable
from tangy_tui.ui.widgets.rows import Row, fit, shorten

LABEL = 22
"""Columns of what a line is about."""

LineKind = Literal["head", "person", "choice", "check"]


@dataclass(frozen=True, slots=True)
class SetUpLine:
    """One line: its kind and id, what it is about, how it is, and in which ink that is."""

    kind: LineKind
    id: str
    label: str
    value: str
    ink: str = "text"


class SetUpList(Choosable):
    """Everything that is set up; Enter, left and right act on the line that the cursor is on."""

    ALLOW_MAXIMIZE = False
    BINDINGS = [  # noqa: RUF012 - as Textual has it
        Binding("left", "turn(-1)", "Less, or a seat to the left", show=False, id="left"),
        Binding("right", "turn(1)", "More, or a seat to the right", show=False, id="right"),
        Binding("space", "tell", "Change", show=False),
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

    def __init__(self) -> None:
        super().__init__(id="setup")
        self._lines: list[SetUpLine] = []
        self._cursor = 0

    def show(self, lines: Sequence[SetUpLine]) -> None:
        """Show lines; the cursor stays with what it was on."""
        on = self.chosen
        self._lines = list(lines)
        ids = [line.id for line in self.choices]
        if on is not None and on.id in ids:
            self._cursor = ids.index(on.id)
        if self.is_attached:
            self._show()

    @property
    def choices(self) -> list[SetUpLine]:
        """The lines that the cursor goes to."""
        return [line for line in self._lines if line.kind != "head"]

    @property
    def chosen(self) -> SetUpLine | None:
        """The line that the cursor is on."""
        lines = self.choices
        return lines[self._cursor] if self._cursor is not None and lines else None

    def action_turn(self, by: int) -> None:
        """Turn the line that the cursor is on."""
        if (line := self.chosen) is not None:
            self.post_message(self.Turned(line, by))

    def _length(self) -> int:
        return len(self.choices)

    def _places(self, index: int) -> range:
        place = self._lines.index(self.choices[index])
        return range(place, place + 1)

    def _show(self) -> None:
        self._rows.put([self._row(line) for line in self._lines])
        self._mark()

    def _tell(self, index: int) -> None:
        self.post_message(self.Entered(self.choices[index]))

    def _row(self, line: SetUpLine) -> Row:
        width = self._rows.width
        if line.kind == "head":
            return ((f"{line.label}", "strong"), (f"  {line.value}", "dim"))
        value = shorten(clean(line.value), max(0, width - LABEL - 3))
        return ((f"  {fit(clean(line.label), LABEL)} ", "text"), (value, line.ink))
