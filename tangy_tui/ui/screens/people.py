"""The people screen: what is believed about which persuasive strategy works with whom."""

from __future__ import annotations

from random import Random
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import Static

from tangy_tui.house import House
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.panels import key_line, panel
from tangy_tui.ui.widgets.posteriors import Posteriors
from tangy_tui.ui.widgets.status_line import Status, StatusLine


class PeopleScreen(TangyScreen[None]):
    """Everybody's posteriors."""

    CSS_PATH = "people.tcss"
    HELP = (
        "For each person and way of speaking: how often they complied of how often it was "
        "tried, the curve of what Tangy believes, and the probability that it is the best. "
        "Names are given on the command line: tangy people rename."
    )
    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape,enter", "leave", "Back")]

    def __init__(self, house: House, leave_after: float | None = None) -> None:
        """Make the screen; `leave_after` so many seconds it closes by itself."""
        super().__init__()
        self._house = house
        self._leave_after = leave_after

    def compose(self) -> ComposeResult:
        """Lay out the posteriors."""
        yield StatusLine(Status(mode="people"))
        yield Static(
            "How often each way of speaking has worked (complied / tried):",
            id="summary",
            markup=False,
        )
        yield panel(Posteriors())
        yield key_line(("up down", "scroll"), ("esc", "back"), ("?", "help"))

    def on_mount(self) -> None:
        """Fill them from the log."""
        posteriors = self.query_one(Posteriors)
        posteriors.show(self._house.persuasion(Random(0)).beliefs, self._house.names, None)
        posteriors.focus()
        if self._leave_after is not None:
            self.set_timer(self._leave_after, self.action_leave)

    def action_leave(self) -> None:
        """Go back."""
        self.dismiss(None)
