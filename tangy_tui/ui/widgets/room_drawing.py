"""The drawing of a room without the robot, line by line as a plan lays it out."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rich.cells import cell_len

from tangy_profiles.person import Person
from tangy_profiles.scene import CardView, Scene
from tangy_tui.text.cards import card_title
from tangy_tui.text.typed_commands import AWAY
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.card_lines import LEGEND, card_lines
from tangy_tui.ui.widgets.room_plan import SPRITE_WIDTH, Grid, PlanLine, RoomPlan
from tangy_tui.ui.widgets.rows import Row, shorten, shorten_name
from tangy_tui.ui.widgets.wrapping import wrap

FLOOR_DOTS = 8  # columns between dots
BELOW = 12  # extra lines, cut off at the end


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
        """The drawn lines, cut to the height of the plan."""
        return self._lines[: self._plan.height]

    def _wall(self) -> None:
        self._lines[0].put(1, "━" * (self._plan.width - 2), "floor")
        self._lines[0].put(max(0, self._grid.front - 3), " Front ", "dim")

    def _floor(self) -> None:
        for y in range(self._plan.floor_row + 1, self._plan.table_row, 2):
            for x in range(FLOOR_DOTS // 2, self._plan.width, FLOOR_DOTS):
                self._lines[y].put(x, "·", "floor")

    def called(self, labels: Sequence[str]) -> None:
        """Draw the calls: on a line of their own, or only the newest beside the front."""
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
        """Draw the robot's speech, cut to the lines for it."""
        plan = self._plan
        if not speech or not plan.speech:
            return
        spoken = wrap(f"“{speech}”", plan.width - 2)
        if len(spoken) > plan.speech:
            spoken = spoken[: plan.speech]
            spoken[-1] = shorten(spoken[-1] + " …", plan.width - 3) + "”"
        for y, text in enumerate(spoken, plan.speech_row):
            self._lines[y].centre(plan.width // 2, text, "text")

    def tables(self) -> None:
        """Draw the tables."""
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

    def cards(self, read: str | None) -> None:
        """Draw a card on the table before each person; the robot reads that of `read`."""
        plan = self._plan
        row = plan.table_row
        for person, centre in zip(self._people, self._grid.centres, strict=False):
            ink = "robot" if person.id == read else "table"
            self._lines[row + plan.table // 2].put(centre - 1, "[▦]", ink)

    def card(self, card: CardView, robot: int) -> None:
        """Draw a card on the floor beside the robot's column, if there is room."""
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
            self._lines[y].keep(start - 1, start + width + 1)
            column = start
            for text, ink in row:
                self._lines[y].put(column, text, ink)
                column += cell_len(text)

    def everybody(self, scene: Scene) -> None:
        """Draw the people: head with the mark of a request, name, and activity."""
        slots = list(zip(self._people, self._grid.slots, strict=False))
        deep = self._names_deep()
        for place, (person, (start, end)) in enumerate(slots):
            if deep > 1:  # up to the middle of the slots of the next names on the same line
                start = (slots[place - deep + 1][1][0] + start) // 2 if place >= deep - 1 else 0
                after = place + deep - 1
                end = (slots[after][1][1] + end) // 2 if after < len(slots) else self._plan.width
            self._person(person, scene, place, (start, end - 1), place % deep, deep)

    def _names_deep(self) -> int:
        """Return on how many lines names alternate, so that neighbours' names have room."""
        if not self._plan.crowded:
            return 1
        slots = zip(self._people, self._grid.slots, strict=False)
        tight = [cell_len(clean(one.name)) >= end - start for one, (start, end) in slots]
        return 1 + self._plan.doing if any(tight) else 1

    def _person(
        self,
        person: Person,
        scene: Scene,
        place: int,
        within: tuple[int, int],
        below: int,
        deep: int,
    ) -> None:
        """Draw a person; the name is on line `below` of `deep`, between two columns."""
        row, most, centre = self._plan.head_row, self._plan.doing, self._grid.centres[place]
        width = within[1] - within[0]
        asking, away = person.id in scene.requests, person.id in scene.away
        ink = "warn" if asking else "dim" if away else "person"
        turn = f"?{scene.requests.index(person.id) + 1}" if asking else ""
        self._lines[row].put(centre, f"{'○' if away else '●'}{turn}", ink)
        name = shorten_name(clean(person.name), width)
        self._lines[row + 1 + below].within(centre, *within, name, ink)
        if deep > 1:
            return  # names use the lines for people's activities
        words = AWAY if away else clean(scene.doing.get(person.id, ""))
        if any(cell_len(word) > width for word in words.split()):
            return  # a part of a word tells nothing
        doing = wrap(words, width)
        if len(doing) > most:
            doing = [*doing[: most - 1], " ".join(doing[most - 1 :])]
        for y, text in enumerate(doing, row + 2):
            self._lines[y].within(centre, *within, shorten(text, width), "dim")


def draw_room(
    plan: RoomPlan,
    grid: Grid,
    people: Sequence[Person],
    scene: Scene,
    *,
    speech: str,
    label: Callable[[int], str],
    robot: int | None,
    cards: bool = True,
) -> list[PlanLine]:
    """Draw a scene without its robot.

    Args:
        plan: the rows to draw on.
        grid: the positions in cells.
        people: the participants.
        scene: the scene.
        speech: the robot's speech.
        label: returns the label of a number.
        robot: the column of the robot, if it stands still; the card it reads lies beside it.
        cards: whether people have cards.
    """
    drawing = RoomDrawing(plan, grid, people)
    drawing.called([clean(label(number)) for number in scene.called])
    drawing.speech(speech)
    drawing.tables()
    if cards:
        drawing.cards(scene.card.person if scene.card is not None else None)
    if scene.card is not None and robot is not None:
        drawing.card(scene.card, robot)
    drawing.everybody(scene)
    return drawing.lines
