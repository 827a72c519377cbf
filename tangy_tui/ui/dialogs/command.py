"""A line in which staff type what they want done in a game."""

from __future__ import annotations

from collections.abc import Callable

from tangy_profiles.errors import TangyError
from tangy_tui.app.command_grammar import Perform
from tangy_tui.app.game_commands import GameCommand
from tangy_tui.text import typed_commands as text
from tangy_tui.ui.dialogs.line import LineDialog


class CommandDialog(LineDialog[GameCommand | Perform]):
    """Reads a command; a line that is none is explained, and stays."""

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
        super().__init__(text.TITLE, example, text.KEYS, begun=begun)
        self._read = read

    def taken(self, line: str) -> GameCommand | Perform:
        """Return the command that a line is, or raise TangyError where it is none."""
        command = self._read(line)
        if command is None:
            raise TangyError(text.not_known(line))
        return command
