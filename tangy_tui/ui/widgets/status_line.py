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
LEAST = 12
"""The least width in cells of a part that is cut."""
WHOLE_NOTE = 22
"""A note of up to so many cells is not cut before the stage: it tells what Tangy does now."""


@dataclass(frozen=True, slots=True)
class Status:
    """The parts of the status line; empty ones are left out.

    `robot` and STOP are shown at every width; if there is no room, the step is dropped first, since
    its list shows it too, then the game; then a long stage is cut, and the others are dropped from
    the right.
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
        room = width - len(STOP) - 1
        stage, game = self._stage_and_game(
            room - sum(cell_len(text) + len(GAP) for text, _ in parts)
        )
        if stage:
            parts.append((stage, "robot"))
        if game:
            parts.append((game, "text"))
        if status.seen:
            parts.append((f"seen {clean(status.seen)}", "text"))
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
            if n >= 2 and cell_len(text) > left and (n < len(parts) - 1 or left < LEAST):
                break
            text = shorten(text, left)
            row += [(gap, "dim"), (text, name)]
            used += len(gap) + cell_len(text)
        row += [(" " * max(0, width - used - len(STOP)), "text"), (STOP, "bad")]
        return tuple(row)

    def _stage_and_game(self, room: int) -> tuple[str, str]:
        """Return the stage, cut if it is too long, and the game, "" if there is no room for it."""
        status = self._status
        stage = clean(status.stage)
        game = "" if status.game is None else f"game {status.game}"
        seen = len(GAP) + cell_len(f"seen {clean(status.seen)}") if status.seen else 0
        note = len(GAP) + min(cell_len(clean(status.note)), WHOLE_NOTE) if status.note else 0
        left = room - seen - note
        if cell_len(stage) + (len(GAP) + len(game) if game else 0) <= left:
            return stage, game
        if left < LEAST:  # there is no room for the note either
            left = room - seen
        return shorten(stage, max(left, LEAST)), "" if stage else game
