"""The log of the game in sentences: bounded, the newest last, scrolled to the end."""

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
"""The mark before a sentence, so that its kind does not depend on colour alone."""


class LogView(Filtered, can_focus=True):
    """Sentences, each with a mark, wrapped to the width.

    Scrolls to the newest, unless it is meant to be read from the start (`follow=False`).
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
        self._notices = list[str]()
        self._follow = follow
        self._at_end = True

    @property
    def sentences(self) -> tuple[str, ...]:
        """The sentences in the log."""
        return tuple(text for text, _ in self._lines)

    def write(self, sentence: str, kind: Kind = "text") -> None:
        """Append a sentence; the view scrolls to it unless the user has scrolled back."""
        follow = self._at_end
        self._lines.append((clean(sentence), kind))
        self._show(follow)

    def notice(self, sentence: str, kind: Kind = "text") -> None:
        """Append a sentence that only matters until Tangy asks the next question."""
        self._notices.append(clean(sentence))
        self.write(sentence, kind)

    def clear_notices(self) -> None:
        """Remove the notices."""
        if self._notices:
            kept = [line for line in self._lines if line[0] not in self._notices]
            self._notices.clear()
            self._lines.clear()
            self._lines.extend(kept)
            self._show(self._at_end)

    def clear(self) -> None:
        """Empty the log."""
        self._notices.clear()
        self._lines.clear()
        self._show(True)

    def on_resize(self, event: events.Resize) -> None:
        """Wrap again; stay at the end if the end was shown."""
        self._show(self._at_end)

    def watch_scroll_y(self, old_value: float, new_value: float) -> None:
        """Remember whether the end (in rows) is shown: the present size is not known later."""
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
    """Wrap a sentence, with the mark before its first line."""
    return tuple(
        ((MARKS[kind] if n == 0 else "  ", kind), (line, kind))
        for n, line in enumerate(wrap(text, width - 2))
    )
