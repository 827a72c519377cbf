"""The base of all lists with a cursor."""

from __future__ import annotations

from typing import ClassVar

from textual import events
from textual.binding import Binding, BindingType

from tangy_tui.ui.widgets.filtering import Filtered


class Choosable(Filtered, can_focus=True):
    """A scrollable list with a cursor: up and down move it, Enter chooses.

    Subclasses define the number of choices (`_length`), the lines of each (`_places`), how to draw
    them (`_show`), and the message for a chosen one (`_tell`).
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up,k", "choose(-1)", "One up", show=False, id="up"),
        Binding("down,j", "choose(1)", "One down", show=False, id="down"),
        Binding("pageup", "choose(-10)", "Ten up", show=False),
        Binding("pagedown", "choose(10)", "Ten down", show=False),
        Binding("home", "choose(-1000000)", "The first", show=False),
        Binding("end", "choose(1000000)", "The last", show=False),
        Binding("enter", "tell", "Tell of it", show=False),
    ]
    FOLLOWS: ClassVar[bool] = False
    """Whether the cursor leaves the list at its end, so that the list follows the newest line
    again."""

    def __init__(self, *, id: str | None = None, classes: str | None = None) -> None:
        super().__init__(id=id, classes=classes)
        self._cursor: int | None = None

    def action_choose(self, by: int) -> None:
        """Move the cursor."""
        count = self._length()
        if not count:
            return
        at = self._cursor
        if at is None:
            at = count if self.FOLLOWS or by < 0 else -1
        at += by
        past = None if self.FOLLOWS else count - 1
        self._cursor = past if at >= count else max(0, at)
        self._mark()

    def action_tell(self) -> None:
        """Choose the line at the cursor."""
        if self._cursor is not None:
            self._tell(self._cursor)

    def on_resize(self, event: events.Resize) -> None:
        """Lay out again."""
        self._show()

    def _filter_changed(self) -> None:
        self._show()

    def _length(self) -> int:
        """Return the number of choices."""
        raise NotImplementedError

    def _places(self, index: int) -> range:
        """Return the lines of a choice."""
        return range(index, index + 1)

    def _show(self) -> None:
        """Draw all lines, and mark the cursor's."""
        raise NotImplementedError

    def _tell(self, index: int) -> None:
        """Post the message for a chosen line."""
        raise NotImplementedError

    def _mark(self) -> None:
        """Mark the lines at the cursor, and scroll to them."""
        places = range(0) if self._cursor is None else self._places(self._cursor)
        self._rows.mark(dict.fromkeys(places, "cursor"))
        if self._cursor is not None:
            self._reveal(self._cursor)

    def _reveal(self, index: int) -> None:
        """Scroll as little as needed to show a choice; with the first one also the heading."""
        places = self._places(index)
        if places:
            self._rows.show(0 if index == 0 else places[0])
            self._rows.show(places[-1])
