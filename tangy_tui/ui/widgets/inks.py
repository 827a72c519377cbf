"""Inks: the styles that widgets draw their lines in, named after what they say (see `themes`)."""

from __future__ import annotations

from rich.style import Style
from textual.widget import Widget

SHAPES = ("curve",)
"""Inks of text that is a picture."""


class Inked(Widget):
    """A widget that draws in inks. They are components of the screen it is on.

    Textual works out the style of each component of each widget whenever a class changes: as
    components of the widgets, inks took a fifth of the time of all screens.
    """

    _inks: dict[tuple[str, str], Style] | None = None

    def ink(self, name: str, over: str = "") -> Style:
        """Return the style of an ink here, on a row that is marked `over` (cursor, now)."""
        if self._inks is None:
            self._inks = {}
        if (style := self._inks.get((name, over))) is None:
            style = self._inks[name, over] = self._mixed(name, over)
        return style

    def _mixed(self, name: str, over: str) -> Style:
        style = Style(bgcolor=self.rich_style.bgcolor)
        if name != "blank":  # a foreground would be written to the terminal for nothing
            style += self._component(name)
        if name in SHAPES and self.app.native_ansi_color:
            over = ""  # a picture is not to be reversed
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
        """Draw in the new colours."""
        super().notify_style_update()
        self._inks = None
