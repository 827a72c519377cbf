"""Output cleaning: no control sequence reaches the terminal, and ASCII mode writes only ASCII."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.cells import cell_len
from rich.segment import Segment
from textual.app import ComposeResult
from textual.color import Color
from textual.widgets import Label

from tangy_profiles.person import Person
from tangy_profiles.scene import Scene
from tangy_profiles.state import FRONT
from tangy_tui.ui.app import TangyApp
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.clean_output import OBEYED, CleanOutput, clean, harmless, to_ascii
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.dialogs.question import QuestionDialog
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.terminal import TerminalKind
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.policy_table import PolicyRow, PolicyTable
from tangy_tui.ui.widgets.posteriors import Posteriors
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.status_line import Status, StatusLine
from tangy_tui.ui.widgets.transcript import Transcript
from tests.support.gallery import GalleryScreen

if TYPE_CHECKING:
    from tests.pilot.conftest import Run, Sample

SMALL = (80, 24)
LARGE = (160, 45)


NASTY = (
    "[/]",
    "[@click=app.quit]x[/]",
    "\x1b]0;owned\x07\x1b[2J",
    "\x9b31mred\x7f",
    "\u202egnirts\u2066\u200b\u200d\ufeff",
    "tab\tnew\nline",
)
FORBIDDEN = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f\u200b-\u200f\u2028-\u202e\u2060-\u2069\ufeff]")


def test_clean_leaves_one_visible_line() -> None:
    assert clean("Zo\N{COMBINING DIAERESIS}e") == "Zöe".replace("ë", "e")
    assert clean("a\x1b[2Jb") == "a\ufffd[2Jb"
    assert clean("two\nlines\tand a tab") == "two lines and a tab"
    assert clean("\u202eabc") == "\ufffdabc"
    assert clean("[/]") == "[/]"


@given(st.text(max_size=40), st.booleans())
def test_drawn_text_is_harmless_and_keeps_its_width(text: str, ascii: bool) -> None:
    drawn = harmless(text, ascii)
    assert cell_len(drawn) == cell_len(text)
    assert not OBEYED.search(drawn)
    assert not ascii or drawn.isascii()


@given(st.text(max_size=40))
def test_cleaning_is_idempotent(text: str) -> None:
    assert clean(clean(text)) == clean(text)
    assert not FORBIDDEN.search(clean(text))


def test_ascii_has_a_stand_in_for_every_shape() -> None:
    shapes = "─│╭╮╰╯━┃┏┓┗┛▁▂▃▄▅▆▇█▏▎▍▌▋▊▉▸◂▴▾●★✓✗·…“”‘’"  # noqa: RUF001 - what widgets draw
    assert "?" not in to_ascii(shapes)
    assert to_ascii("Zoë Müller") == "Zoe Muller"
    assert to_ascii("\N{CJK UNIFIED IDEOGRAPH-6F22}") == "??"


def test_the_filter_is_in_the_apps_private_list_of_filters() -> None:
    """`App._filters` is private: the test fails if a Textual release changes it."""
    app = TangyApp()
    assert isinstance(app._filters[-1], CleanOutput)
    assert app._filters[-1] in app.get_line_filters()
    segments = app._filters[-1].apply([Segment("a\x1b[31mb\x9b")], Color(0, 0, 0))
    assert [s.text for s in segments] == ["a[31mb"]


class Unclean(TangyScreen[None]):
    """A screen whose widget does not clean its output."""

    def compose(self) -> ComposeResult:
        yield Label("ab\x1b[31m\u202ec", markup=False)


async def test_the_filter_cleans_the_output_of_every_widget(run: Run) -> None:
    async with run(Unclean()) as pilot:
        assert not FORBIDDEN.search(pilot.text())


class AllNasty(TangyScreen[None]):
    """Every widget with one nasty text in each place that shows data."""

    def __init__(self, sample: Sample, text: str) -> None:
        super().__init__()
        self.people = tuple(Person(p.id, text) for p in sample.people)
        self.sample = sample
        self.text = text

    def compose(self) -> ComposeResult:
        text = self.text
        yield StatusLine(Status(text, text, text, 1, 2, text, alarm=True))
        yield RoomView(
            self.sample.room, self.people, robot=text, label=lambda n: text, classes="panel"
        )
        yield Transcript(empty=text, classes="panel")
        yield PolicyTable(empty=text, classes="panel")
        yield Posteriors(classes="panel")
        yield LogView(classes="panel")
        yield CommandBar(lambda typed: (text, typed + text))

    def on_mount(self) -> None:
        text = self.text
        ids = [p.id for p in self.people]
        room = self.query_one(RoomView)
        room.show(Scene(FRONT, tuple(ids), dict.fromkeys(ids, text), (1, 2), None))
        room.say(text)
        for _ in range(3):
            self.query_one(Transcript).append(text)
        self.query_one(PolicyTable).show([PolicyRow(text, text, 0.5, 3, text)], text)
        beliefs = self.sample.beliefs()
        self.query_one(Posteriors).show(beliefs, dict.fromkeys(ids, text))
        self.query_one(LogView).write(text)


@pytest.mark.slow
@pytest.mark.parametrize("text", NASTY)
@pytest.mark.parametrize("size", [SMALL, LARGE])
async def test_data_is_harmless_in_every_widget(
    run: Run, sample: Sample, text: str, size: tuple[int, int]
) -> None:
    async with run(AllNasty(sample, text), size) as pilot:
        assert not FORBIDDEN.search(pilot.text())
        await pilot.press("a")
        pilot.app.screen.query_one(CommandBar).restore(text)
        await pilot.pause()
        assert not FORBIDDEN.search(pilot.text())
        for dialog in (
            QuestionDialog(text, heard=text, confidence=0.5, alternatives=(text,) * 4),
            ConfirmDialog(text, text, yes=text, no=text),
            MessageDialog(text, text),
        ):
            await pilot.app.push_screen(dialog)
            await pilot.pause()
            assert not FORBIDDEN.search(pilot.text())
            pilot.app.pop_screen()
        assert isinstance(pilot.app, TangyApp)
        pilot.app.say(text)
        await pilot.pause()
        assert pilot.app.is_running


async def test_home_shows_data_harmlessly(run: Run) -> None:
    async with run(HomeScreen(lambda: {"teach": NASTY[1], "play": NASTY[2]}, note="[/]")) as pilot:
        assert "[@click=app.quit]x[/]" in pilot.text()
        assert not FORBIDDEN.search(pilot.text())


async def test_a_paste_is_cleaned(run: Run) -> None:
    class Bar(TangyScreen[None]):
        AUTO_FOCUS = "#command-input"

        def compose(self) -> ComposeResult:
            yield CommandBar()

    async with run(Bar()) as pilot:
        from textual import events

        pilot.app.post_message(events.Paste("call\x1b[31m number\u202e\nquit\n"))
        await pilot.pause()
        assert pilot.app.screen.query_one(CommandBar).text == "call\ufffd[31m number\ufffd"


@pytest.mark.slow
@pytest.mark.parametrize("size", [(60, 18), SMALL, LARGE])
@pytest.mark.parametrize("people", [1, 4, 8])
async def test_ascii_mode_draws_only_ascii(run: Run, size: tuple[int, int], people: int) -> None:
    kind = TerminalKind(ascii=True)
    async with run(GalleryScreen(people), size, kind=kind, notifications=True) as pilot:

        async def only_ascii() -> None:
            await pilot.pause()
            odd = {c for c in pilot.text() if not c.isascii()}
            assert not odd

        await only_ascii()
        await pilot.press("g", "r")
        await only_ascii()
        await pilot.press("escape")
        for key in ("d", "f1", "ctrl+p"):
            await pilot.press(key)
            await only_ascii()
            pilot.type("escape")
            await pilot.pause()
        app: Any = pilot.app
        app.say("“…”")
        await only_ascii()
