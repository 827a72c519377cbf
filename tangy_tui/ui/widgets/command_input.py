"""The input line of the command bar: completion, history, and keys typed by reflex."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType
from textual.message import Message
from textual.reactive import reactive
from textual.widgets import Input

from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.type_ahead_guard import clock_of
from tangy_tui.ui.widgets.command_matches import CommandSuggester, Complete, Sayable

REFLEX_SECONDS = 1.0
"""The time in which a y or n after a returned command is meant for a question that never came."""

MOST_HISTORY = 200
LONGEST = 200


class CommandInput(Input):
    """The input line. While it is `closed` it discards keys."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("tab", "accept", "Complete the command"),
        Binding("up", "recall(-1)", "The command before"),
        Binding("down", "recall(1)", "The command after", show=False),
        Binding("escape", "leave", "Empty the line, then leave it"),
    ]
    HELP = (
        "Type what Tangy should do. On an empty line Tab lists what can be said now; pressed again "
        "it takes one after the other. Tab or the right arrow completes what you type, Enter gives "
        "it, and Tangy asks before it does anything. Esc empties the line, then leaves it."
    )

    closed = False
    """Whether a command is being processed; keys are discarded meanwhile."""

    empties: reactive[bool] = reactive(False, repaint=False)
    """Whether Esc empties the line or closes the list; otherwise it leaves the line."""

    class Entered(Message):
        """A command was entered."""

        def __init__(self, text: str) -> None:
            super().__init__()
            self.text = text

    class Listed(Message):
        """Tab was pressed: these commands match the line, or can be carried out now."""

        def __init__(self, commands: tuple[str, ...]) -> None:
            super().__init__()
            self.commands = commands

    class Emptied(Message):
        """Esc emptied the line."""

    def __init__(self, complete: Complete, sayable: Sayable, placeholder: str) -> None:
        super().__init__(
            placeholder=placeholder,
            suggester=CommandSuggester(complete),
            select_on_focus=False,
            max_length=LONGEST,
            compact=True,
            id="command-input",
        )
        self.cursor_blink = False
        self.history: list[str] = []
        self._at = 0
        self._draft = ""
        self._complete = complete
        self._sayable = sayable
        self._listed: tuple[str, ...] = ()
        self._taken = -1  # the index of the listed command in the line
        self._returned = False  # whether a command has been put back, and no key came since
        self._held = ""  # a y or n that was probably typed by reflex
        self._since = 0.0  # the time of either, in s
        self.leaves: Callable[[], object] | None = None
        """What Esc does on the empty line, instead of leaving it."""

    async def _on_key(self, event: events.Key) -> None:
        """Handle each key before the next one.

        Textual would send Enter and the arrows to the app and back while it already inserts the
        letters that follow; keys that arrive together would change order.
        """
        bindings = self._bindings.key_to_bindings.get(event.key, [])
        asks_for_help = event.key == "question_mark" and not self.value
        if self.closed or bindings or asks_for_help:
            event.stop()
            event.prevent_default()
        if self.closed or self._is_reflex(event):
            return
        if asks_for_help:
            await self.run_action("app.help")
        elif bindings:
            await self.run_action(bindings[0].action)
        else:
            await super()._on_key(event)

    def _is_reflex(self, event: events.Key) -> bool:
        """Hold a y or n back that follows a returned command; a letter soon after releases it."""
        held, self._held = self._held, ""
        soon = event.time - self._since <= REFLEX_SECONDS
        if held and soon and event.is_printable:
            self.replace(held, *self.selection)
        returned, self._returned = self._returned, False
        if not (returned and soon and event.key in ("y", "n", "Y", "N")):
            return False
        self._held, self._since = event.key, event.time
        event.stop()
        event.prevent_default()
        return True

    def watch_value(self) -> None:
        """Note whether Esc has something to empty."""
        self.empties = bool(self.value or self._listed)

    def give_back(self, text: str) -> None:
        """Put a command back, selected."""
        self.put(text)
        self.select_all()
        self._returned, self._held, self._since = True, "", clock_of(self.app)()

    def _on_paste(self, event: events.Paste) -> None:
        if not self.closed and event.text.strip():
            self.insert_text_at_cursor(clean(event.text.strip().splitlines()[0])[:LONGEST])
        event.prevent_default()
        event.stop()

    def remember(self, text: str) -> None:
        """Add a command to the history."""
        if not self.history or self.history[-1] != text:
            self.history.append(text)
            del self.history[:-MOST_HISTORY]
        self._at = len(self.history)

    def put(self, text: str) -> None:
        """Replace the text of the line, with the cursor at its end."""
        self.value = text
        self.cursor_position = len(text)

    async def action_submit(self) -> None:
        """Enter the command, and close at once."""
        text = self.value.strip()
        if text:
            self.closed = True
            self.forget_list()  # other commands apply afterwards
            self.remember(text)
            self.clear()
            self.post_message(self.Entered(text))

    def action_accept(self) -> None:
        """Accept the suggestion; repeated, go through the matching or possible commands.

        On an empty line without commands to list, focus the next widget.
        """
        if self.listed:
            self._taken = (self._taken + 1) % len(self._listed)
            self.put(self._listed[self._taken])
        elif self._suggestion:
            self.put(self._suggestion)
        elif self.value.strip():
            if fitting := self._complete(self.value):
                self._listed, self._taken = fitting, 0
                self.put(fitting[0])
            self.post_message(self.Listed(fitting))
        elif listed := self._sayable():
            self._listed, self._taken = listed, -1
            self.put("")  # a line of spaces counts as empty
            self.empties = True
            self.post_message(self.Listed(listed))
        else:
            self.screen.focus_next()

    @property
    def _standing(self) -> str:
        """The listed command that is in the line, "" if the user typed anything else."""
        return self._listed[self._taken] if self._taken >= 0 else ""

    @property
    def listed(self) -> tuple[str, ...]:
        """The listed commands, while the user chooses from them."""
        return self._listed if self.value == self._standing else ()

    def forget_list(self) -> None:
        """Clear the list: other text was typed, or other commands apply."""
        self._listed, self._taken = (), -1
        self.empties = bool(self.value)

    def action_recall(self, by: int) -> None:
        """Recall a command from the history; after the last one, the unfinished line."""
        if not self.history:
            return
        if self._at >= len(self.history):
            self._draft = self.value
            self._at = len(self.history)
        self._at = min(len(self.history), max(0, self._at + by))
        self.put(self._draft if self._at == len(self.history) else self.history[self._at])

    def action_leave(self) -> None:
        """Empty the line and close the list of commands; leave an empty line.

        What stood in the line can be recalled like a command.
        """
        if self.value or self.listed:
            if (typed := self.value.strip()) and not self.listed:
                self.remember(typed)
            self.forget_list()
            self.put("")
            self.post_message(self.Emptied())
        elif self.leaves is not None:
            self.leaves()
        else:
            self.screen.set_focus(None)
