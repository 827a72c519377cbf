"""Dialogs with one input line."""

from __future__ import annotations

from typing import ClassVar, Generic, TypeVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Input, Static

from tangy_profiles.errors import TangyError
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.type_ahead_guard import Clock, FreshKeys

LONGEST = 200  # characters of a line

ValueT = TypeVar("ValueT")


class FreshInput(Input):
    """An input line that ignores keys typed before its dialog was visible, if it has fresh keys."""

    fresh_keys: FreshKeys | None = None

    def on_key(self, event: events.Key) -> None:
        """Drop a key typed ahead."""
        self._drop_old(event)

    def on_paste(self, event: events.Paste) -> None:
        """Drop text pasted ahead."""
        self._drop_old(event)

    def _drop_old(self, event: events.Key | events.Paste) -> None:
        if self.fresh_keys is not None and not self.fresh_keys.counts(event):
            event.stop()
            event.prevent_default()


class LineDialog(Dialog[ValueT | None], Generic[ValueT]):
    """An input line: Enter submits it to `taken`, esc closes.

    A rejected line stays, with the reason below it.
    """

    DEFAULT_CSS = """
    LineDialog Input { margin: 1 0 0 0; }
    LineDialog .wrong { color: $warning; height: auto; display: none; }
    LineDialog .wrong.-shown { display: block; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "leave", "Back", priority=True)]

    def __init__(
        self,
        title: str,
        words: str,
        keys: str,
        *,
        begun: str = "",
        selected: bool = False,
        longest: int = LONGEST,
        unasked: bool = False,
        clock: Clock | None = None,
    ) -> None:
        """Create the dialog.

        Args:
            title: the question.
            words: the explanation above the line.
            keys: the keys and their actions.
            begun: the initial text of the line.
            selected: whether that text is selected, so that typing replaces it.
            longest: the most characters of a line.
            unasked: whether it opens by itself, so that it must ignore keys typed ahead.
            clock: returns s, on the scale of `time.monotonic` (default: the app's clock).
        """
        super().__init__(None)
        self._title, self._words, self._keys = title, words, keys
        self._begun, self._selected, self._longest = begun, selected, longest
        self._fresh_keys, self._clock = FreshKeys() if unasked else None, clock

    def taken(self, line: str) -> ValueT | None:
        """Return the value of a line; None closes the dialog.

        Raises:
            TangyError: the line is rejected.
        """
        raise NotImplementedError

    def compose(self) -> ComposeResult:
        """Lay out the explanation and the line."""
        line = FreshInput(self._begun, max_length=self._longest, select_on_focus=self._selected)
        line.cursor_blink = False
        line.fresh_keys = self._fresh_keys
        wrong = Static("", classes="wrong", markup=False)
        box = Vertical(Static(clean(self._words), markup=False), line, wrong, classes="box")
        box.border_title = Content(self._title)
        box.border_subtitle = self._keys
        yield box

    def on_mount(self) -> None:
        """Focus the line."""
        line = self.query_one(Input)
        line.focus()
        if self._fresh_keys is not None:
            self._fresh_keys.watch(self, self._clock)
        if not self._selected:
            line.cursor_position = len(self._begun)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Submit the line, and show why if it is rejected."""
        event.stop()
        try:
            self.answer(self.taken(event.value))
        except TangyError as error:
            wrong = self.query_one(".wrong", Static)
            wrong.update(str(error))
            wrong.add_class("-shown")
            self.rejected(event.input)

    def rejected(self, line: Input) -> None:
        """Prepare the line for a correction; it keeps its text and cursor by default."""

    def on_key(self, event: events.Key) -> None:
        """Send letters to the line: none is a shortcut here."""
        if event.is_printable:
            event.stop()

    def action_leave(self) -> None:
        """Close the dialog."""
        self.answer(None)
