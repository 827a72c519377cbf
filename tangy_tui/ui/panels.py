"""Panels: framed widgets, and from which width a screen shows them side by side."""

from __future__ import annotations

from typing import TypeVar

from textual.widget import Widget

WidgetT = TypeVar("WidgetT", bound=Widget)

WIDE = [(0, "-narrow"), (118, "-wide")]
"""Textual's horizontal breakpoints: the class a screen has from this many columns on."""


def panel(widget: WidgetT, title: str = "") -> WidgetT:
    """Give a widget the frame of a panel, and another title than its own."""
    widget.add_class("panel")
    if title:
        widget.border_title = title
    return widget
