"""The commands that can be given now, the most frequent first."""

from __future__ import annotations

from collections.abc import Sequence

from textual.widgets import Static

from tangy_tui.text.coach import SAYABLE, sayable_now
from tangy_tui.ui.clean_output import clean


class SayableList(Static):
    """Lists the commands that can be given now."""

    DEFAULT_CSS = """
    SayableList { height: auto; }
    """

    def __init__(self, id: str | None = "sayable") -> None:
        super().__init__(id=id, markup=False)
        self.border_title = SAYABLE
        self._commands: tuple[str, ...] = ()

    def show(self, commands: Sequence[str]) -> None:
        """Show these commands."""
        new = tuple(commands)
        if new != self._commands:
            self._commands = new
            self.update(clean(sayable_now(new)))
