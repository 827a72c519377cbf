"""What happened, in sentences: the newest at the end, bounded, following the end."""

from __future__ import annotations

from collections import deque
from functools import lru_cache
from typing import ClassVar, Literal

from textual import events
from textual.binding import Binding, BindingType

from tangy_tui.text.phrases import NONE_FOUND
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.filtering import Filtered
from tangy_tui.ui.widgets.rows import Row
from tangy_tui.ui.widgets.wrapping import wrap

Kind = Literal["text", "dim", "good", "warn", "bad"]

MARKS: dict[str, str] = {"text": "  ", "dim": "  ", "good": "✓ ", "warn": "! ", "bad": "✗ "}
"""What stands before a sentence, so that no kind is told by colour alone."""


class LogView(Filtered, can_focus=True):
    """Sentences with a mark before them, wrapped to the width.

    It follows the newest, unless it is a list to be read from its beginning (`follow=False`).
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("k", "scroll_up", "Up", show=False),
        Binding("j", "scroll_down", "Down", show=False),
    ]
    HELP = "What happened and what Tangy said, the newest at the end. Up and down scroll."

    def __init__(
        self,
        *,
        most: int = 500,
        follow: bool = True,
        id: str | None = "log",
        classes: str | None = None,
    ) -> None:
        super().__init__(id=id, classes=classes)
        self.border_title = "Log"
        self._lines: deque[tuple[str, Kind]] = deque(maxlen=most)
        self._follow = follow
        self._at_end = True

    @property
    def sentences(self) -> tuple[str, ...]:
        """What stands in the log."""
        return tuple(text for text, _ in self._lines)

    def write(self, sentence: str, kind: Kind = "text") -> None:
        """Add a sentence; the view follows unless it was scrolled back."""
        follow = self._at_end
        self._lines.append((clean(sentence), kind))
        self._show(follow)

    def clear(self) -> None:
        """Empty the log."""
        self._lines.clear()
        self._show(True)

    def on_resize(self, event: events.Resize) -> None:
        """Wrap anew, at the end where the end was shown before."""
        self._show(self._at_end)

    def watch_scroll_y(self, old_value: float, new_value: float) -> None:
        """Take note whether the end (in rows) is shown: the size of now is not known later."""
        super().watch_scroll_y(old_value, new_value)
        self._at_end = self.is_vertical_scroll_end

    def _filter_changed(self) -> None:
        self._show(True)

    def _show(self, follow: bool) -> None:
        width = self._rows.width
        if not self.is_attached or width <= 4:
            return
        rows: list[Row] = []
        kept = [line for line in self._lines if self._has(line[0])]
        for text, kind in kept or ([(NONE_FOUND, "dim")] if self.filter else []):
            rows += _rows(text, kind, width)
        self._rows.put(rows)
        if follow and self._follow:
            self._rows.show(len(rows) - 1)


@lru_cache(1_024)
def _rows(text: str, kind: Kind, width: int) -> tuple[Row, ...]:
    """Write one sentence on as many lines as it needs, the mark before the first."""
    return tuple(
        ((MARKS[kind] if n == 0 else "  ", kind), (line, kind))
        for n, line in enumerate(wrap(text, width - 2))
    )
