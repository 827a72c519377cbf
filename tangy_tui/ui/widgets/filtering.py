"""Filtering of lists: `/` starts, words appear at the foot, Enter keeps them, esc shows all.

A list without letter keys (`LETTERS_FILTER`) is filtered by typing letters, and Enter stays a
key. The typed word stop still stops the robot.
"""

from __future__ import annotations

from typing import ClassVar

from textual import events

from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.typed_stop import WORD
from tangy_tui.ui.widgets.rows import RowView

LONGEST = 40
"""The longest filter in characters."""


class Filtered(RowView):
    """A list that shows only the lines that contain all filter words.

    Subclasses define how the list is redrawn (`_show`, using `_has`), and the foot of an unfiltered
    list (`_hint`).
    """

    LETTERS_FILTER: ClassVar[bool] = False

    filtering = False
    """Whether keys are taken as filter words only."""

    filter = ""
    """The filter words."""

    @property
    def filtered(self) -> bool:
        """Whether esc clears a filter."""
        return self.filtering or bool(self.filter)

    @property
    def writes(self) -> bool:
        """Whether the next letter belongs to a filter word, and cannot be part of a typed stop.

        If letters filter, "stop" stops, but "Christopher" does not.
        """
        word = self.filter.casefold().rpartition(" ")[2]
        return self.filtering or (self.LETTERS_FILTER and not WORD.startswith(word))

    def begin_filter(self) -> None:
        """Start to type filter words."""
        self.filtering = True
        self.screen.set_focus(self)  # at once: words may arrive with the key
        self._refilter()

    def unfilter(self) -> None:
        """Show all lines again."""
        self.filtering, self.filter = False, ""
        self._refilter()

    def on_key(self, event: events.Key) -> None:
        """Take letters as filter words while filtering; esc clears the filter."""
        if event.key == "escape" and self.filtered:
            self.filtering, self.filter = False, ""
        elif not self.filtering and not (self.LETTERS_FILTER and self._is_filter_key(event)):
            return
        elif event.key == "slash" and not self.filter:
            pass  # it starts the filter, as in every list
        elif event.key == "enter":
            self.filtering = False
        elif event.key == "backspace":
            self.filter = self.filter[:-1]
        elif event.is_printable and event.character and len(self.filter) < LONGEST:
            self.filter += event.character
        else:
            return
        event.stop()
        event.prevent_default()
        self._refilter()

    def _is_filter_key(self, event: events.Key) -> bool:
        """Return whether a key edits the filter: a letter, a digit, backspace or space."""
        typed = event.character or ""
        if self.filter and event.key in ("backspace", "space"):
            return True
        return event.is_printable and (typed.isalnum() or event.key == "slash")

    def on_paste(self, event: events.Paste) -> None:
        """Append pasted text to the filter."""
        if self.filtering or self.LETTERS_FILTER:
            event.stop()
            pasted = " ".join(event.text.split())
            self.filter = (self.filter + clean(pasted))[:LONGEST]
            self._refilter()

    def on_blur(self) -> None:
        """Stop taking words when the list loses the focus."""
        if self.filtering:
            self.filtering = False
            self._refilter()

    def _has(self, text: str) -> bool:
        """Return whether a line contains all filter words."""
        return not self.filter or all(w in text.lower() for w in self.filter.lower().split())

    def _refilter(self) -> None:
        self._filter_changed()
        self._say_filter()

    def _say_filter(self, count: str = "") -> None:
        """Show the filter and the number of matches at the foot."""
        typed = f"/{clean(self.filter)}{'_' if self.filtering else ''}" if self.filtered else ""
        foot = f"{typed}  {count}".strip() if typed else self._hint()
        self.border_subtitle = foot.replace("[", "\\[")

    def _hint(self) -> str:
        """Return the foot of the unfiltered list."""
        return ""

    def _filter_changed(self) -> None:
        """Redraw after a change of the filter."""
        raise NotImplementedError
