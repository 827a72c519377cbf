"""The coverage of the demonstrations: missing situations first, then the covered ones."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType

from tangy_tui.text.coach import ALL_SHOWN
from tangy_tui.text.numbers import often
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.rows import Row, RowView, shorten
from tangy_tui.ui.widgets.wrapping import wrap


class CoverageList(RowView, can_focus=True):
    """Lists the situations not demonstrated yet; below them, dimmed, the counts of the others.

    The title has the totals.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("k", "scroll_up", "Up", show=False),
        Binding("j", "scroll_down", "Down", show=False),
    ]
    HELP = (
        "Which situations Tangy has been shown. Above stands what nobody has shown yet: Tangy "
        "would not act there, but ask. Below, how often each of the others was shown."
    )

    def __init__(self, *, id: str | None = "coverage", classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self.border_title = "Seen"
        self._missing: tuple[str, ...] = ()
        self._seen: tuple[tuple[str, int], ...] = ()

    @property
    def missing(self) -> tuple[str, ...]:
        """The situations not demonstrated yet, in words."""
        return self._missing

    def show(
        self, missing: Sequence[str], seen: Sequence[tuple[str, int]], here: int | None = None
    ) -> None:
        """Show the missing situations, the counts of the others, and the number in this game."""
        new = tuple(missing), tuple(seen)
        count, of = len(seen), len(missing) + len(seen)
        game = "" if here is None else f", {here} in this game"
        self.border_title = f"{count} of {of} situations shown{game}"
        if new == (self._missing, self._seen):
            return
        self._missing, self._seen = new
        self._draw()

    def on_resize(self, event: events.Resize) -> None:
        """Wrap again."""
        self._draw()

    def _draw(self) -> None:
        width = self._rows.width
        if not self.is_attached or width <= 4:
            return
        rows: list[Row] = []
        if self._seen and not self._missing:
            rows += _sentence("✓ ", ALL_SHOWN, "good", width)
        for sentence in self._missing:
            rows += _sentence("! ", clean(sentence), "text", width)
        for words, times in self._seen:
            count = f", {often(times)}"
            rows.append(
                (
                    ("✓ ", "good"),
                    (shorten(clean(words), width - 2 - len(count)), "dim"),
                    (count, "dim"),
                )
            )
        self._rows.put(rows)


@lru_cache(256)
def _sentence(mark: str, text: str, ink: str, width: int) -> tuple[Row, ...]:
    """Wrap a sentence, with the mark before its first line."""
    return tuple(
        ((mark if n == 0 else "  ", "good" if ink == "good" else "warn"), (line, ink))
        for n, line in enumerate(wrap(text, width - 2))
    )
