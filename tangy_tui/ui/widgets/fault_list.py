"""The faults of a game as a list to choose in, filtered by words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from rich.cells import cell_len
from textual import events
from textual.binding import Binding, BindingType
from textual.message import Message

from tangy_tui.monitoring.fault import OPEN, Fault
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.fault_words import (
    Name,
    clock_words,
    last_words,
    mark_of,
    searched,
    state_words,
)
from tangy_tui.ui.widgets.choice_list import ChoiceList, Line
from tangy_tui.ui.widgets.rows import Row, fit, shorten

LONGEST = 40
"""Characters of a filter."""

WIDEST_NAME = 32
STATE = 16
SHORTEST_LAST = 12
"""Columns below which there is no telling what happened last."""


class FaultList(ChoiceList):
    """One line for each fault; `/` keeps those in which all the words occur, esc all of them."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("slash", "filter", "Keep those with these words", key_display="/"),
    ]

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
            "What went wrong in this game: when, after which step, whether it is critical (!!), "
            "what it is, and what was done about it. Enter opens one. / keeps those in which "
            "the words that you type occur: name, code, state or person; esc shows all again.",
            id="faults",
        )
        self._person_name = name
        self._faults: tuple[Fault, ...] = ()
        self._typing = False
        self.filter = ""
        """The words by which it is filtered at present."""

    @property
    def filtered(self) -> bool:
        """Whether esc has something to take back."""
        return self._typing or bool(self.filter)

    def fill(self, faults: Sequence[Fault]) -> None:
        """Show these faults."""
        self._faults = tuple(faults)
        self._write_all()

    def action_filter(self) -> None:
        """Begin to type words."""
        self._typing = True
        self._write_all()

    def unfilter(self) -> None:
        """Show all faults again."""
        self._typing, self.filter = False, ""
        self._write_all()

    def on_key(self, event: events.Key) -> None:
        """While words are typed, letters are letters and no keys."""
        if not self._typing:
            return
        if event.key == "enter":
            self._typing = False
        elif event.key == "escape":
            self._typing, self.filter = False, ""
        elif event.key == "backspace":
            self.filter = self.filter[:-1]
        elif event.is_printable and event.character and len(self.filter) < LONGEST:
            self.filter += event.character
        else:
            return
        event.stop()
        event.prevent_default()
        self._write_all()

    def on_blur(self) -> None:
        """Type no further when the keys go elsewhere."""
        if self._typing:
            self._typing = False
            self._write_all()

    def _write_all(self) -> None:
        words = self.filter.lower().split()
        kept = tuple(
            f for f in self._faults if all(w in searched(f, self._person_name) for w in words)
        )
        of = f"{len(kept)} of {len(self._faults)}" if words else ""
        typed = f"/{clean(self.filter)}{'_' if self._typing else ''}" if self.filtered else ""
        self.border_subtitle = f"{typed}  {of}".strip().replace("[", "\\[")
        none = "No fault has these words." if self._faults else "No faults in this game."
        self.show(lambda width, height: fault_list_lines(kept, width, none))

    def _tell(self, index: int) -> None:
        self.post_message(self.Chosen(self, str(self._keys[index])))


def fault_list_lines(faults: Sequence[Fault], width: int, none: str) -> list[Line]:
    """Write the list for so many columns."""
    if not faults:
        return [Line(((none, "dim"),))]
    name = min(WIDEST_NAME, max(cell_len(clean(fault.name)) for fault in faults))
    name = min(name, max(10, width - 16 - STATE - 2))
    return [Line(_row(fault, name, width), fault.id) for fault in faults]


def _row(fault: Fault, name: int, width: int) -> Row:
    last = width - name - 16 - STATE - 2
    there = fault.status == OPEN
    ink = "bad" if fault.critical and there else "warn" if there else "text"
    return (
        (f"{mark_of(fault)} ", ink),
        (f"{clock_words(fault.seconds):>6} {fault.step:>4}  ", "dim"),
        (fit(clean(fault.name), name), "strong" if there else "text"),
        (f"  {fit(state_words(fault), STATE)}", ink),
        (shorten(f"  {clean(last_words(fault))}", last) if last >= SHORTEST_LAST else "", "dim"),
    )
