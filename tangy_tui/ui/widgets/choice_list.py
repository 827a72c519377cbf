"""A list panel with selectable lines and others that are only text."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from typing import NamedTuple

from textual.message import Message

from tangy_tui.text.phrases import NONE_FOUND
from tangy_tui.ui.widgets.choosable import Choosable
from tangy_tui.ui.widgets.rows import Row


class ChoiceLine(NamedTuple):
    """One line; `key` identifies its choice, None if it cannot be chosen.

    Adjacent lines with the same key form one choice.
    """

    row: Row
    key: Hashable | None = None


Lines = Callable[[int, int], Sequence[ChoiceLine]]
"""Formats the lines for a panel of some columns and lines."""


class ChoiceList(Choosable):
    """A list whose cursor is always on one of the choices, if there are any.

    The cursor keeps its key when the lines change. `Moved` reports every move.
    """

    class Moved(Message):
        """The cursor moved to another line."""

        def __init__(self, choices: ChoiceList) -> None:
            super().__init__()
            self.choices = choices

        @property
        def control(self) -> ChoiceList:
            """The list that it moved in."""
            return self.choices

    def __init__(self, title: str, help: str, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self.border_title = title
        self.HELP = help  # type: ignore[misc] # one for each list
        self._write: Lines = lambda width, height: ()
        self.shown_keys: list[Hashable] = []
        self._at: dict[Hashable, range] = {}

    @property
    def chosen(self) -> Hashable | None:
        """The key of the line at the cursor."""
        return None if self._cursor is None else self.shown_keys[self._cursor]

    def show(self, write: Lines, key: Hashable | None = None) -> None:
        """Replace the lines, with the cursor on a key (None: unchanged)."""
        self._write = write
        self._lay_out(self.chosen if key is None else key)

    def action_choose(self, by: int) -> None:
        """Move the cursor, and post `Moved`."""
        before = self._cursor
        super().action_choose(by)
        if self._cursor != before:
            self.post_message(self.Moved(self))

    def _lay_out(self, key: Hashable | None) -> None:
        lines = self._kept(self._write(max(1, self._rows.width), self._rows.height))
        self._at = {}
        for y, line in enumerate(lines):
            if line.key is not None:
                self._at[line.key] = range(self._at.get(line.key, range(y, y)).start, y + 1)
        self.shown_keys = list(self._at)
        if key in self.shown_keys:
            self._cursor = self.shown_keys.index(key)
        else:
            last = len(self.shown_keys) - 1
            self._cursor = None if last < 0 else min(self._cursor or 0, last)
        if self.is_attached and self._rows.width > 0:
            self._rows.put([line.row for line in lines])
            self._mark()

    def _kept(self, lines: Sequence[ChoiceLine]) -> Sequence[ChoiceLine]:
        """Return the lines that match the filter, with the headings above them."""
        if not self.filter:
            return lines
        texts: dict[Hashable, str] = {}
        for line in lines:
            if line.key is not None:
                text = "".join(piece for piece, _ in line.row)
                texts[line.key] = f"{texts.get(line.key, '')} {text}"
        kept, above, headed = list[ChoiceLine](), list[ChoiceLine](), False
        for line in lines:
            if line.key is None:
                above = [line] if headed else [*above, line]
                headed = False
            else:
                headed = True
                if self._has(texts[line.key]):
                    kept += [*above, line]
                    above = []
        return kept or [ChoiceLine(((NONE_FOUND, "dim"),))]

    def _filter_changed(self) -> None:
        before = self.chosen
        self._show()
        if self.chosen != before:
            self.post_message(self.Moved(self))

    def _show(self) -> None:
        self._lay_out(self.chosen)

    def _length(self) -> int:
        return len(self.shown_keys)

    def _places(self, index: int) -> range:
        return self._at[self.shown_keys[index]]

    def _tell(self, index: int) -> None:
        self.post_message(self.Moved(self))
