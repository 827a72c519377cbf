"""The trajectory as it grows: one numbered line for each step (the T of III-A-3-iv)."""

from __future__ import annotations

from collections import deque
from functools import lru_cache
from typing import ClassVar

from rich.cells import cell_len
from textual import events
from textual.binding import Binding, BindingType
from textual.message import Message
from textual.scroll_view import ScrollView
from textual.strip import Strip

from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.themes import INK_CLASSES
from tangy_tui.ui.widgets.rows import Row, Rows, shorten

ARROW = "->"
SITUATION_FROM = 13  # columns that a situation keeps beside a long behaviour


class Transcript(ScrollView, can_focus=True):
    """Numbered steps, the newest at the end; up and down choose one, Enter tells of it.

    Keeps the last `most` lines; the numbers go on all the same.
    """

    COMPONENT_CLASSES: ClassVar[set[str]] = set(INK_CLASSES)
    DEFAULT_CSS = """
    Transcript { overflow-x: hidden; scrollbar-size-vertical: 1; scrollbar-gutter: stable; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up,k", "choose(-1)", "Previous step", show=False),
        Binding("down,j", "choose(1)", "Next step", show=False),
        Binding("pageup", "choose(-10)", "Ten steps back", show=False),
        Binding("pagedown", "choose(10)", "Ten steps on", show=False),
        Binding("home", "choose(-1000000)", "First step", show=False),
        Binding("end", "choose(1000000)", "Last step", show=False),
        Binding("enter", "tell", "Tell of the step", show=False),
    ]
    HELP = (
        "The steps of the demonstration or the game: stage, request, how the person's card is, "
        "and what Tangy did. The newest is at the end."
    )

    class Chosen(Message):
        """A step was chosen with Enter. `number` is its number, `text` what stands there."""

        def __init__(self, transcript: Transcript, number: int, text: str) -> None:
            super().__init__()
            self.transcript = transcript
            self.number = number
            self.text = text

        @property
        def control(self) -> Transcript:
            """The transcript that it was chosen in."""
            return self.transcript

    class Moved(Message):
        """The cursor is on another step, or (None) on none and follows the end."""

        def __init__(self, transcript: Transcript, number: int | None) -> None:
            super().__init__()
            self.transcript = transcript
            self.number = number

        @property
        def control(self) -> Transcript:
            """The transcript that it moved in."""
            return self.transcript

    def __init__(
        self,
        *,
        most: int = 2_000,
        empty: str = "No steps yet.",
        id: str | None = "transcript",
        classes: str | None = None,
    ) -> None:
        super().__init__(id=id, classes=classes)
        self.border_title = "Steps"
        self._steps: deque[str] = deque(maxlen=most)
        self._empty = clean(empty)
        self._count = 0
        self._chosen: int | None = None
        self._rows = Rows(self)

    @property
    def count(self) -> int:
        """The number of the last step."""
        return self._count

    @property
    def chosen(self) -> int | None:
        """The number of the step that the cursor is on, or None while it follows the end."""
        return None if self._chosen is None else self._count - len(self._steps) + self._chosen + 1

    def append(self, step: str) -> None:
        """Add a step at the end."""
        self._count += 1
        if len(self._steps) == self._steps.maxlen and self._chosen:
            self._chosen -= 1
        self._steps.append(clean(step))
        self._show()

    def remove_last(self) -> None:
        """Take the last step back."""
        if self._steps:
            self._steps.pop()
            self._count -= 1
            self._chosen = None
            self._show()

    def fill(self, steps: list[str]) -> None:
        """Show these steps and no others, numbered from 1."""
        self._steps.clear()
        self._steps.extend(clean(step) for step in steps)
        self._count = len(steps)
        self._chosen = None
        self._show()

    def point(self, number: int) -> None:
        """Put the cursor on a step, or on the nearest one that is kept."""
        if self._steps:
            first = self._count - len(self._steps) + 1
            self._chosen = min(len(self._steps) - 1, max(0, number - first))
            self._mark()
            self.post_message(self.Moved(self, self.chosen))

    def release(self) -> None:
        """Take the cursor off the steps, and follow the newest again."""
        self._chosen = None
        self._mark()
        self.post_message(self.Moved(self, None))

    def clear(self) -> None:
        """Begin again at step 1."""
        self.fill([])

    def action_choose(self, by: int) -> None:
        """Move the cursor; past the end it lets go, and the newest step is followed again."""
        if not self._steps:
            return
        last = len(self._steps) - 1
        at = last + 1 + by if self._chosen is None else self._chosen + by
        self._chosen = None if at > last else max(0, at)
        self._mark()
        self.post_message(self.Moved(self, self.chosen))

    def action_tell(self) -> None:
        """Post `Chosen` for the step under the cursor."""
        if self._chosen is not None and self.chosen is not None:
            self.post_message(self.Chosen(self, self.chosen, self._steps[self._chosen]))

    def on_resize(self, event: events.Resize) -> None:
        """Cut the lines anew."""
        self._show()

    def notify_style_update(self) -> None:
        """Draw in the new colours."""
        super().notify_style_update()
        self._rows.forget()

    def render_line(self, y: int) -> Strip:
        """Draw one line."""
        return self._rows.strip(y)

    def _show(self) -> None:
        if not self.is_attached or self._rows.width <= 0:
            return
        first = self._count - len(self._steps) + 1
        digits = max(2, len(str(self._count)))
        width = self._rows.width
        rows = [_row(first + n, step, digits, width) for n, step in enumerate(self._steps)]
        self._rows.put(rows or [((self._empty, "dim"),)])
        self._mark()

    def _mark(self) -> None:
        if not self._steps:
            return
        self._rows.mark({} if self._chosen is None else {self._chosen: "cursor"})
        self._rows.show(len(self._steps) - 1 if self._chosen is None else self._chosen)


@lru_cache(4_096)
def _row(number: int, step: str, digits: int, width: int) -> Row:
    """Write one step; where there is little room, the behaviour is cut last."""
    situation, arrow, behaviour = step.partition(f" {ARROW} ")
    label = f"{number:>{digits}} "
    room = width - len(label)
    if not arrow:
        return ((label, "dim"), (shorten(step, room), "text"))
    tail = cell_len(f" {ARROW} {behaviour}")
    situation = shorten(situation, max(SITUATION_FROM, room - tail))
    behaviour = shorten(behaviour, room - cell_len(situation) - len(ARROW) - 2)
    return ((label, "dim"), (situation, "text"), (f" {ARROW} ", "dim"), (behaviour, "strong"))
