"""Inks: the text styles of the widgets, named after their meaning (see `themes`)."""

from __future__ import annotations

from rich.style import Style
from textual.widget import Widget

SHAPES = ("curve",)
"""Inks of text that forms a picture."""


class InkedWidget(Widget):
    """A widget that draws with inks, which are component classes of its screen.

    Textual recomputes the style of each component class of each widget whenever a class changes: as
    component classes of the widgets, inks took a fifth of the time of all screens.
    """

    _inks: dict[tuple[str, str], Style] | None = None

    def ink(self, name: str, over: str = "") -> Style:
        """Return the style of an ink, on a row that is marked `over` (cursor, now)."""
        if self._inks is None:
            self._inks = {}
        if (style := self._inks.get((name, over))) is None:
            style = self._inks[name, over] = self._mixed(name, over)
        return style

    def _mixed(self, name: str, over: str) -> Style:
        style = Style(bgcolor=self.rich_style.bgcolor)
        if name != "blank":  # a foreground would be sent to the terminal for nothing
            style += self._component(name)
        if name in SHAPES and self.app.native_ansi_color:
            over = ""  # do not reverse a picture
        if over:
            mark = self._component(over)
            style += Style(
                bgcolor=mark.bgcolor,
                bold=mark.bold,
                reverse=mark.reverse,
                underline=mark.underline,
            )
        return style

    def _component(self, name: str) -> Style:
        return self.screen.get_component_rich_style(f"ink--{name}", partial=True)

    def notify_style_update(self) -> None:
        """Redraw in the new colours."""
        super().notify_style_update()
        self._inks = None
