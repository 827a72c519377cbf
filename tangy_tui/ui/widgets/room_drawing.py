"""The room on paper: everything in it but the robot, placed on lines by a plan."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rich.cells import cell_len

from tangy_profiles.person import Person
from tangy_profiles.scene import CardView, Scene
from tangy_tui.text.cards import card_title
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.card_lines import LEGEND, card_lines
from tangy_tui.ui.widgets.room_plan import SPRITE_WIDTH, Grid, PlanLine, RoomPlan
from tangy_tui.ui.widgets.rows import Row, shorten
from tangy_tui.ui.widgets.wrapping import wrap

FLOOR_DOTS = 8  # columns from one dot to the next
BELOW = 12  # lines for what does not fit, which are cut off


class RoomDrawing:
    """Draws one scene; `lines` are the result, from the wall down."""

    def __init__(self, plan: RoomPlan, grid: Grid, people: Sequence[Person]) -> None:
        self._plan = plan
        self._grid = grid
        self._people = people
        self._lines = [PlanLine(plan.width) for _ in range(plan.height + BELOW)]
        self._wall()
        self._floor()

    @property
    def lines(self) -> list[PlanLine]:
        """What was drawn, cut to the height of the plan."""
        return self._lines[: self._plan.height]

    def _wall(self) -> None:
        self._lines[0].put(1, "━" * (self._plan.width - 2), "floor")
        self._lines[0].put(max(0, self._grid.front - 3), " Front ", "dim")

    def _floor(self) -> None:
        for y in range(self._plan.floor_row + 1, self._plan.table_row, 2):
            for x in range(FLOOR_DOTS // 2, self._plan.width, FLOOR_DOTS):
                self._lines[y].put(x, "·", "floor")

    def called(self, labels: Sequence[str]) -> None:
        """Write what was called: on a line of its own, or only the newest beside the front."""
        if not labels:
            return
        plan = self._plan
        head, newest = f" {len(labels)} called: ", labels[-1]
        width = cell_len(head + newest)
        rest = " "
        if plan.board:
            rest = ""
            for label in reversed(labels[:-1]):
                if width + cell_len(f"{rest}  {label}") > plan.width - 8:
                    rest += "  …"
                    break
                rest += f"  {label}"
            row, start = plan.board_row, (plan.width - width - cell_len(rest)) // 2
        elif width < plan.width - self._grid.front - 7:
            row, start = 0, plan.width - width - 2
        else:
            return
        self._lines[row].put(start, head, "dim")
        self._lines[row].put(start + len(head), newest, "strong")
        self._lines[row].put(start + width, rest, "dim")

    def speech(self, speech: str) -> None:
        """Write what the robot says, cut to the lines there are for it."""
        plan = self._plan
        if not speech or not plan.speech:
            return
        spoken = wrap(f"“{speech}”", plan.width - 2)
        if len(spoken) > plan.speech:
            spoken = spoken[: plan.speech]
            spoken[-1] = shorten(spoken[-1] + " …", plan.width - 3) + "”"
        for y, text in enumerate(spoken, plan.speech_row):
            self._lines[y].centre(plan.width // 2, text, "text")

    def table(self, read: str | None) -> None:
        """Draw the table with a card for each person; `read` is whose card the robot reads."""
        plan = self._plan
        row = plan.table_row
        for left, right in self._grid.tables:
            inner = max(0, right - left - 1)
            if plan.table == 3:
                self._lines[row].put(left, "╭" + "─" * inner + "╮", "table")
                self._lines[row + 1].put(left, "│" + " " * inner + "│", "table")
                self._lines[row + 2].put(left, "╰" + "─" * inner + "╯", "table")
            else:
                self._lines[row].put(left, "╘" + "═" * inner + "╛", "table")
        for person, centre in zip(self._people, self._grid.centres, strict=False):
            ink = "robot" if person.id == read else "table"
            self._lines[row + plan.table // 2].put(centre - 1, "[▦]", ink)

    def card(self, card: CardView, robot: int) -> None:
        """Draw a card on the floor beside the robot's column, where there is room for it."""
        plan = self._plan
        name = next((clean(p.name) for p in self._people if p.id == card.person), card.person)
        title: Row = ((shorten(card_title(name), 30), "strong"),)
        rows = [title, *card_lines(card), LEGEND]
        width = max(sum(cell_len(text) for text, _ in row) for row in rows)
        right = robot + SPRITE_WIDTH + 2
        start = right if right + width + 1 < plan.width else robot - width - 2
        if start < 1 or len(rows) >= plan.floor:
            return
        for y, row in enumerate(rows, plan.table_row - len(rows)):
            self._lines[y].put(start - 1, " " * (width + 2), "text")
            column = start
            for text, ink in row:
                self._lines[y].put(column, text, ink)
                column += cell_len(text)

    def everybody(self, scene: Scene) -> None:
        """Draw the people: head with the mark of a request, name, and what they do."""
        for person, centre, (start, end) in zip(
            self._people, self._grid.centres, self._grid.slots, strict=False
        ):
            self._person(person, scene, centre, end - start - 1)

    def _person(self, person: Person, scene: Scene, centre: int, width: int) -> None:
        row, most = self._plan.head_row, self._plan.doing
        asking = person.id in scene.requests
        ink = "warn" if asking else "person"
        turn = f"?{scene.requests.index(person.id) + 1}" if asking else ""
        self._lines[row].put(centre, f"●{turn}", ink)
        self._lines[row + 1].centre(centre, shorten(clean(person.name), width), ink)
        doing = wrap(clean(scene.doing.get(person.id, "")), width)
        if len(doing) > most:
            doing = [*doing[: most - 1], " ".join(doing[most - 1 :])]
        for y, text in enumerate(doing, row + 2):
            self._lines[y].centre(centre, shorten(text, width), "dim")


def draw_room(
    plan: RoomPlan,
    grid: Grid,
    people: Sequence[Person],
    scene: Scene,
    *,
    speech: str,
    label: Callable[[int], str],
    robot: int | None,
) -> list[PlanLine]:
    """Draw a scene without its robot.

    Args:
        plan: the rows to draw on.
        grid: where everything stands, in cells.
        people: who takes part.
        scene: what there is to see.
        speech: what Tangy says.
        label: names a number.
        robot: the column of the robot, if it stands; beside it lies the card that it reads.
    """
    drawing = RoomDrawing(plan, grid, people)
    drawing.called([clean(label(number)) for number in scene.called])
    drawing.speech(speech)
    drawing.table(scene.card.person if scene.card is not None else None)
    if scene.card is not None and robot is not None:
        drawing.card(scene.card, robot)
    drawing.everybody(scene)
    return drawing.lines
