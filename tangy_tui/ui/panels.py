"""Panels: framed widgets, and from which width a screen shows them side by side."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from textual.widget import Widget
from textual.widgets import Static

if TYPE_CHECKING:
    from tangy_tui.house import House
    from tangy_tui.ui.widgets.room_view import RoomView

WidgetT = TypeVar("WidgetT", bound=Widget)

WIDE = [(0, "-narrow"), (118, "-wide")]
"""Textual's horizontal breakpoints: the class a screen has from this many columns on."""

LOW = [(0, "-low"), (22, "-tall")]
"""The class a screen has below 22 lines, where every line counts."""


def key_line(*keys: tuple[str, str]) -> Static:
    """Make the last line of a screen: its keys, each with a word on what it does."""
    from textual.content import Content

    parts: list[str | tuple[str, str]] = []
    for key, word in keys:
        parts += [("  " if parts else "", ""), (key, "$primary bold"), (f" {word}", "$ink-dim")]
    line = Static(Content.assemble(*parts), id="keys")
    line.styles.height = 1
    line.styles.padding = (0, 1)
    return line


def panel(widget: WidgetT, title: str = "") -> WidgetT:
    """Give a widget the frame of a panel, and another title than its own."""
    widget.add_class("panel")
    if title:
        widget.border_title = title
    return widget


def room_panel(house: House) -> RoomView:
    """Make the panel of a house's room, with its people, its robot and its numbers."""
    from tangy_tui.ui.widgets.room_view import RoomView

    return panel(
        RoomView(
            house.room,
            house.people,
            robot=house.robot.title,
            label=house.activity.deck.label,
        )
    )
