"""Filtering a list: `/` begins, words are typed at its foot, Enter keeps them, esc shows all.

In a list of which letters are no keys (`LETTERS_FILTER`) they filter at once; Enter is a key there,
and the typed word stop still stops the robot.
"""

from __future__ import annotations

from typing import ClassVar

from textual import events

from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.typed_stop import WORD
from tangy_tui.ui.widgets.rows import RowView

LONGEST = 40
"""Characters of a filter."""


class Filtered(RowView):
    """A list of which only the lines are shown in which all the typed words occur.

    A list says what it shows while it is filtered (`_show`, by `_has`), and what stands at its
    foot while it is not (`_hint`).
    """

    LETTERS_FILTER: ClassVar[bool] = False

    filtering = False
    """Whether words are being typed, and nothing else."""

    filter = ""
    """The words by which it is filtered."""

    @property
    def filtered(self) -> bool:
        """Whether esc has something to take back."""
        return self.filtering or bool(self.filter)

    @property
    def writes(self) -> bool:
        """Whether the next letter is one of a word, and cannot be one of a stop.

        Where letters filter, "stop" stops, but "Christopher" does not.
        """
        word = self.filter.casefold().rpartition(" ")[2]
        return self.filtering or (self.LETTERS_FILTER and not WORD.startswith(word))

    def begin_filter(self) -> None:
        """Begin to type words."""
        self.filtering = True
        self.screen.set_focus(self)  # at once: words may come with the key
        self._refilter()

    def unfilter(self) -> None:
        """Show all lines again."""
        self.filtering, self.filter = False, ""
        self._refilter()

    def on_key(self, event: events.Key) -> None:
        """While words are typed, letters are letters and no keys; esc takes the words back."""
        if event.key == "escape" and self.filtered:
            self.filtering, self.filter = False, ""
        elif not self.filtering and not (self.LETTERS_FILTER and self._filters(event)):
            return
        elif event.key == "slash" and not self.filter:
            pass  # it begins, as in every list
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

    def _filters(self, event: events.Key) -> bool:
        """Say whether a key filters by itself: a letter, a digit, or one within the words."""
        typed = event.character or ""
        if self.filter and event.key in ("backspace", "space"):
            return True
        return event.is_printable and (typed.isalnum() or event.key == "slash")

    def on_paste(self, event: events.Paste) -> None:
        """Take pasted words while words are typed."""
        if self.filtering or self.LETTERS_FILTER:
            event.stop()
            pasted = " ".join(event.text.split())
            self.filter = (self.filter + clean(pasted))[:LONGEST]
            self._refilter()

    def on_blur(self) -> None:
        """Type no further when the keys go elsewhere."""
        if self.filtering:
            self.filtering = False
            self._refilter()

    def _has(self, text: str) -> bool:
        """Say whether a line has all the words."""
        return not self.filter or all(w in text.lower() for w in self.filter.lower().split())

    def _refilter(self) -> None:
        self._filter_changed()
        self._say_filter()

    def _say_filter(self, count: str = "") -> None:
        """Say at the foot what is filtered by, and how many are left."""
        typed = f"/{clean(self.filter)}{'_' if self.filtering else ''}" if self.filtered else ""
        foot = f"{typed}  {count}".strip() if typed else self._hint()
        self.border_subtitle = foot.replace("[", "\\[")

    def _hint(self) -> str:
        """Return what stands at the foot of the whole list."""
        return ""

    def _filter_changed(self) -> None:
        """Show what is left."""
        raise NotImplementedError
