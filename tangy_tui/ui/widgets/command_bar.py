"""The command bar: an input line for commands, below the commands that match."""

from __future__ import annotations

from collections.abc import Callable

from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical
from textual.message import Message
from textual.screen import Screen
from textual.timer import Timer
from textual.widgets import Input, Static

from tangy_tui.text.keys import EMPTIES
from tangy_tui.text.teaching_commands import NOTHING_FITS
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.command_input import LONGEST, CommandInput
from tangy_tui.ui.widgets.command_matches import CommandMatches, Complete, Sayable

CLOSED_SECONDS = 2.0
"""How long the bar stays closed after a command if the screen does not report the result."""

ANSWERED_SECONDS = 0.2
"""The same after a dialog has closed, since the answer may open the next question."""


class CommandBar(Vertical):
    """A line of matches above an input line: two lines high.

    Without the focus, its placeholder lists the available keys (`resting`).

    `Given` carries a command. From then on the bar is closed and discards keys, so that keys typed
    ahead neither answer a coming question nor end up in the next command. It opens when the screen
    reports the result: `ready()` (done, or refused elsewhere on the screen) or `restore(text)` (not
    understood, or answered with no). Otherwise it opens by itself: soon after a dialog above it has
    closed, or two seconds after a command that opened none.
    """

    DEFAULT_CSS = """
    CommandBar { height: 2; }
    CommandBar > Horizontal { height: 1; }
    CommandBar .prompt { width: 2; color: $accent; text-style: bold; }
    CommandBar Input.-textual-compact {
        width: 1fr; height: 1; padding: 0; border: none !important;
        background: $background; background-tint: $background 0%;
    }
    CommandBar Input.-textual-compact:focus { background-tint: $background 0%; }
    """

    class Given(Message):
        """A command was given. `text` is the typed text without surrounding spaces."""

        def __init__(self, bar: CommandBar, text: str) -> None:
            super().__init__()
            self.bar = bar
            self.text = text

        @property
        def control(self) -> CommandBar:
            """The bar that it was given in."""
            return self.bar

    def __init__(
        self,
        complete: Complete = lambda prefix: (),
        *,
        sayable: Sayable = lambda: (),
        placeholder: str = "type a command, or ? for help",
        resting: str = "",
        closed: bool = False,
        letters: bool = True,
        id: str | None = "command",
    ) -> None:
        """Create the bar.

        Args:
            complete: returns the commands that match the typed text.
            sayable: returns the commands that can be carried out now.
            placeholder: the placeholder of the focused line.
            resting: the placeholder without focus: the available keys.
            closed: discard keys until `ready`.
            letters: whether these keys include letters; others also work while typing.
            id: the widget's id.
        """
        super().__init__(id=id)
        self._complete = complete
        self._matches = CommandMatches()
        self._texts = (placeholder, resting or placeholder)
        self._input = CommandInput(complete, sayable, self._texts[1])
        self._input.closed = closed
        self._letters = letters
        self._prompt = Static("> ", classes="prompt", markup=False)
        self.reopening: Timer | None = None

    def compose(self) -> ComposeResult:
        """Lay out the matches above the input line."""
        yield self._matches
        with Horizontal():
            yield self._prompt
            yield self._input

    @property
    def text(self) -> str:
        """The text in the bar."""
        return self._input.value

    @property
    def closed(self) -> bool:
        """Whether it discards keys while a command is processed."""
        return self._input.closed

    def focus_input(self) -> None:
        """Focus the input line."""
        self._input.focus()

    @property
    def has_keys(self) -> bool:
        """Whether the input line has the focus."""
        return self._input.has_focus

    def type(self, character: str) -> None:
        """Insert a character typed elsewhere, and take the focus."""
        if not self._input.closed:
            self._input.replace(character, *self._input.selection)
            self.screen.set_focus(self._input)  # at once: Enter may come with it

    @property
    def typing(self) -> bool:
        """Whether the user is typing: it has the focus, and text."""
        return self._input.has_focus and bool(self._input.value)

    def restore(self, text: str) -> None:
        """Put a text back, selected: typing replaces it, an arrow key keeps it.

        Opens the bar, and focuses it.
        """
        self._input.give_back(clean(text)[:LONGEST])
        self.ready()
        self._input.focus()

    @property
    def lists(self) -> bool:
        """Whether it lists the commands that can be carried out now."""
        return bool(self._input.listed)

    def drop(self) -> None:
        """Empty the line and close the list, without changing the focus."""
        self._input.forget_list()
        self._input.put("")
        self._show_above()

    def ready(self) -> None:
        """Open the bar for the next command; a list of commands may no longer apply."""
        self._stop_waiting()
        if self.lists:
            self.drop()
        self._input.forget_list()
        if self._input.closed:
            self._input.closed = False
            self._prompt.update("> ")

    def on_descendant_focus(self) -> None:
        """Show the placeholder for typing."""
        self._input.placeholder = self._texts[0]
        self._show_above()

    def on_descendant_blur(self) -> None:
        """Show the available keys as the placeholder."""
        self._input.placeholder = self._texts[1]
        self._show_above()

    def on_input_changed(self, event: Input.Changed) -> None:
        """Show the matches."""
        event.stop()
        if not self._input.listed:
            self._input.forget_list()
        self._show_above()

    def on_command_input_listed(self, event: CommandInput.Listed) -> None:
        """Show the possible commands, or that nothing matches."""
        event.stop()
        self._matches.show("", event.commands, "" if event.commands else NOTHING_FITS)

    def on_command_input_emptied(self, event: CommandInput.Emptied) -> None:
        """Remove the list from above the line."""
        event.stop()
        self._show_above()

    def _show_above(self) -> None:
        """Show the matches; if text is left in a bar without focus, the keys."""
        typed = self._input.value
        if self._input.listed:
            self._matches.show(typed, self._input.listed)
        elif typed and self._letters and not self._input.has_focus:
            self._matches.show(typed, (), self._texts[1])
        else:
            matches = self._complete(typed) if typed.strip() else ()
            self._matches.show(typed, matches, self._esc(typed, matches))

    def _esc(self, typed: str, matches: tuple[str, ...]) -> str:
        """Tell what Esc does, where the keys in the line without the focus are the screen's foot.

        "": nothing, or the line above has the matches.
        """
        told = typed and not matches and self._letters and self._input.has_focus
        return f"esc {EMPTIES}" if told else ""

    def on_command_input_entered(self, event: CommandInput.Entered) -> None:
        """Post the command."""
        event.stop()
        self._prompt.update("· ")
        self.reopening = self.set_timer(CLOSED_SECONDS, self.ready)
        self.post_message(self.Given(self, event.text))

    def on_mount(self) -> None:
        """Watch for closing dialogs."""
        self.app.screen_change_signal.subscribe(self, self._screen_changed)

    def _screen_changed(self, screen: Screen[object]) -> None:
        """Stay closed below a dialog, and open soon after it closes."""
        self._stop_waiting()
        if screen is self.screen and self._input.closed:
            self.reopening = self.set_timer(ANSWERED_SECONDS, self.ready)

    def _stop_waiting(self) -> None:
        if self.reopening is not None:
            self.reopening.stop()
            self.reopening = None


class AnswerBar(CommandBar):
    """A command bar whose placeholder without focus changes with the game.

    On its empty line, Esc can do something else than leave it.
    """

    _leaves = ""

    def leave_by(self, leaves: Callable[[], object], words: str) -> None:
        """Let Esc do something on the empty line; `words` tell it after the key."""
        self._input.leaves, self._leaves = leaves, words

    def _esc(self, typed: str, matches: tuple[str, ...]) -> str:
        """Tell what Esc does; a single match that is typed already gives way."""
        if not (self._leaves and self._input.has_focus):
            return super()._esc(typed, matches)
        if not typed:
            return f"esc {self._leaves}"
        twice = f"esc {EMPTIES}   esc esc {self._leaves}"
        return twice if set(matches) <= {typed} else ""

    def rest(self, text: str) -> None:
        """Set the placeholder shown while the bar does not have the focus."""
        self._texts = (self._texts[0], text)
        if not self._input.has_focus:
            self.on_descendant_blur()
