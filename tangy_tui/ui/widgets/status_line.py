"""The line at the top of every screen: mode, state of the robot, position in the activity."""

from __future__ import annotations

from dataclasses import dataclass

from rich.cells import cell_len
from textual.strip import Strip

from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.inks import InkedWidget
from tangy_tui.ui.widgets.rows import Row, Span, draw, shorten

STOP = "^x STOP"
GAP = " │ "


@dataclass(frozen=True, slots=True)
class Status:
    """The parts of the status line; empty ones are left out.

    `robot` and STOP are shown at every width; if there is no room, the step is dropped first, since
    its list shows it too, then the others from the right.
    `stage` is the phase of the game in words.
    `alarm` shows the robot's part as a warning, with a mark; `seen` is the coverage of situations.
    """

    mode: str = ""
    robot: str = ""
    stage: str = ""
    game: int | None = None
    step: int | None = None
    note: str = ""
    alarm: bool = False
    seen: str = ""


class StatusLine(InkedWidget):
    """One line, at the top of every screen."""

    DEFAULT_CSS = """
    StatusLine { height: 1; dock: top; background: $panel; padding: 0 1; }
    """

    def __init__(self, status: Status | None = None, *, id: str | None = "status") -> None:
        super().__init__(id=id)
        self._status = status or Status()

    @property
    def status(self) -> Status:
        """The parts shown."""
        return self._status

    def show(self, status: Status) -> None:
        """Replace the parts."""
        if status != self._status:
            self._status = status
            self.refresh()

    def render_line(self, y: int) -> Strip:
        """Draw the line."""
        width = self.size.width
        return draw(self, self._row(width), width)

    def _row(self, width: int) -> Row:
        status = self._status
        mark = "! " if status.alarm else ""
        parts: list[Span] = [
            (f"TANGY {clean(status.mode)}".rstrip(), "strong"),
        ]
        if status.robot:
            word = f"{mark}robot {clean(status.robot)}"
            parts.append((word, "bad" if status.alarm else "good"))
        if status.stage:
            parts.append((clean(status.stage), "robot"))
        if status.game is not None:
            parts.append((f"game {status.game}", "text"))
        if status.seen:
            parts.append((f"seen {clean(status.seen)}", "text"))
        room = width - len(STOP) - 1
        if status.note:
            parts.append((clean(status.note), "dim"))
        if status.step is not None:
            with_step = list(parts)
            with_step.insert(len(parts) - bool(status.note), (f"step {status.step}", "text"))
            if sum(cell_len(text) + len(GAP) for text, _ in with_step) - len(GAP) <= room:
                parts = with_step
        row: list[Span] = []
        used = 0
        for n, (text, name) in enumerate(parts):
            gap = GAP if row else ""
            left = room - used - len(gap)
            if n >= 2 and cell_len(text) > left and (n < len(parts) - 1 or left < 12):
                break
            text = shorten(text, left)
            row += [(gap, "dim"), (text, name)]
            used += len(gap) + cell_len(text)
        row += [(" " * max(0, width - used - len(STOP)), "text"), (STOP, "bad")]
        return tuple(row)
