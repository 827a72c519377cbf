"""Input lines for staff: a command, and what somebody answers or does.

They stand apart from other input lines: commands take long to load, and the first dialog has none.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import ClassVar

from textual.binding import Binding, BindingType
from textual.widgets import Input

from tangy_profiles.errors import TangyError
from tangy_tui.app.typed_line import Typed
from tangy_tui.text import typed_commands as text
from tangy_tui.text.telling import TELL, TELL_HELP, TELL_KEYS, telling_words
from tangy_tui.ui.dialogs.line import LineDialog
from tangy_tui.ui.messages import Stop


class CommandDialog(LineDialog[Typed]):
    """Parses a command; a line that is none stays, with an explanation and similar commands.

    It is selected then, so that the next letter replaces it; Tab replaces it by a similar command.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("tab", "similar", "Similar command", show=False, priority=True)
    ]
    HELP = (
        "Type what you want done, and press Enter. If Tangy does not know it, type something "
        "else, correct it with the arrows, or press Tab for a similar command. Esc goes back."
    )

    def __init__(
        self,
        read: Callable[[str], Typed | None],
        begun: str,
        title: str,
        words: str,
        similar: Callable[[str], Sequence[str]],
    ) -> None:
        """Create the dialog.

        Args:
            read: parses a command.
            begun: the initial text of the line.
            title: the question.
            words: its explanation, such as examples.
            similar: returns commands that are similar to words.
        """
        super().__init__(title, words, text.KEYS, begun=begun)
        self._read, self._similar = read, similar
        self._near: list[str] = []  # the similar commands, in the order of the next Tabs

    def taken(self, line: str) -> Typed:
        """Parse a command; raises TangyError if the line is none."""
        self._near = []
        command = self._read(line)
        if command is None:
            self._near = [*self._similar(line)]
            raise TangyError(text.not_known(line, self._near))
        return command

    def rejected(self, line: Input) -> None:
        """Select the line, so that the next letter replaces it."""
        line.action_select_all()

    def action_similar(self) -> None:
        """Replace the line by the next similar command."""
        if self._near:
            command = self._near.pop(0)
            self._near.append(command)
            line = self.query_one(Input)
            line.value = command
            line.cursor_position = len(command)


class NextDialog(LineDialog[str]):
    """An input line for what Tangy does next, while it still finishes its present step."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "leave", "Let Tangy go on by itself", priority=True)
    ]
    HELP = text.NEXT_WORDS

    def __init__(self, begun: str = "") -> None:
        """Create the dialog; `begun` are the words that wait already."""
        super().__init__(text.NEXT, text.NEXT_WORDS, text.NEXT_KEYS, begun=begun, selected=True)

    def on_stop(self, message: Stop) -> None:
        """Close the dialog when the robot is stopped; Tangy still asks afterwards."""
        self.answer("")

    @property
    def typed(self) -> str:
        """What has been typed so far."""
        return self.query_one(Input).value.strip() if self.query(Input) else ""

    def taken(self, line: str) -> str:
        """Return the line without spaces around it; raises TangyError if it is empty."""
        if not line.strip():
            raise TangyError(text.NEXT_EMPTY)
        return line.strip()


class TellDialog(LineDialog[str]):
    """An input line: Enter tells the report, esc closes. A report that is refused stays."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "leave", "Tell nothing", priority=True)
    ]
    HELP = TELL_HELP

    def __init__(self, tell: Callable[[str], None], waits_for: str, sayable: Sequence[str]) -> None:
        """Create the dialog.

        Args:
            tell: tells Tangy a report; raises TangyError if it is refused.
            waits_for: the name of the person the game waits for, "" for nobody.
            sayable: the words that have a meaning now.
        """
        super().__init__(TELL, telling_words(waits_for, sayable), TELL_KEYS)
        self._tell = tell

    def taken(self, line: str) -> str | None:
        """Tell the line; None if it is empty. Raises TangyError if it is refused."""
        if said := line.strip():
            self._tell(said)
        return said or None

    def rejected(self, line: Input) -> None:
        """Select the line, so that the next letter replaces it."""
        line.action_select_all()
