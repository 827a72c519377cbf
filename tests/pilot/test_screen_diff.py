"""Differential updates: only changes are written, and the terminal shows the same screen."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pyte
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console
from rich.segment import Segment
from rich.style import Style
from textual._compositor import ChopsUpdate, LayoutUpdate
from textual.geometry import Region
from textual.strip import Strip

from tangy_tui.app.workspace import Workspace
from tangy_tui.ui.app import TangyApp
from tangy_tui.ui.screen_diff import ScreenDiff
from tests.pilot.conftest import Run
from tests.pilot.test_screens_teach import program
from tests.support.laws import tried

WIDTH, HEIGHT = 24, 5


class Terminal:
    """A terminal in memory."""

    def __init__(self, width: int, height: int) -> None:
        self.screen = pyte.Screen(width, height)
        self._stream = pyte.Stream(self.screen)

    def write(self, text: str) -> None:
        """Show the written output."""
        self._stream.feed(text.replace("\n", "\r\n"))

    def cells(self) -> list[list[Any]]:
        """Return every cell with its visible colours and attributes."""
        columns, lines = self.screen.columns, self.screen.lines
        return [[visible(self.screen.buffer[y][x]) for x in range(columns)] for y in range(lines)]


def visible(cell: Any) -> Any:
    """Leave out the ink of a blank cell."""
    if cell.data == " " and not (cell.reverse or cell.underscore or cell.strikethrough):
        return cell._replace(fg="", bold=False, italics=False, blink=False)
    return cell


TEXTS = st.text("ab  ─é世🙂", min_size=1, max_size=8)
COLOURS = st.sampled_from(
    [None, "default", "red", "bright_blue", "#102030", "#a0b0c0", "color(99)"]
)
STYLES = st.builds(
    lambda ink, paper, bold, dim, reverse, underline: Style(
        color=ink, bgcolor=paper, bold=bold, dim=dim, reverse=reverse, underline=underline
    ),
    COLOURS,
    COLOURS,
    st.booleans(),
    st.booleans(),
    st.booleans(),
    st.booleans(),
)
LINES = st.lists(
    st.builds(lambda text, style: Segment(text, style), TEXTS, st.one_of(st.none(), STYLES)),
    min_size=1,
    max_size=6,
)


@st.composite
def updates(draw: st.DrawFn) -> LayoutUpdate:
    """Draw segments of lines anywhere on the screen."""
    x = draw(st.integers(0, WIDTH - 4))
    y = draw(st.integers(0, HEIGHT - 1))
    width = draw(st.integers(3, WIDTH - x))
    lines = draw(st.lists(LINES, min_size=1, max_size=HEIGHT - y))
    strips: list[Iterable[Strip]] = [[Strip(line).adjust_cell_length(width)] for line in lines]
    return LayoutUpdate(strips, Region(x, y, width, len(strips)))


@pytest.mark.slow
@tried(300)
@given(st.lists(updates(), min_size=1, max_size=6))
def test_differential_updates_show_the_same_as_full_updates(
    drawn: list[LayoutUpdate],
) -> None:
    console = Console(color_system="truecolor", force_terminal=True)
    whole, changed, diff = Terminal(WIDTH, HEIGHT), Terminal(WIDTH, HEIGHT), ScreenDiff()
    for update in drawn:
        whole.write(update.render_segments(console))
        change = diff.difference(update, console)
        changed.write(change)
        for row in range(HEIGHT):
            assert shown(changed, row) == shown(whole, row)
        assert diff.difference(update, console) == ""


def shown(terminal: Terminal, row: int) -> list[Any]:
    """Return a row without halves of wide characters whose other half was overwritten."""
    cells = terminal.cells()[row]
    wide = [len(cell.data.encode()) > 2 and cell.data != "─" for cell in cells]
    return [
        None if not cell.data or (wide[x] and (x + 1 == len(cells) or cells[x + 1].data)) else cell
        for x, cell in enumerate(cells)
    ]


def test_a_part_of_a_line_is_written_at_its_place() -> None:
    console = Console(color_system="truecolor", force_terminal=True)
    whole, changed, diff = Terminal(WIDTH, HEIGHT), Terminal(WIDTH, HEIGHT), ScreenDiff()
    first = [{0: Strip([Segment("one two ")]), 8: Strip([Segment("three four")])}]
    second = [{0: Strip([Segment("one six ")]), 8: Strip([Segment("three five")])}]
    for chops, span in ((first, (0, 0, 18)), (second, (0, 4, 18)), (first, (0, 9, 14))):
        update = ChopsUpdate(chops, [span], [[8, 18]])
        whole.write(update.render_segments(console))
        changed.write(diff.difference(update, console))
        assert changed.cells() == whole.cells()


def test_a_reset_writes_everything_again() -> None:
    console, diff = Console(color_system="truecolor", force_terminal=True), ScreenDiff()
    update = LayoutUpdate([[Strip([Segment("again")])]], Region(0, 0, 5, 1))
    once = diff.difference(update, console)
    assert "again" in once
    assert diff.difference(update, console) == ""
    diff.forget()
    assert diff.difference(update, console) == once


def test_an_omitted_colour_equals_the_default_colour() -> None:
    console, terminal = Console(color_system="standard", force_terminal=True), Terminal(WIDTH, 1)
    left_out = Segment("one", Style(reverse=True))
    default = Segment("two", Style(reverse=True, color="default", bgcolor="default"))
    update = LayoutUpdate([[Strip([left_out, default])]], Region(0, 0, 6, 1))
    terminal.write(ScreenDiff().difference(update, console))
    assert [cell.reverse for cell in terminal.screen.buffer[0].values()] == [True] * 6


def test_one_changed_letter_costs_a_move_and_a_letter() -> None:
    console, diff = Console(color_system="truecolor", force_terminal=True), ScreenDiff()
    ink = Style(color="#102030", bgcolor="#a0b0c0")

    def line(text: str) -> LayoutUpdate:
        return LayoutUpdate([[Strip([Segment(text, ink)])]], Region(0, 3, len(text), 1))

    diff.difference(line("I call B-7 now"), console)
    change = diff.difference(line("I call B-9 now"), console)
    assert change == "\x1b[4;10H\x1b[38;2;16;32;48;48;2;160;176;192m9\x1b[m"


@pytest.mark.slow
@pytest.mark.parametrize("size", [(80, 24), (120, 40)])
async def test_a_taught_game_looks_the_same_with_differential_updates(
    run: Run, workspace: Workspace, monkeypatch: pytest.MonkeyPatch, size: tuple[int, int]
) -> None:
    whole, changed, diff = Terminal(*size), Terminal(*size), ScreenDiff()
    written = {"whole": 0, "changed": 0}
    differ: list[str] = []
    display = TangyApp._display

    def both(app: TangyApp, screen: Any, update: Any) -> None:
        if isinstance(update, LayoutUpdate | ChopsUpdate):
            everything = update.render_segments(app.console)
            change = diff.difference(update, app.console)
            written["whole"] += len(everything)
            written["changed"] += len(change)
            whole.write(everything)
            changed.write(change)
            if whole.cells() != changed.cells():
                differ.append(app.screen.__class__.__name__)
        display(app, screen, update)

    monkeypatch.setattr(TangyApp, "_display", both)
    async with run(app=program(workspace), size=size) as pilot:
        for keys in ("greet everyone", "call number", "call it again", "tell a joke"):
            await pilot.press(*keys, "enter")
            await pilot.pause()
            await pilot.press("y")
            await pilot.pause()
        for key in ("f1", "escape", "ctrl+z", "ctrl+y", "escape", "l", "down", "escape", "ctrl+p"):
            await pilot.press(key)
            await pilot.pause()
    assert differ == []
    assert written["changed"] * 3 < written["whole"]
