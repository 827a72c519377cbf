"""Panels: framed widgets, and the widths from which a screen shows them side by side."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from textual import events
from textual.widget import Widget
from textual.widgets import Static

from tangy_tui.text.keys import EMPTIES
from tangy_tui.ui.keys import Key, foot

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.ui.widgets.room_view import RoomView

WidgetT = TypeVar("WidgetT", bound=Widget)

WIDE = [(0, "-narrow"), (118, "-wide")]
"""Textual's horizontal breakpoints: the class of a screen from this many columns on."""

LOW = [(0, "-low"), (22, "-tall")]
"""The class of a screen below 22 lines, where every line counts."""


ALWAYS_SHOWN = 2
"""The keys at the end of a key line that always stay: esc and ?."""

TOGETHER = {"slower": "faster"}
"""Keys that a key line shows only with the key after them."""

BACK = "back"
HOME = f"{BACK}:home"
"""The key that leaves a screen with an input line; in the line it has to be pressed twice."""


class KeyLine(Static):
    """The keys of a screen on one line; if space is short, those before esc and ? are left out."""

    DEFAULT_CSS = """
    KeyLine { height: 1; padding: 0 1; }
    """

    def __init__(self, *keys: str | Key, typing: bool = False) -> None:
        super().__init__(id="keys")
        self._keys = keys
        self._typing = typing
        self._in_line = False
        self._empties = False  # Esc empties the line

    def on_mount(self) -> None:
        """Follow the focus: in an input line Esc empties the line first, and then leaves it."""
        self.watch(self.screen, "focused", self._follow_focus)

    def _follow_focus(self, focused: Widget | None) -> None:
        from textual.widgets import Input

        in_line = isinstance(focused, Input)
        if in_line is not self._in_line:
            self._in_line = in_line
            self._write()
        if focused is not None and hasattr(focused, "empties"):
            self.watch(focused, "empties", self._follow_line)
        self._follow_line()

    def _follow_line(self) -> None:
        empties = bool(getattr(self.screen.focused, "empties", False))
        if empties is not self._empties:
            self._empties = empties
            self._write()

    def show(self, *keys: str | Key, typing: bool = False) -> None:
        """Replace the keys: actions of the keymap, or pairs of a key and a word.

        `typing`: an input line takes letters, so other keys are shown if there are any.
        """
        if (keys, typing) != (self._keys, self._typing):
            self._keys, self._typing = keys, typing
            self._write()

    def on_resize(self, event: events.Resize) -> None:
        """Show as many as fit."""
        self._write()

    def _write(self) -> None:
        from textual.content import Content

        keys = foot(self.app, *self._keys, typing=self._typing)
        back = next((n for n, one in enumerate(self._keys) if str(one).startswith(BACK)), None)
        if self._empties:
            empty = (foot(self.app, BACK)[0][0], EMPTIES)
            if back is None:
                keys.insert(max(0, len(keys) - ALWAYS_SHOWN + 1), empty)
            else:
                keys[back] = empty
        elif self._in_line and HOME in self._keys and back is not None:
            key, word = keys[back]
            keys[back] = (f"{key} {key}", word)
        first, last = keys[:-ALWAYS_SHOWN], keys[-ALWAYS_SHOWN:]
        width = self.size.width
        while first and sum(len(key) + len(word) + 3 for key, word in (*first, *last)) - 2 > width:
            first.pop()
        shown = len(first)  # the keys of the foot are in the order of `self._keys`
        if shown and TOGETHER.get(str(self._keys[shown - 1])) == self._keys[shown]:
            first.pop()
        parts: list[str | tuple[str, str]] = []
        for key, word in (*first, *last):
            parts += [("  " if parts else "", ""), (key, "$primary bold"), (f" {word}", "$ink-dim")]
        self.update(Content.assemble(*parts), layout=False)


def key_line(*keys: str | Key) -> KeyLine:
    """Create the last line of a screen: its keys, each with a word for its action."""
    return KeyLine(*keys)


def panel(widget: WidgetT, title: str = "") -> WidgetT:
    """Give a widget the frame of a panel, and another title if given."""
    widget.add_class("panel")
    if title:
        widget.border_title = title
    return widget


def room_panel(workspace: Workspace) -> RoomView:
    """Create the panel of a workspace's room, with its people, its robot and its numbers."""
    from tangy_tui.ui.widgets.room_view import RoomView

    return panel(
        RoomView(
            workspace.room,
            workspace.people,
            robot=workspace.robot.title,
            label=workspace.activity.deck.label,
            cards=bool(workspace.activity.deck.columns),
        )
    )
