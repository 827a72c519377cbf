"""The panel for staff: the call in large blocks, the clock, the next step, and people."""

from __future__ import annotations

from collections.abc import Sequence

from rich.cells import cell_len
from textual import events
from textual.content import Content

from tangy_tui.text.planned_time import Fact
from tangy_tui.text.staff_view import more_words
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.rows import Row, RowView, fit, shorten
from tangy_tui.ui.widgets.wrapping import WORD, wrap

ROWS, COLUMNS = 5, 3
_FONT = """
0 7 5 5 5 7|1 2 6 2 2 7|2 7 1 7 4 7|3 7 1 7 1 7|4 5 5 7 1 1|5 7 4 7 1 7|6 7 4 7 5 7|7 7 1 1 1 1|
8 7 5 7 5 7|9 7 5 7 1 7|A 2 5 7 5 5|B 6 5 6 5 6|C 3 4 4 4 3|D 6 5 5 5 6|E 7 4 6 4 7|F 7 4 6 4 4|
G 3 4 5 5 3|H 5 5 7 5 5|I 7 2 2 2 7|J 1 1 1 5 2|K 5 5 6 5 5|L 4 4 4 4 7|M 5 7 7 5 5|N 6 5 5 5 5|
O 2 5 5 5 2|P 6 5 6 4 4|Q 2 5 5 3 1|R 6 5 6 5 5|S 3 4 2 1 6|T 7 2 2 2 2|U 5 5 5 5 7|V 5 5 5 5 2|
W 5 5 7 7 5|X 5 5 2 5 5|Y 5 5 2 2 2|Z 7 1 2 4 7
"""
"""Each character with its rows from the top, three bits each."""

GLYPHS = {
    sign: tuple(map(int, rows))
    for sign, *rows in (entry.split() for entry in _FONT.replace("\n", "").split("|"))
}


def block_rows(label: str, large: bool) -> list[str]:
    """Draw the letters and digits of a label; `large` doubles width and height."""
    across = 4 if large else 2
    drawn = [""] * ROWS
    for sign in label.upper():
        glyph = GLYPHS.get(sign)
        for row in range(ROWS):
            if glyph is None:
                drawn[row] += " " * across
                continue
            bits = (glyph[row] >> (COLUMNS - 1 - column) & 1 for column in range(COLUMNS))
            drawn[row] += "".join(("█" if bit else " ") * across for bit in bits) + " " * across
    return [row.rstrip().ljust(len(drawn[0])) for row in drawn for _ in range(2 if large else 1)]


LARGE_WIDTH, LARGE_HEIGHT = 56, 22
"""From this size in columns and lines on, the call is drawn twice as large."""
BESIDE = 30
"""With this width in cells left, facts are beside the call, otherwise below it."""
SLOT, NARROW = 36, 25
"""The width of one person in cells, and the width if people do not fit otherwise."""
NAME, SHORT_NAME = 14, 10
"""The width of a person's name in cells, in either."""
BOARD = 48
"""The width of the board of calls in cells, if it is shown here."""
BOARD_HEIGHT = 9
"""From this height in lines on, the board is shown here, with the facts below the call."""

TITLE = "Now"
HARD = "\N{NO-BREAK SPACE}"

NEXT_HEIGHT = 9
"""A panel with more lines gives the next step two of them, if it needs them.

The same holds for what Tangy said beyond the title.
"""

PersonLine = tuple[str, str, str]
"""The name of a person, their state, and its ink."""


class StaffPanel(RowView, can_focus=True):
    """Draws given values line by line; only changed lines go to the terminal."""

    DEFAULT_CSS = """
    StaffPanel { scrollbar-gutter: auto; scrollbar-size-vertical: 0; }
    """
    HELP = (
        "What Tangy said last, what it does next and why, the time, and each person: how long they "
        "have waited, and when Tangy last visited them. If numbers are called, also the last call, "
        "the pattern to play for, and the pace. If there are more people than lines, up and down "
        "scroll; Home, Esc or the next step leads back."
    )

    def __init__(self) -> None:
        super().__init__(id="staff")
        self.border_title = TITLE
        self._call, self._next, self._said, self._news = "", "", "", ""
        self._facts: tuple[Fact, ...] = ()
        self._people: tuple[PersonLine, ...] = ()
        self._board: tuple[Row, ...] = ()
        self._across = 1  # people in a line

    def show(
        self,
        call: str,
        next_step: str,
        facts: Sequence[Fact],
        people: Sequence[PersonLine],
        board: Sequence[Row] = (),
        said: str = "",
        news: str = "",
    ) -> None:
        """Show the last call, the next step, facts beside the call, people, and the board.

        The title tells what Tangy `said`; what it has no room for stands below it. `news` stand
        above the next step.
        """
        if said != self._said:
            self._said = said
            self._draw_title()
            self._draw()
        if news != self._news:
            self._news = news
            self.return_to_top()
            self._draw()
        new = call, next_step, tuple(facts), tuple(people), tuple(board)
        if new != (self._call, self._next, self._facts, self._people, self._board):
            if new[:2] != (self._call, self._next):
                self.return_to_top()
            self._call, self._next, self._facts, self._people, self._board = new
            self._draw()

    def on_resize(self, event: events.Resize) -> None:
        """Lay out again."""
        self._draw_title()
        self._draw()

    def return_to_top(self) -> bool:
        """Scroll back to the next step and the call; return False if they are visible."""
        if not self.scroll_offset.y:
            return False
        self.scroll_home(animate=False)
        return True

    def watch_scroll_y(self, old_value: float, new_value: float) -> None:
        """Tell how many people are below the visible lines; offsets are in rows."""
        super().watch_scroll_y(old_value, new_value)
        self._tell_below()

    def _tell_below(self) -> None:
        below = len(self._rows) - self._rows.height - self.scroll_offset.y
        last = len(self._people) % self._across or self._across
        count = (below - 1) * self._across + last if below > 0 else 0
        count = min(count, len(self._people))  # facts may be below as well
        self.border_subtitle = more_words(count) if count else ""

    def _draw_title(self) -> None:
        said, more = self._said_in_title()
        said = f"{said} …" if more else said
        self.border_title = Content(f"{TITLE} │ {said}" if said else TITLE)

    def _said_in_title(self) -> tuple[str, str]:
        """Divide what Tangy said: what the title has room for, and the rest."""
        said = " ".join(WORD.findall(clean(self._said)))
        room = max(0, self._rows.width - len(TITLE) - 5)
        if cell_len(said) <= room:
            return said, ""
        first = wrap(said, room - 2)[0]
        return first, said[len(first) :].strip()

    def _said_below(self, width: int, height: int) -> list[str]:
        """Wrap what Tangy said beyond the title."""
        most, more = 2 if height > NEXT_HEIGHT else 1, self._said_in_title()[1]
        lines = wrap(f"… {more}", width) if more else []
        if len(lines) > most:
            lines[most - 1] = shorten(" ".join(lines[most - 1 :]), width)
        return lines[:most]

    def _draw(self) -> None:
        width, height = self._rows.width, self._rows.height
        if not self.is_attached or width < 10:
            return
        empty = not self._call and not self._board  # the activity has no calls
        most = 3 if empty else 2 if height > NEXT_HEIGHT else 1
        next_lines = wrap(clean(self._next), width)
        if len(next_lines) > most:  # a sentence must not look whole if it is cut
            next_lines[most - 1] = shorten(" ".join(next_lines[most - 1 :]), width)
        next_lines = next_lines[:most]
        news = wrap(clean(self._news), width)[:2] if self._news else []
        rows: list[Row] = [((line, "robot"),) for line in self._said_below(width, height)]
        rows += [((line, "warn"),) for line in news]
        rows += [((line, "strong"),) for line in next_lines]
        rows += self._block(width, height)
        rows += self._everybody(width, max(1, height - len(rows)))
        self._rows.put(rows)
        self._tell_below()

    def _block(self, width: int, height: int) -> list[Row]:
        """Draw the call in blocks, and the facts beside it."""
        large = width >= LARGE_WIDTH and height >= LARGE_HEIGHT
        call = self._call.replace("-", "")
        drawn = block_rows(call, large) if call else []
        if call and height < len(drawn) + 2:  # digits cut in half tell nothing
            return [self._in_words(width)]
        beside = max((cell_len(row) for row in drawn), default=0)
        if self._board and height >= BOARD_HEIGHT and width - beside > BOARD:
            return self._with_board(drawn, beside, width)
        side = width if width - beside < BESIDE else width - beside - 1
        facts = _fitting(self._facts, side)
        if width - beside < BESIDE:
            below: list[Row] = [((row, "robot"),) for row in drawn]
            return below + [((fact, "text"),) for fact in facts]
        count = max(len(drawn), len(facts))
        rows: list[Row] = []
        for number in range(count):
            block = drawn[number] if number < len(drawn) else ""
            fact = facts[number] if number < len(facts) else ""
            room = width - beside - 1
            told = (shorten(fact, room if beside else width), "text")
            rows.append(((fit(block, beside + 1), "robot"), told) if beside else (told,))
        return rows

    def _in_words(self, width: int) -> Row:
        """Write the call and as many facts as fit on one line."""
        facts = _fitting(self._facts, 0)
        while facts and cell_len(", ".join(facts)) > width - cell_len(self._call) - 3:
            facts.pop()
        return ((f"{self._call}   ", "robot"), (", ".join(facts), "text"))

    def _with_board(self, drawn: Sequence[str], beside: int, width: int) -> list[Row]:
        """Draw the board beside the call, and the facts below both."""
        rows: list[Row] = []
        for number, row in enumerate(self._board):
            block = drawn[number] if number < len(drawn) else ""
            rows.append(((fit(block, beside + 1), "robot"), *row))
        for room in (width, 0):  # the longest words, and the shortest if those do not fit
            facts = _fitting(self._facts, room)
            lines = wrap(", ".join(fact.replace(" ", HARD) for fact in facts), width)
            if len(lines) <= 2:
                break
        told = [line.replace(HARD, " ") for line in lines[:2]]
        if len(lines) > len(told):  # a comma would promise more
            told[-1] = told[-1].rstrip(", ")
        return rows + [((line, "text"),) for line in told]

    def _everybody(self, width: int, height: int) -> list[Row]:
        """Draw people in as many columns as fit; in narrow ones if `height` lines are too few."""
        across = max(1, width // SLOT)
        if across * height < len(self._people):
            across = max(1, width // NARROW)
        shown, slot, self._across = self._people, width // across, across
        longest = max((cell_len(clean(name)) for name, _, _ in shown), default=0)
        names = min(NAME if slot >= SLOT else SHORT_NAME, longest)
        return [
            tuple(
                span
                for person in shown[at : at + across]
                for span in self._person(person, slot, names)
            )
            for at in range(0, len(shown), across)
        ]

    @staticmethod
    def _person(person: PersonLine, width: int, columns: int) -> Row:
        name, how, ink = person
        how = how if width >= SLOT else how.partition(",")[0]
        return (
            (fit(clean(name), columns) + " ", "strong" if ink == "warn" else "text"),
            (fit(clean(how), width - columns - 2) + " ", ink),
        )


def _fitting(facts: Sequence[Fact], width: int) -> list[str]:
    """Return each fact in its longest words of at most `width` cells, or in its shortest."""
    chosen = []
    for fact in filter(None, facts):
        ways = [clean(way) for way in ((fact,) if isinstance(fact, str) else fact)]
        chosen.append(next((way for way in ways if cell_len(way) <= width), ways[-1]))
    return chosen
