"""The layout of a room in characters: rows, columns, and what is left out."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate, pairwise

from rich.cells import cell_len

from tangy_profiles.room import Point, Room
from tangy_tui.ui.widgets.rows import Row, Span

SPRITE_WIDTH = 7
ROOMY_SLOT = 14
"""From this width of a slot in cells, a person's activity fits on one line."""


@dataclass(frozen=True, slots=True)
class RoomPlan:
    """The rows of a room view; a height of 0 means that there was no room for a part.

    From the top: wall, board (calls), speech, floor, table; then head, name and activity of the
    people.
    """

    width: int
    height: int
    board: int
    speech: int
    floor: int
    table: int
    doing: int
    crowded: bool = False
    """Whether slots are too narrow for a person's activity on one line."""

    @property
    def board_row(self) -> int:
        """The first row below the wall."""
        return 1

    @property
    def speech_row(self) -> int:
        """The first row of speech."""
        return 1 + self.board

    @property
    def floor_row(self) -> int:
        """The first row of the floor."""
        return 1 + self.board + self.speech

    @property
    def table_row(self) -> int:
        """The first row of the table."""
        return self.floor_row + self.floor

    @property
    def head_row(self) -> int:
        """The first row of the people: heads and request marks, then names, then activities."""
        return self.table_row + self.table

    @property
    def sprite(self) -> int:
        """The height of the robot in rows."""
        return 2 if self.floor >= 4 else 1


def plan(width: int, height: int, people: int = 4) -> RoomPlan:
    """Assign the rows: first what a teacher must see, then comfort, then floor to drive on."""
    crowded = width < people * ROOMY_SLOT
    rows = {"board": 0, "speech": 0, "floor": 2, "table": 1, "doing": 1}
    spare = height - 3 - sum(rows.values())  # the wall, heads and names
    for part, wanted in (
        ("doing", 2 if crowded else 1),
        ("floor", 3),
        ("speech", 1),
        ("floor", 4),
        ("doing", 2),
        ("board", 1),
        ("floor", 5),
        ("speech", 2),
        ("table", 3),
    ):
        step = wanted - rows[part]
        if 0 < step <= spare:
            rows[part] += step
            spare -= step
    rows["floor"] += max(0, spare)
    return RoomPlan(width, height, **rows, crowded=crowded)


CARD = 3
"""The width of a card on a table, in cells."""
EDGE = 1
"""The cells beside the outer tables that stay free, as beside the wall."""


class Grid:
    """Maps metres to columns and rows: zoomed to the table, with a slot for each person."""

    def __init__(self, room: Room, people: int, plan: RoomPlan) -> None:
        seats = [seat.x for seat in room.seated(people)]
        gaps = [b - a for a, b in pairwise(seats)]
        left, near, right, _ = room.table
        margin = min(gaps) / 2 if gaps else (right - left) / 2
        tables = room.tables if people > 1 and room.tables else ()
        tables = tuple(table for table in tables if table[0] <= seats[-1])
        self._from = min([seats[0] - margin, *(table[0] for table in tables)])
        end = max([seats[-1] + margin, *(table[2] for table in tables)])
        self._scale = plan.width / max(0.1, end - self._from)
        self._top = room.front.y
        self._depth = max(0.1, near - room.reach - room.front.y)
        self._near = near
        self._plan = plan
        at_table = [sum(table[2] < x for table in tables) for x in seats]
        self.centres = self._between_ends([self.column(x) for x in seats], at_table)
        middles = [round(((a + b) / 2 - self._from) * self._scale) for a, b in pairwise(seats)]
        self.slots = list(zip([0, *middles], [*middles, plan.width], strict=True))
        self.tables = [self._ends(table[0], table[2]) for table in tables or (room.table,)]
        self.front = self.column(room.front.x)

    def _between_ends(self, centres: list[int], at_table: list[int]) -> list[int]:
        """Move cards (centre columns) by as little as shows both ends of each table.

        If there is no room for the ends, nothing is moved.
        """
        needed = [CARD if a == b else CARD + 2 for a, b in pairwise(at_table)]
        gaps = [min(b - a, need) for (a, b), need in zip(pairwise(centres), needed, strict=True)]
        least = list(accumulate(gaps, initial=EDGE + 2))
        spare = self._plan.width - 1 - EDGE - 2 - least[-1]
        if spare < 0:
            return centres
        wished = zip(centres, least, strict=True)
        return [min(max(centre, low), low + spare) for centre, low in wished]

    def _ends(self, left: float, right: float) -> tuple[int, int]:
        """Return the end columns of a table (from and to in m), outside the cards on it."""
        first, last = EDGE, self._plan.width - 1 - EDGE
        start, end = max(first, self.column(left)), min(last, self.column(right))
        cards = [centre for centre in self.centres if start <= centre <= end]
        if not cards:
            return start, end
        return max(first, min(start, cards[0] - 2)), min(last, max(end, cards[-1] + 2))

    def on_floor(self, point: Point) -> bool:
        """Return whether a point in m is in front of the table, where the floor is drawn."""
        return point.y < self._near

    def column(self, x: float) -> int:
        """Return the column, in cells, of an x in m."""
        return min(self._plan.width - 1, max(0, int((x - self._from) * self._scale)))

    def sprite(self, point: Point) -> tuple[int, int]:
        """Return column and row of the robot's upper left corner at a point."""
        plan = self._plan
        share = min(1.0, max(0.0, (point.y - self._top) / self._depth))
        row = plan.floor_row + round(share * (plan.floor - plan.sprite))
        column = self.column(point.x) - SPRITE_WIDTH // 2
        return min(plan.width - SPRITE_WIDTH, max(0, column)), row

    def floor(self, point: Point) -> tuple[int, int]:
        """Return column and row of a point on the floor, on which the robot is centred."""
        plan = self._plan
        share = min(1.0, max(0.0, (point.y - self._top) / self._depth))
        row = plan.floor_row + round(share * (plan.floor - plan.sprite)) + plan.sprite // 2
        return self.column(point.x), row


class PlanLine:
    """A line of cells on which later pieces of text overwrite earlier ones."""

    def __init__(self, width: int) -> None:
        self._cells = [" "] * width
        self._inks = ["text"] * width
        self._kept = range(0)

    def put(self, column: int, text: str, ink: str) -> None:
        """Write text from a column on; text outside the line is cut."""
        for character in text:
            cells = cell_len(character)
            if cells and column >= 0 and column + cells <= len(self._cells):
                self._cells[column] = character
                self._inks[column] = ink
                if cells == 2:
                    self._cells[column + 1] = ""
                    self._inks[column + 1] = ink
            elif not cells and 0 < column <= len(self._cells):
                self._cells[column - 1] += character
            column += cells

    def copy(self) -> PlanLine:
        """Return a copy of the line."""
        line = PlanLine(0)
        line._cells = self._cells[:]
        line._inks = self._inks[:]
        line._kept = self._kept
        return line

    def keep(self, start: int, end: int) -> None:
        """Protect the columns from `start` to before `end` from marks."""
        self._kept = range(start, end)

    def mark(self, column: int, character: str, ink: str) -> None:
        """Write a mark, except on protected columns."""
        if column not in self._kept:
            self.put(column, character, ink)

    def within(self, column: int, start: int, end: int, text: str, ink: str) -> None:
        """Write text centred on a column, shifted to stay between start and end."""
        at = column - (cell_len(text) - 1) // 2
        self.put(max(start, min(at, end - cell_len(text))), text, ink)

    def centre(self, column: int, text: str, ink: str) -> None:
        """Write text centred on a column, within the line."""
        cells = cell_len(text)
        start = column - (cells - 1) // 2
        self.put(max(0, min(start, len(self._cells) - cells)), text, ink)

    def row(self) -> Row:
        """Return the line as one span per ink; blanks need no ink of their own."""
        spans: list[Span] = []
        for cell, ink in zip(self._cells, self._inks, strict=True):
            if spans and (cell == " " or spans[-1][1] == ink):
                spans[-1] = (spans[-1][0] + cell, spans[-1][1])
            elif len(spans) == 1 and spans[0][0].isspace():
                spans[0] = (spans[0][0] + cell, ink)
            else:
                spans.append((cell, ink))
        return tuple(spans)
