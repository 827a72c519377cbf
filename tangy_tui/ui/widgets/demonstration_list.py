"""The demonstrations as a table: teacher, date, steps, coverage, state and notes."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from rich.cells import cell_len
from textual.message import Message

from tangy_tui.learning.demonstration_rows import ListRow
from tangy_tui.text.demonstrations import LIST_HELP, NONE_TO_LIST
from tangy_tui.text.quality import quality_words
from tangy_tui.text.times import local_time
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.choice_list import ChoiceLine, ChoiceList
from tangy_tui.ui.widgets.rows import Row, fit, shorten

WIDEST_TEACHER = 12
BESIDE = 43
"""The width of all columns but teacher, state and notes."""

SHORTEST_NOTES = 12
"""The least width of the notes; if they do not fit, they are shown only below the table."""


class DemonstrationList(ChoiceList):
    """One line for each demonstration, by its id; marked ones have a star."""

    class Chosen(Message):
        """A demonstration was chosen with Enter."""

        def __init__(self, list: DemonstrationList) -> None:
            super().__init__()
            self.list = list

        @property
        def control(self) -> DemonstrationList:
            """The list that it was chosen in."""
            return self.list

    def __init__(self) -> None:
        super().__init__(
            "Demonstrations",
            LIST_HELP,
            id="demonstrations",
        )

    def fill(self, rows: Sequence[ListRow], marked: Collection[str]) -> None:
        """Show these demonstrations; the cursor stays on its demonstration."""
        kept, stars = tuple(rows), frozenset(marked)
        self.show(lambda width, height: demonstration_lines(kept, stars, width))

    def _tell(self, index: int) -> None:
        self.post_message(self.Chosen(self))


def demonstration_lines(
    rows: Sequence[ListRow], marked: Collection[str], width: int
) -> list[ChoiceLine]:
    """Format the table for a width in cells; without demonstrations, tell how to begin."""
    if not rows:
        return [ChoiceLine(((NONE_TO_LIST, "dim"),))]
    teacher = min(WIDEST_TEACHER, max(7, *(cell_len(clean(row.teacher)) for row in rows)))
    state = max(5, *(cell_len(clean(row.state)) for row in rows))
    notes = width - (teacher + state + BESIDE)
    notes = notes if notes >= SHORTEST_NOTES else 0
    head = f"   no  {fit('teacher', teacher)}  {'date':<16}  steps  seen   {fit('state', state)}"
    head += "  notes" if notes else ""
    lines = [ChoiceLine(((shorten(head, width), "dim"),))]
    for row in rows:
        lines.append(ChoiceLine(_row(row, row.id in marked, (teacher, state, notes)), row.id))
    return lines


def _row(row: ListRow, marked: bool, widths: tuple[int, int, int]) -> Row:
    teacher, state, notes = widths
    ink = "text" if row.in_use else "dim"
    seen, told = f"{row.seen}/{row.situations}", ", ".join(quality_words(row.notes))
    return (
        ("★ " if marked else "  ", "good"),
        (f"{row.number:>3}  ", "strong" if row.in_use else "dim"),
        (f"{fit(clean(row.teacher), teacher)}  {local_time(row.at)}  ", ink),
        (f"{row.steps:>5}  {seen:<5}  ", ink),
        (fit(clean(row.state), state), "good" if row.in_use else "warn"),
        (f"  {shorten(clean(told), notes)}" if notes else "", "text"),
    )
