"""The frame: global keys, help, home, pictures, small windows, and exits."""

from __future__ import annotations

import os
import signal
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from syrupy.assertion import SnapshotAssertion
from textual.app import ComposeResult
from textual.css.query import NoMatches
from textual.theme import Theme
from textual.widgets import Input, Label

from tangy_tui.app.teacher_profile import change_theme, read_profile
from tangy_tui.ui.app import TangyApp
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.messages import Stop
from tangy_tui.ui.screens.help import HelpScreen
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.terminal import TerminalKind
from tangy_tui.ui.themes import ANSI, DARK, LIGHT, THEMES, first_theme
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.transcript import Transcript
from tests.support.gallery import GalleryScreen

if TYPE_CHECKING:
    from tests.pilot.conftest import Run

SMALL = (80, 24)
LARGE = (160, 45)


STATES = {"teach": "2 demonstrations, 1 unfinished", "play": "learn first"}


class Plain(TangyScreen[None]):
    """A screen that records its messages."""

    TITLE = "Plain"
    HELP = "A plain screen."
    BINDINGS = [("x", "mark", "Make a mark")]  # noqa: RUF012 - as Textual has it

    def __init__(self) -> None:
        super().__init__()
        self.stops: list[str] = []
        self.marks = 0

    def compose(self) -> ComposeResult:
        yield Label("plain")
        yield Transcript()

    def on_stop(self, message: Stop) -> None:
        self.stops.append(message.reason)

    def action_mark(self) -> None:
        self.marks += 1


class Late(TangyScreen[None]):
    """A screen that is still being laid out when the program ends."""

    TITLE = "Late"
    HELP = "A late screen."

    def compose(self) -> ComposeResult:
        self.app.exit()
        yield Label("late")

    def on_mount(self) -> None:
        self.query_one(Label).update("on time")


def app_of(pilot: Any) -> TangyApp:
    app = pilot.app
    assert isinstance(app, TangyApp)
    return app


# ------------------------------------------------------------------------------------ STOP


async def test_stop_reaches_every_screen_from_everywhere(run: Run) -> None:
    screen = Plain()
    async with run(screen) as pilot:
        await pilot.press("ctrl+x")
        await pilot.pause()
        await pilot.app.push_screen(ConfirmDialog("Sure?"))
        await pilot.press("ctrl+x")
        await pilot.pause()
        assert screen.stops == ["ctrl+x was pressed"] * 2
        assert pilot.app.screen is screen  # the dialog took it for a no


async def test_stop_works_while_a_command_is_typed(run: Run) -> None:
    class Typing(Plain):
        AUTO_FOCUS = "#command-input"

        def compose(self) -> ComposeResult:
            yield CommandBar()

    screen = Typing()
    async with run(screen) as pilot:
        pilot.type(*"call", "ctrl+x")
        await pilot.pause()
        assert len(screen.stops) == 1
        assert screen.query_one(CommandBar).text == "call"


# --------------------------------------------------------------------------------- leaving


async def test_ctrl_c_stops_and_quits(run: Run) -> None:
    screen = Plain()
    async with run(screen) as pilot:
        await pilot.press("ctrl+c")
        await pilot.pause()
        assert screen.stops == ["the program ends"]
        assert pilot.app.return_code == 0
        assert not pilot.app.is_running


async def test_quitting_waits_until_every_screen_has_handled_the_stop(run: Run) -> None:
    order: list[str] = []

    class Slow(Plain):
        async def on_stop(self, message: Stop) -> None:  # type: ignore[override]
            order.append("stopped")

    class App(TangyApp):
        def exit(self, *args: Any, **options: Any) -> None:
            order.append("exit")
            super().exit(*args, **options)

    app = App(Slow)
    async with run(app=app):
        await app.push_screen(Slow())
        app.leave(3)
        app.leave(4)
    assert order == ["stopped", "stopped", "exit"]
    assert app.return_code == 3


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGTERM, 143), (signal.SIGHUP, 129)], ids=["TERM", "HUP"]
)
async def test_signals_end_the_program_cleanly(run: Run, number: int, code: int) -> None:
    screen = Plain()
    async with run(screen) as pilot:
        os.kill(os.getpid(), number)
        await pilot.pause()
        await pilot.pause()
    assert pilot.app.return_code == code
    assert screen.stops == [f"{signal.Signals(number).name} was received"]


# --------------------------------------------------------------------------- small windows


async def test_a_small_window_is_covered_until_it_grows(run: Run) -> None:
    screen = Plain()
    async with run(screen) as pilot:
        screen.query_one(Transcript).focus()
        await pilot.resize_terminal(40, 10)
        await pilot.pause()
        text = " ".join(pilot.text().split())
        assert text == (
            "Tangy needs 60 x 18 characters; this window has 40 x 10. "
            "Make it larger: nothing is lost."
        )
        await pilot.press("x")  # nobody can act on an invisible question
        assert screen.marks == 0
        await pilot.press("ctrl+x")
        await pilot.pause()
        assert len(screen.stops) == 1
        await pilot.resize_terminal(50, 12)
        await pilot.pause()
        assert "has 50 x 12" in " ".join(pilot.text().split())
        await pilot.resize_terminal(80, 24)
        await pilot.pause()
        assert "plain" in pilot.text()
        assert "Tangy needs" not in pilot.text()
        assert isinstance(screen.focused, Transcript)
        await pilot.press("x")
        assert screen.marks == 1


async def test_a_covered_question_cannot_be_answered(run: Run) -> None:
    async with run(Plain(), (40, 10)) as pilot:
        answers: list[bool | None] = []
        await pilot.app.push_screen(ConfirmDialog("Sure?"), answers.append)
        await pilot.pause()
        assert "Tangy needs" in pilot.text()
        await pilot.press("y")
        assert answers == []
        await pilot.resize_terminal(80, 24)
        await pilot.pause()
        assert "Sure?" in pilot.text()
        await pilot.press("y")
        await pilot.pause()
        assert answers == [True]


# ------------------------------------------------------------------------------ help, home


async def test_help_knows_screen_widget_and_keys(run: Run) -> None:
    screen = Plain()
    async with run(screen) as pilot:
        screen.query_one(Transcript).focus()
        await pilot.press("question_mark")
        await pilot.pause()
        text = pilot.text()
        for words in ("Plain · Steps", "A plain screen.", "The steps of", "Make a mark", "STOP"):
            assert words in text
        await pilot.press("question_mark")
        await pilot.pause()
        assert pilot.app.screen is screen
        await pilot.press("f1", "f1")
        await pilot.pause()
        assert pilot.app.screen is screen


async def test_help_over_a_question_explains_the_question(run: Run) -> None:
    async with run(Plain()) as pilot:
        dialog = ConfirmDialog("Sure?")
        await pilot.app.push_screen(dialog)
        await pilot.press("f1")
        await pilot.pause()
        assert "Press y for yes" in pilot.text()
        await pilot.press("y", "escape")
        await pilot.pause()
        assert pilot.app.screen is dialog


class Homely(TangyApp):
    """Records the choices at home."""

    def __init__(self) -> None:
        super().__init__(lambda: HomeScreen(lambda: STATES), clock=lambda: 0.0)
        self.chosen: list[str] = []

    def on_home_screen_chosen(self, event: HomeScreen.Chosen) -> None:
        self.chosen.append(event.id)


async def test_home_items_are_chosen_by_letter_arrows_and_mouse(run: Run) -> None:
    app = Homely()
    async with run(app=app) as pilot:
        for letter in "tilpoed":
            await pilot.press(letter, "enter")
        words = ["teach", "library", "learn", "play", "policy", "people", "demo"]
        assert app.chosen == words
        await pilot.press(*["down"] * 4, "enter")  # name, help, quit, and round to the first
        assert app.chosen[-1] == "teach"
        await pilot.press("up", "up", "up", "k", "enter")
        assert app.chosen[-1] == "demo"
        await pilot.click("#home", offset=(6, 6))
        assert app.chosen[-1] == "library"
        await pilot.press("h", "enter")
        await pilot.pause()
        assert isinstance(app.screen, HelpScreen)
        await pilot.press("escape")
        await pilot.pause()
        await pilot.press("q", "enter")
        await pilot.pause()
        assert not app.is_running


async def test_home_refreshes_its_states_each_time_it_is_shown(run: Run) -> None:
    count = 0

    def states() -> dict[str, str]:
        nonlocal count
        count += 1
        return {"teach": f"looked {count} times"}

    async with run(HomeScreen(states)) as pilot:
        seen = count
        assert f"looked {seen} times" in pilot.text()
        await pilot.app.push_screen(Plain())
        await pilot.press("escape")
        await pilot.pause()
        assert count == seen + 1
        assert f"looked {count} times" in pilot.text()


@pytest.mark.parametrize("size", [(60, 18), SMALL, LARGE])
async def test_home_matches_its_snapshot(
    run: Run, snapshot: SnapshotAssertion, size: tuple[int, int]
) -> None:
    async with run(HomeScreen(lambda: STATES, note="Bingo"), size) as pilot:
        assert pilot.text() == snapshot


# -------------------------------------------------------------------- pictures and the rest


async def test_s_saves_a_picture_and_shows_its_path(run: Run, tmp_path: Path) -> None:
    app = TangyApp(Plain, pictures=tmp_path / "new", clock=lambda: 0.0)
    async with run(app=app, notifications=True) as pilot:
        await pilot.press("s")
        await pilot.pause()
        (picture,) = (tmp_path / "new").glob("tangy-*.svg")
        assert "<svg" in picture.read_text(encoding="utf-8")
        assert "Saved" in pilot.text()


async def test_a_failed_picture_is_reported(run: Run, tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("not a folder")
    app = TangyApp(Plain, pictures=blocked, clock=lambda: 0.0)
    async with run(app=app, notifications=True) as pilot:
        await pilot.press("s")
        await pilot.pause()
        assert "could not be saved" in " ".join(pilot.text().split())


async def test_m_switches_the_mouse_off_and_on(run: Run) -> None:
    async with run(Plain()) as pilot:
        assert app_of(pilot).mouse
        await pilot.press("m")
        assert not app_of(pilot).mouse
        await pilot.press("m")
        assert app_of(pilot).mouse


def test_the_driver_still_has_the_methods_for_the_mouse() -> None:
    """Textual keeps these private: the test fails if a release changes them."""
    from textual.drivers.linux_driver import LinuxDriver

    assert callable(LinuxDriver._enable_mouse_support)
    assert callable(LinuxDriver._disable_mouse_support)


@pytest.mark.slow
async def test_plus_enlarges_the_focused_panel(run: Run) -> None:
    screen = GalleryScreen()
    async with run(screen, LARGE) as pilot:
        screen.transcript.focus()
        await pilot.press("plus")
        await pilot.pause()
        assert screen.maximized is screen.transcript
        await pilot.press("escape")
        await pilot.pause()
        assert screen.maximized is None


@pytest.mark.slow
async def test_the_palette_offers_the_keys_of_the_screen_and_does_not_blink(run: Run) -> None:
    screen = Plain()
    async with run(screen) as pilot:
        await pilot.press("ctrl+p")
        await pilot.pause()
        assert not any(line.cursor_blink for line in pilot.app.screen.query(Input))
        await pilot.press(*"make a mark")
        await pilot.app.workers.wait_for_complete()
        await pilot.pause()
        assert "Make a mark" in pilot.text()
        await pilot.press("enter")
        await pilot.pause()
        assert screen.marks == 1


async def test_css_of_the_first_screen_is_loaded(run: Run) -> None:
    class Styled(Plain):
        CSS = "Styled Label { height: 5; }"

    screen = Styled()
    async with run(screen):
        assert screen.query_one(Label).size.height == 5


# --------------------------------------------------------------------------------- colours


def luminance(colour: str) -> float:
    """Return the relative luminance of WCAG 2."""
    parts = (int(colour[n : n + 2], 16) / 255 for n in (1, 3, 5))
    linear = [p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    """Return the contrast of WCAG 2, from 1 to 21."""
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("theme", [DARK, LIGHT], ids=lambda t: t.name)
def test_text_has_enough_contrast(theme: Any) -> None:
    inks = theme.variables
    written = [theme.foreground, theme.accent, theme.success, theme.warning, theme.error]
    written += [theme.primary, inks["ink-dim"], inks["ink-person"], inks["ink-table"]]
    for ink in written:
        assert contrast(ink, theme.background) >= 4.5
        assert contrast(ink, theme.panel) >= 4.5
    for mark in ("ink-now", "ink-cursor"):
        assert contrast(theme.foreground, inks[mark]) >= 7


@pytest.mark.slow
@pytest.mark.parametrize("theme", [t.name for t in THEMES] + ["textual-dark", "nord", "ansi-dark"])
async def test_every_theme_draws_the_gallery(run: Run, theme: str) -> None:
    async with run(GalleryScreen(), LARGE) as pilot:
        app_of(pilot).ansi_color = None
        pilot.app.theme = theme
        await pilot.pause()
        assert "What works with whom" in pilot.text()


@pytest.mark.parametrize(
    ("chosen", "ansi", "begins"),
    [
        ("", False, DARK),
        (LIGHT.name, False, LIGHT),
        ("from a later version", False, DARK),
        (LIGHT.name, True, ANSI),
    ],
)
def test_the_chosen_theme_is_restored_if_the_terminal_supports_it(
    chosen: str, ansi: bool, begins: Theme
) -> None:
    assert first_theme(chosen, ansi=ansi) == begins.name


async def test_a_theme_chosen_in_the_palette_is_stored(run: Run, tmp_path: Path) -> None:
    keep = partial(change_theme, tmp_path)
    async with run(app=TangyApp(theme=DARK.name, keep_theme=keep)) as pilot:
        (light,) = (
            command
            for command in pilot.app.get_system_commands(pilot.app.screen)
            if command.title == "Colours: light theme"
        )
        light.callback()
        assert pilot.app.theme == LIGHT.name
    assert TangyApp(theme=read_profile(tmp_path).theme).theme == LIGHT.name


async def test_ansi_mode_uses_only_the_colours_of_the_terminal(run: Run) -> None:
    async with run(GalleryScreen(), LARGE, kind=TerminalKind(ansi=True)) as pilot:
        assert pilot.app.theme == ANSI.name
        for strip in pilot.app.screen._compositor.render_strips():
            for segment in strip:
                style = segment.style
                for colour in (style.color, style.bgcolor) if style else ():
                    assert colour is None or colour.triplet is None


async def test_no_color_removes_colours_and_keeps_marks(
    run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NO_COLOR", "1")
    async with run(GalleryScreen(), LARGE, kind=TerminalKind(ansi=True)) as pilot:
        for strip in pilot.app.screen._compositor.render_strips():
            for segment in strip:
                style = segment.style
                for colour in (style.color, style.bgcolor) if style else ():
                    assert colour is None or colour.is_default
        text = pilot.text()
        for mark in ("?1", "★", "✗ ", "! ", "^x STOP"):
            assert mark in text


@pytest.mark.slow
@pytest.mark.parametrize("size", [SMALL, LARGE])
async def test_the_gallery_matches_its_pictures(
    run: Run, picture: Any, size: tuple[int, int]
) -> None:
    async with run(GalleryScreen(), size) as pilot:
        picture(pilot.app)


@pytest.mark.slow
async def test_the_gallery_survives_any_size(run: Run) -> None:
    async with run(GalleryScreen(8), LARGE) as pilot:
        await pilot.press("escape", "d")
        for size in ((1, 1), (5, 60), (300, 3), (60, 18), (59, 18), (237, 71), SMALL):
            await pilot.resize_terminal(*size)
            await pilot.pause()
        await pilot.press("escape")
        await pilot.pause()
        assert "Steps" in pilot.text()


async def test_a_screen_mounted_during_the_exit_raises_no_error(run: Run) -> None:
    async with run(Plain()) as pilot:
        await pilot.app.push_screen(Late())
    assert pilot.app.return_code == 0


async def test_an_error_of_a_screen_is_never_hidden(run: Run) -> None:
    class Wrong(Plain):
        def on_mount(self) -> None:
            self.query_one(Input)

    with pytest.raises(NoMatches):
        async with run(Plain()) as pilot:
            await pilot.app.push_screen(Wrong())
