"""Matches of the typed text: the suggestion after the cursor, and the line of commands above."""

from __future__ import annotations

from collections.abc import Callable

from rich.cells import cell_len
from textual.strip import Strip
from textual.suggester import Suggester

from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.inks import InkedWidget
from tangy_tui.ui.widgets.rows import Row, Span, draw, shorten

Sayable = Callable[[], tuple[str, ...]]
"""Returns the commands that can be carried out now, best first."""

Complete = Callable[[str], tuple[str, ...]]
"""Returns the commands that start with the typed text, or that it means, likeliest first."""


class CommandSuggester(Suggester):
    """Suggests the first match that continues the typed text."""

    def __init__(self, complete: Complete) -> None:
        super().__init__(use_cache=False, case_sensitive=True)
        self._complete = complete

    async def get_suggestion(self, value: str) -> str | None:
        """Return the line completed to the first command that continues it."""
        matches = self._complete(value) if value.strip() else ()
        return next((value + m[len(value) :] for m in matches if goes_on(value, m)), None)


def goes_on(value: str, match: str) -> bool:
    """Return whether a command continues the typed text."""
    return len(match) > len(value) and match.lower().startswith(value.lower())


class CommandMatches(InkedWidget):
    """One line with the commands that match the typed text, or with the available keys."""

    DEFAULT_CSS = """
    CommandMatches { height: 1; padding: 0 0 0 2; }
    """

    def __init__(self) -> None:
        super().__init__()
        self._matches: tuple[str, ...] = ()
        self._typed = ""
        self._keys = ""

    def show(self, typed: str, matches: tuple[str, ...], keys: str = "") -> None:
        """Show these matches, with the typed part highlighted; or the keys, if given."""
        if (typed, matches, keys) != (self._typed, self._matches, self._keys):
            self._typed = typed
            self._matches = matches
            self._keys = keys
            self.refresh()

    def render_line(self, y: int) -> Strip:
        """Draw the line."""
        return draw(self, self._row(self.size.width), self.size.width)

    def _row(self, width: int) -> Row:
        if self._keys:
            return ((shorten(self._keys, width), "dim"),)
        row: list[Span] = []
        used = 0
        for n, match in enumerate(self._matches):
            text = clean(match)
            left = len(self._matches) - n
            more = f"  +{left - 1}" if left > 1 else ""
            gap = "   " if row else ""
            if used + len(gap) + cell_len(text) + len(more) > width:
                row.append((f"  +{left}", "dim"))
                break
            head = len(self._typed) if goes_on(self._typed, text) else 0
            row += [(gap + text[:head], "strong"), (text[head:], "dim")]
            used += len(gap) + cell_len(text)
        return tuple(row)
