"""The input line for a command of staff in a game."""

from __future__ import annotations

from collections.abc import Callable

from tangy_profiles.errors import TangyError
from tangy_tui.app.command_grammar import Perform
from tangy_tui.app.game_commands import GameCommand
from tangy_tui.text import typed_commands as text
from tangy_tui.ui.dialogs.line import LineDialog


class CommandDialog(LineDialog[GameCommand | Perform]):
    """Parses a command; a line that is none stays, with an explanation."""

    HELP = "Type what you want done, and press Enter. Esc goes back."

    def __init__(
        self, read: Callable[[str], GameCommand | Perform | None], begun: str, example: str
    ) -> None:
        """Create the dialog.

        Args:
            read: parses a command.
            begun: the initial text of the line.
            example: examples of commands.
        """
        super().__init__(text.TITLE, example, text.KEYS, begun=begun)
        self._read = read

    def taken(self, line: str) -> GameCommand | Perform:
        """Parse a command; raises TangyError if the line is none."""
        command = self._read(line)
        if command is None:
            raise TangyError(text.not_known(line))
        return command
