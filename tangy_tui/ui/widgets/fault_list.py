"""The faults of a game as a list, filtered by words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from rich.cells import cell_len
from textual.message import Message

from tangy_tui.monitoring.fault import OPEN, Fault
from tangy_tui.text.earlier import NONE_SINCE, WAS_OPEN
from tangy_tui.text.fault_views import LIST_HELP, NO_FAULTS, NONE_FOUND
from tangy_tui.text.faults import (
    Name,
    fault_time,
    last_words,
    mark_of,
    searched,
    short_state,
    state_words,
)
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.choice_list import ChoiceLine, ChoiceList
from tangy_tui.ui.widgets.rows import Row, fit, shorten

WIDEST_NAME = 32
TIME, STEP, STATE, SHORT_STATE = 7, 5, 16, 7
SHORTEST_NAME = 10
SHORTEST_LAST = 14
"""The least width of the last event; narrower lists drop other columns for it."""

HINT = "enter tells   / finds"


class FaultList(ChoiceList):
    """One line for each fault; `/` filters by words, esc shows all."""

    class Chosen(Message):
        """A fault was chosen with Enter."""

        def __init__(self, list: FaultList, id: str) -> None:
            super().__init__()
            self.list = list
            self.id = id

        @property
        def control(self) -> FaultList:
            """The list that it was chosen in."""
            return self.list

    def __init__(self, name: Name) -> None:
        super().__init__(
            "Faults",
            LIST_HELP,
            id="faults",
        )
        self._person_name = name
        self._faults: tuple[Fault, ...] = ()
        self._earlier: tuple[Fault, ...] = ()
        self._heading = ""

    def fill(
        self, faults: Sequence[Fault], earlier: Sequence[Fault] = (), heading: str = ""
    ) -> None:
        """Show these faults; below them, and a heading, those before an interruption."""
        if heading:
            self._faults, self._earlier = tuple(faults), tuple(earlier)
        else:
            self._faults, self._earlier = (*earlier, *faults), ()
        self._heading = heading
        self._write_all()

    def _filter_changed(self) -> None:
        self._write_all()

    def _kept(self, lines: Sequence[ChoiceLine]) -> Sequence[ChoiceLine]:
        return lines  # already filtered, also by text that is not shown

    def _hint(self) -> str:
        return HINT if self._faults or self._earlier else ""

    def _write_all(self) -> None:
        kept, before = self._found(self._faults), self._found(self._earlier)
        none = NONE_FOUND if self._faults else NO_FAULTS

        def lines(width: int, height: int) -> list[ChoiceLine]:
            if not before:
                return fault_list_lines(kept, width, NONE_FOUND if self._earlier else none)
            now = [] if self.filter and not kept else fault_list_lines(kept, width, NONE_SINCE)
            heading = ChoiceLine(((shorten(self._heading, width), "robot"),))
            return [*now, heading, *fault_list_lines(before, width, none, then=True)]

        self.show(lines)
        self._say_filter()

    def _found(self, faults: Sequence[Fault]) -> tuple[Fault, ...]:
        return tuple(f for f in faults if self._has(searched(f, self._person_name)))

    def _say_filter(self, count: str = "") -> None:
        words, faults = self.filter.split(), (*self._faults, *self._earlier)
        super()._say_filter(f"{len(self._found(faults))} of {len(faults)}" if words else "")

    def _tell(self, index: int) -> None:
        self.post_message(self.Chosen(self, str(self.shown_keys[index])))


class Columns(NamedTuple):
    """The widths of the columns of a list; a column of width 0 is left out."""

    time: int
    step: int
    name: int
    state: int
    last: int


def columns_for(width: int, name: int) -> Columns:
    """Divide the width: name and last event first, then the other columns.

    Args:
        width: the available width in cells.
        name: the width of the longest name in cells.
    """
    name = min(WIDEST_NAME, name)
    for time, step, state in (
        (TIME, STEP, STATE),
        (TIME, 0, STATE),
        (TIME, 0, SHORT_STATE),
        (0, 0, SHORT_STATE),
    ):
        last = width - 2 - time - step - 2 * bool(time) - name - 2 - state
        if last >= SHORTEST_LAST:
            return Columns(time, step, name, state, last)
    name = max(SHORTEST_NAME, min(name, width - TIME - SHORT_STATE - 6))
    return Columns(TIME, 0, name, SHORT_STATE, 0)


def fault_list_lines(
    faults: Sequence[Fault], width: int, none: str, *, then: bool = False
) -> list[ChoiceLine]:
    """Format the list for a width in cells; `then`: as it was before an interruption."""
    if not faults:
        return [ChoiceLine(((none, "dim"),))]
    columns = columns_for(width, max(cell_len(clean(fault.name)) for fault in faults))
    return [ChoiceLine(_row(fault, columns, then=then), fault.id) for fault in faults]


def _row(fault: Fault, columns: Columns, *, then: bool) -> Row:
    there = fault.status == OPEN and not then
    ink = "bad" if fault.critical and there else "warn" if there else "text"
    time = f"{fault_time(fault, fault.seconds, short=True):>6} " if columns.time else ""
    step = f"{fault.step:>4} " if columns.step else ""
    state = state_words(fault) if columns.state == STATE else short_state(fault)
    if then and fault.status == OPEN and columns.state == STATE:
        state = WAS_OPEN
    last = shorten(f"  {clean(last_words(fault))}", columns.last) if columns.last else ""
    return (
        (f"{mark_of(fault)} ", ink),
        (f"{time}{step} " if time else "", "dim"),
        (fit(clean(fault.name), columns.name), "strong" if there else "text"),
        (f"  {fit(state, columns.state)}", ink),
        (last, "dim"),
    )
