"""The learnt policy as a table (Table II): situation, behaviour, and share of votes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rich.cells import cell_len
from textual.message import Message

from tangy_tui.text.phrases import NONE_FOUND
from tangy_tui.text.policies import NOTHING_LEARNT
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.choosable import Choosable
from tangy_tui.ui.widgets.rows import Row, Span, fit

UNSURE = 0.7
"""A smaller share of votes is shown as a warning."""

VOTES = (10, 5, 0)
"""Widths of the bar of votes, of which the widest that fits is used."""

EIGHTHS = " ▏▎▍▌▋▊▉█"


@dataclass(frozen=True, slots=True)
class PolicyRow:
    """One situation: its behaviour, share of votes (0 to 1), and number of demonstrations.

    `note` is a remark such as "never shown", written as a warning.
    """

    situation: str
    behaviour: str
    share: float
    seen: int
    note: str = ""


def bar(share: float, width: int) -> str:
    """Draw a share of 0 to 1 as a bar."""
    eighths = round(min(1.0, max(0.0, share)) * width * 8)
    full, rest = divmod(eighths, 8)
    return ("█" * full + (EIGHTHS[rest] if rest else "")).ljust(width)


class PolicyTable(Choosable):
    """Rows of situation and behaviour; up and down move the cursor, Enter chooses.

    `highlight` marks the row of the present situation. If the width does not suffice, the behaviour
    is on a second line below its situation.
    """

    HELP = (
        "What Tangy has learnt: in which situation it does what, how sure it is of that, "
        "and how often the situation was shown to it."
    )

    class Chosen(Message):
        """A row was chosen with Enter."""

        def __init__(self, table: PolicyTable, index: int, row: PolicyRow) -> None:
            super().__init__()
            self.table = table
            self.index = index
            self.row = row

        @property
        def control(self) -> PolicyTable:
            """The table that it was chosen in."""
            return self.table

    def __init__(
        self,
        *,
        empty: str = NOTHING_LEARNT,
        id: str | None = "policy",
        classes: str | None = None,
    ) -> None:
        super().__init__(id=id, classes=classes)
        self.border_title = "Policy"
        self._table: tuple[PolicyRow, ...] = ()
        self._empty = clean(empty)
        self.marked: int | None = None
        self._stacked = False
        self._seen: list[int] = []  # the indices of the rows that are shown

    @property
    def rows(self) -> tuple[PolicyRow, ...]:
        """All rows."""
        return self._table

    @property
    def chosen(self) -> int | None:
        """The index of the row at the cursor."""
        if self._cursor is None or self._cursor >= len(self._seen):
            return None
        return self._seen[self._cursor]

    def show(self, rows: Sequence[PolicyRow], highlight: str | None = None) -> None:
        """Replace the rows; `highlight` names the present situation."""
        self._table = tuple(rows)
        self._cursor = None
        self.marked = self._index(highlight)
        self._show()

    def highlight(self, situation: str | None) -> None:
        """Mark the row of the present situation; None marks none."""
        self.marked = self._index(situation)
        self._mark()

    def _length(self) -> int:
        return len(self._seen)

    def _tell(self, index: int) -> None:
        row = self._seen[index]
        self.post_message(self.Chosen(self, row, self._table[row]))

    def _filter_changed(self) -> None:
        self._cursor = None
        self._show()

    def _index(self, situation: str | None) -> int | None:
        return next((n for n, r in enumerate(self._table) if r.situation == situation), None)

    def _show(self) -> None:
        self._seen = [
            n
            for n, r in enumerate(self._table)
            if self._has(f"{r.situation} {r.behaviour} {r.note}")
        ]
        if not self.is_attached or self._rows.width <= 0:
            return
        if self._table and not self._seen:
            self._rows.put([((NONE_FOUND, "dim"),)])
        elif self._table:
            self._rows.put(self._lines(self._rows.width))
        else:
            self._rows.put([((self._empty, "dim"),)])
        self._mark()

    def _lines(self, width: int) -> list[Row]:
        table = [
            PolicyRow(clean(r.situation), clean(r.behaviour), r.share, r.seen, clean(r.note))
            for r in (self._table[n] for n in self._seen)
        ]
        situation = max(cell_len(r.situation) for r in table)
        behaviour = max(cell_len(r.behaviour) for r in table)
        note = max(cell_len(r.note) for r in table)
        votes = next((v for v in VOTES if situation + behaviour + v + 12 <= width), None)
        self._stacked = votes is None
        if votes is None:
            behaviour = min(behaviour, max(6, width - 13))
            votes = 5 if behaviour + 18 <= width else 0
            note = _worth(min(note, width - 15 - behaviour - votes))
            return [
                line
                for r in table
                for line in (
                    ((fit(r.situation, width), "text"),),
                    ((" > ", "dim"), *_decision(r, behaviour, votes, note)),
                )
            ]
        note = _worth(min(note, width - situation - behaviour - votes - 14))
        return [
            (
                (fit("situation", situation), "dim"),
                (fit("  behaviour", behaviour + 2), "dim"),
                (f" {'sure':<{votes + 4}}", "dim"),
                (" seen", "dim"),
            ),
            *(
                (
                    (fit(r.situation, situation), "text"),
                    ("  ", "text"),
                    *_decision(r, behaviour, votes, note),
                )
                for r in table
            ),
        ]

    def _mark(self) -> None:
        marks: dict[int, str] = {}
        now = self._seen.index(self.marked) if self.marked in self._seen else None
        for index, ink in ((self._cursor, "cursor"), (now, "now")):
            if index is not None:
                marks.update(dict.fromkeys(self._places(index), ink))
        self._rows.mark(marks)
        seen = self._cursor if self._cursor is not None else now
        if seen is not None:
            self._reveal(seen)

    def _places(self, index: int) -> range:
        """Return the lines of a row of the table."""
        if self._stacked:
            return range(2 * index, 2 * index + 2)
        return range(index + 1, index + 2)


def _worth(columns: int) -> int:
    """Return the width of a note, 0 if it would be too narrow to read; a mark then replaces it."""
    return columns if columns >= 8 else 0


def _decision(row: PolicyRow, behaviour: int, votes: int, note: int) -> tuple[Span, ...]:
    """Format behaviour, votes, number of demonstrations, and note."""
    sure = row.share >= UNSURE and row.seen > 0
    share = "1.0" if row.share >= 0.995 else f"{row.share:.2f}"[1:]
    spans: list[Span] = [
        (fit(row.behaviour, behaviour), "strong"),
        (" ", "text"),
        (bar(row.share, votes), "curve" if sure else "warn"),
        (f" {share:>3}", "text" if sure else "warn"),
        (f"{row.seen:>5}", "text" if row.seen else "warn"),
    ]
    if note:
        spans += [("  ", "text"), (fit(row.note, note), "warn")]
    elif row.note:
        spans.append((" !", "warn"))
    return tuple(spans)
