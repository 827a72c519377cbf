"""A line in which staff type what they want done in a game."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Input, Static

from tangy_profiles.errors import TangyError
from tangy_tui.app.command_grammar import Perform
from tangy_tui.app.game_commands import GameCommand
from tangy_tui.text import typed_commands as text
from tangy_tui.ui.base import Dialog

LONGEST = 200  # characters


class CommandDialog(Dialog[GameCommand | Perform | None]):
    """Takes a command; what is none is said, and stays in the line."""

    DEFAULT_CSS = """
    CommandDialog Input { margin: 1 0 0 0; }
    CommandDialog .wrong { color: $warning; height: auto; display: none; }
    CommandDialog .wrong.-shown { display: block; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "leave", "Back", priority=True)]
    HELP = "Type what you want done, and press Enter. Esc goes back."

    def __init__(
        self, read: Callable[[str], GameCommand | Perform | None], begun: str, example: str
    ) -> None:
        """Make the dialog.

        Args:
            read: returns the command that words are.
            begun: stands in the line already.
            example: what can be typed.
        """
        super().__init__(None)
        self._read, self._begun, self._example = read, begun, example

    def compose(self) -> ComposeResult:
        """Lay out the line and what can be typed."""
        line = Input(self._begun, max_length=LONGEST, select_on_focus=False, id="typed")
        line.cursor_blink = False
        box = Vertical(
            Static(self._example, markup=False),
            line,
            Static("", classes="wrong", markup=False),
            id="type",
            classes="box",
        )
        box.border_title = Content(text.TITLE)
        box.border_subtitle = text.KEYS
        yield box

    def on_mount(self) -> None:
        """Let it be typed."""
        line = self.query_one(Input)
        line.focus()
        line.cursor_position = len(self._begun)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Take the command, if it is one."""
        event.stop()
        try:
            command = self._read(event.value)
            said = text.not_known(event.value)
        except TangyError as error:
            command, said = None, str(error)
        if command is not None:
            self.answer(command)
            return
        wrong = self.query_one(".wrong", Static)
        wrong.update(said)
        wrong.add_class("-shown")

    def on_key(self, event: events.Key) -> None:
        """Let letters be letters: none is a key here."""
        if event.is_printable:
            event.stop()

    def action_leave(self) -> None:
        """Go back."""
        self.answer(None)
