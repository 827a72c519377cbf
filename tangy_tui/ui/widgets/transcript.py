"""The trajectory as it grows: one numbered line for each step (the T of III-A-3-iv)."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from functools import lru_cache

from rich.cells import cell_len
from textual.message import Message

from tangy_tui.text.phrases import NONE_FOUND
from tangy_tui.text.situations import WRONG_STEP, marked_step
from tangy_tui.text.teaching import NO_STEPS
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.choosable import Choosable
from tangy_tui.ui.widgets.rows import Row, shorten

ARROW = "->"
SITUATION_FROM = 13  # minimum width of a situation beside a long behaviour


class Transcript(Choosable):
    """Numbered steps, the newest at the end; up and down move the cursor, Enter chooses.

    Keeps the last `most` lines; the numbering continues.
    """

    FOLLOWS = True
    HELP = (
        "The steps of the demonstration or the game: stage, request, how the person's card is, "
        "and what Tangy did. The newest is at the end."
    )

    class Chosen(Message):
        """A step was chosen with Enter. `number` is its number, `text` its line."""

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
        """The cursor moved to another step, or (None) off the list, which follows the end."""

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
        empty: str = NO_STEPS,
        id: str | None = "transcript",
        classes: str | None = None,
    ) -> None:
        super().__init__(id=id, classes=classes)
        self.border_title = "Steps"
        self.steps: deque[str] = deque(maxlen=most)
        self._empty = clean(empty)
        self._count = 0
        self._seen: list[int] = []  # the indices of the steps that are shown

    @property
    def count(self) -> int:
        """The number of the last step."""
        return self._count

    @property
    def chosen(self) -> int | None:
        """The number of the step at the cursor, None while it follows the end."""
        if self._cursor is None or self._cursor >= len(self._seen):
            return None
        return self._number(self._cursor)

    def append(self, step: str) -> None:
        """Append a step."""
        self._count += 1
        if len(self.steps) == self.steps.maxlen and self._cursor:
            self._cursor -= 1
        self.steps.append(clean(step))
        self._show()

    def mark_wrong(self, wrong: Sequence[bool]) -> None:
        """Mark the steps that a teacher called wrong, and no others; one entry for each step."""
        kept = wrong[len(wrong) - len(self.steps) :]
        marked = [marked_step(s, wrong=w) for s, w in zip(self.steps, kept, strict=True)]
        if marked != list(self.steps):
            self.steps.clear()
            self.steps.extend(marked)
            self._show()

    def remove_last(self) -> None:
        """Remove the last step."""
        if self.steps:
            self.steps.pop()
            self._count -= 1
            self._cursor = None
            self._show()

    def fill(self, steps: list[str]) -> None:
        """Replace the steps, numbered from 1."""
        self.steps.clear()
        self.steps.extend(clean(step) for step in steps)
        self._count = len(steps)
        self._cursor = None
        self._show()

    def point(self, number: int) -> None:
        """Move the cursor to a step, or to the nearest one that is kept."""
        if self.steps:
            if self.filter:
                self.unfilter()
            first = self._count - len(self.steps) + 1
            self._cursor = min(len(self.steps) - 1, max(0, number - first))
            self._mark()
            self.post_message(self.Moved(self, self.chosen))

    def release(self) -> None:
        """Take the cursor off the steps, and follow the newest again."""
        self._cursor = None
        self._mark()
        self.post_message(self.Moved(self, None))

    def clear(self, after: int = 0, empty: str | None = None) -> None:
        """Clear the steps, and show `empty` if given; the next one is numbered `after` + 1."""
        if empty is not None:
            self._empty = clean(empty)
        self.fill([])
        self._count = after

    def action_choose(self, by: int) -> None:
        """Move the cursor; at the end it leaves the list, which then follows the newest step."""
        super().action_choose(by)
        if self.steps:
            self.post_message(self.Moved(self, self.chosen))

    def _length(self) -> int:
        return len(self._seen)

    def _number(self, index: int) -> int:
        return self._count - len(self.steps) + self._seen[index] + 1

    def _tell(self, index: int) -> None:
        self.post_message(self.Chosen(self, self._number(index), self.steps[self._seen[index]]))

    def _filter_changed(self) -> None:
        self._cursor = None
        self._show()
        self.post_message(self.Moved(self, None))

    def _show(self) -> None:
        self._seen = [n for n, step in enumerate(self.steps) if self._has(step)]
        if not self.is_attached or self._rows.width <= 0:
            return
        first = self._count - len(self.steps) + 1
        digits = max(2, len(str(self._count)))
        width = self._rows.width
        rows = [_row(first + n, self.steps[n], digits, width) for n in self._seen]
        self._rows.put(rows or [((NONE_FOUND if self.steps else self._empty, "dim"),)])
        self._mark()

    def _mark(self) -> None:
        if not self._seen:
            return
        self._rows.mark({} if self._cursor is None else {self._cursor: "cursor"})
        self._rows.show(len(self._seen) - 1 if self._cursor is None else self._cursor)


@lru_cache(4_096)
def _row(number: int, step: str, digits: int, width: int) -> Row:
    """Format one step; if there is little room, the behaviour is cut last."""
    situation, arrow, behaviour = step.partition(f" {ARROW} ")
    label = f"{number:>{digits}} "
    wrong = WRONG_STEP if situation.startswith(WRONG_STEP) else ""
    situation = situation.removeprefix(wrong)
    room = width - len(label) - len(wrong)
    head: Row = ((label, "dim"), (wrong, "bad")) if wrong else ((label, "dim"),)
    if not arrow:
        return (*head, (shorten(situation, room), "text"))
    tail = cell_len(f" {ARROW} {behaviour}")
    situation = shorten(situation, max(SITUATION_FROM, room - tail))
    behaviour = shorten(behaviour, room - cell_len(situation) - len(ARROW) - 2)
    return (*head, (situation, "text"), (f" {ARROW} ", "dim"), (behaviour, "strong"))
