"""The command bar: completion, history, and keys typed ahead."""

from __future__ import annotations

from time import monotonic
from typing import TYPE_CHECKING

from textual.app import ComposeResult
from textual.widgets import Label

from tangy_tui.text.teaching_commands import NOTHING_FITS
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.command_input import LONGEST, CommandInput
from tangy_tui.ui.widgets.command_matches import Complete

if TYPE_CHECKING:
    from tests.pilot.conftest import Run, TangyPilot


def monotonic_later() -> float:
    """Return a time after that of each key, so that no key comes late."""
    return monotonic() + 60


PHRASES = ("call number", "call a number", "call the next number", "celebrate", "greet everyone")
NOW = ("celebrate", "call number")


def begins(typed: str) -> tuple[str, ...]:
    return tuple(phrase for phrase in PHRASES if phrase.startswith(typed.lower()))


class Bar(TangyScreen[None]):
    """A command bar that records its commands."""

    AUTO_FOCUS = "#command-input"
    BINDINGS = [("u", "undo", "Undo"), ("escape", "back", "Back")]  # noqa: RUF012 - as Textual has it

    def __init__(self, complete: Complete = begins) -> None:
        super().__init__()
        self.complete = complete
        self.given: list[str] = []
        self.undone = 0
        self.left = 0

    def compose(self) -> ComposeResult:
        yield Label("room")
        yield CommandBar(self.complete, sayable=lambda: NOW)

    def on_command_bar_given(self, event: CommandBar.Given) -> None:
        self.given.append(event.text)

    def action_undo(self) -> None:
        self.undone += 1

    def action_back(self) -> None:
        self.left += 1


def bar_of(pilot: TangyPilot) -> CommandBar:
    return pilot.app.screen.query_one(CommandBar)


async def test_a_command_is_stripped_of_spaces(run: Run) -> None:
    screen = Bar()
    async with run(screen) as pilot:
        pilot.type(*"  call number ", "enter")
        await pilot.pause()
        assert screen.given == ["call number"]
        assert bar_of(pilot).text == ""
        bar_of(pilot).ready()
        pilot.type(*"   ", "enter")
        await pilot.pause()
        assert screen.given == ["call number"]


async def test_the_bar_is_closed_until_the_command_is_handled(run: Run) -> None:
    screen = Bar()
    async with run(screen) as pilot:
        pilot.type(*"call number", "enter", *"yu", "enter", "escape")
        await pilot.pause()
        assert bar_of(pilot).closed
        assert (screen.given, screen.undone, screen.left) == (["call number"], 0, 0)
        assert bar_of(pilot).text == ""
        bar_of(pilot).restore("call number")
        await pilot.press("s")
        assert bar_of(pilot).text == "s"


async def test_the_bar_reopens_after_a_timeout(run: Run) -> None:
    async with run(Bar()) as pilot:
        pilot.type(*"call number", "enter")
        await pilot.pause()
        timer = bar_of(pilot).reopening
        assert timer is not None
        bar_of(pilot).ready()  # the timer's callback
        await pilot.press("g")
        assert bar_of(pilot).text == "g"


async def test_simultaneous_keys_keep_their_order(run: Run) -> None:
    async with run(Bar()) as pilot:
        pilot.type(*"ab", "backspace", *"cd", "left", "x", "home", "y", "end", "z")
        await pilot.pause()
        assert bar_of(pilot).text == "yacxdz"


async def test_matches_are_listed_and_the_first_is_completed(run: Run) -> None:
    async with run(Bar()) as pilot:
        await pilot.press("c", "a")
        await pilot.pause()
        text = pilot.text()
        assert "call number   call a number   call the next number" in text
        assert "celebrate" not in text
        await pilot.press("tab")
        assert bar_of(pilot).text == "call number"
        await pilot.press("ctrl+u", "g", "r")
        await pilot.pause()
        await pilot.press("right")
        assert bar_of(pilot).text == "greet everyone"


async def test_tab_reports_that_nothing_fits(run: Run) -> None:
    async with run(Bar()) as pilot:
        await pilot.press("x", "tab")
        await pilot.pause()
        assert bar_of(pilot).text == "x" and NOTHING_FITS in pilot.text()
        await pilot.press("backspace", "c")
        await pilot.pause()
        assert bar_of(pilot).text == "c" and NOTHING_FITS not in pilot.text()


async def test_tab_treats_blanks_as_an_empty_line(run: Run) -> None:
    async with run(Bar()) as pilot:
        pilot.type("space", "tab", "tab")
        await pilot.pause()
        assert bar_of(pilot).text == NOW[0]


async def test_tab_completes_paraphrases(run: Run) -> None:
    meant = ("call number", "tell a joke")
    async with run(Bar(lambda typed: meant if typed == "numbers" else ())) as pilot:
        pilot.type(*"numbers", "tab")
        for taken in (*meant, *meant):
            await pilot.pause()
            assert bar_of(pilot).text == taken
            await pilot.press("tab")


async def test_tab_cycles_through_the_possible_commands(run: Run) -> None:
    async with run(Bar()) as pilot:
        for taken in ("", *NOW, *NOW):
            await pilot.press("tab")
            await pilot.pause()
            assert "celebrate   call number" in pilot.text()
            assert bar_of(pilot).text == taken
        await pilot.press("s", "tab")
        await pilot.pause()
        assert bar_of(pilot).text == "call numbers" and "celebrate" not in pilot.text()


async def test_the_list_is_rebuilt_after_a_command(run: Run) -> None:
    async with run(Bar()) as pilot:
        await pilot.press("tab")
        await pilot.pause()
        bar_of(pilot).ready()
        await pilot.pause()
        await pilot.press("tab")
        assert bar_of(pilot).text == ""


async def test_the_history_keeps_the_typed_text(run: Run) -> None:
    async with run(Bar()) as pilot:
        for text in ("one", "two", "two"):
            pilot.type(*text, "enter")
            await pilot.pause()
            bar_of(pilot).ready()
        pilot.type(*"thr", "up")
        await pilot.pause()
        assert bar_of(pilot).text == "two"
        await pilot.press("up", "up")
        assert bar_of(pilot).text == "one"
        await pilot.press("down", "down", "down")
        assert bar_of(pilot).text == "thr"


async def test_escape_empties_the_line_then_leaves_it_and_colon_returns(run: Run) -> None:
    screen = Bar()
    async with run(screen) as pilot:
        await pilot.press("a", "escape")
        assert (bar_of(pilot).text, bar_of(pilot).has_keys) == ("", True)
        await pilot.press("escape", "u")
        assert (screen.undone, screen.left, bar_of(pilot).has_keys) == (1, 0, False)
        await pilot.press("escape")
        assert screen.left == 1
        await pilot.press("colon", "b")
        assert bar_of(pilot).text == "b"
        await pilot.press("colon")
        assert bar_of(pilot).text == "b:"


async def test_a_line_that_escape_emptied_comes_back_with_up(run: Run) -> None:
    async with run(Bar()) as pilot:
        bar_of(pilot).restore("call the next number")
        await pilot.press("escape", "up")
        assert bar_of(pilot).text == "call the next number"


async def test_escape_empties_the_line_of_a_command_that_came_back(run: Run) -> None:
    async with run(Bar()) as pilot:
        bar_of(pilot).restore("flurb")
        await pilot.press("escape")
        assert (bar_of(pilot).text, bar_of(pilot).has_keys) == ("", True)


async def test_escape_closes_the_list_and_stays_in_the_line(run: Run) -> None:
    async with run(Bar()) as pilot:
        await pilot.press("tab")
        await pilot.pause()
        assert bar_of(pilot).lists
        await pilot.press("escape")
        await pilot.pause()
        assert (bar_of(pilot).lists, bar_of(pilot).has_keys) == (False, True)
        assert "celebrate" not in pilot.text()


async def test_question_mark_is_help_in_an_empty_bar_only(run: Run) -> None:
    async with run(Bar()) as pilot:
        await pilot.press("question_mark")
        await pilot.pause()
        assert len(pilot.app.screen_stack) == 2
        assert "arrow completes" in pilot.text()
        await pilot.press("enter")
        await pilot.pause()
        assert len(pilot.app.screen_stack) == 2, "typed as a command, with Enter, it stays"
        await pilot.press("escape")
        await pilot.pause()
        await pilot.press("a", "question_mark")
        assert bar_of(pilot).text == "a?"


async def test_a_command_has_a_maximum_length(run: Run) -> None:
    async with run(Bar()) as pilot:
        bar_of(pilot).restore("x" * 500)
        assert len(bar_of(pilot).text) == LONGEST


async def test_the_cursor_does_not_blink(run: Run) -> None:
    async with run(Bar()) as pilot:
        assert not pilot.app.screen.query_one(CommandInput).cursor_blink


async def test_leaving_the_bar_with_text_shows_the_keys(run: Run) -> None:
    async with run(Bar()) as pilot:
        await pilot.press("c")
        pilot.app.screen.set_focus(None)
        await pilot.pause()
        assert "type a command, or ? for help" in pilot.text()
        await pilot.press("colon")
        await pilot.pause()
        assert "call number   call a number" in pilot.text()


async def test_the_list_of_commands_closes_when_others_apply(run: Run) -> None:
    async with run(Bar()) as pilot:
        await pilot.press("tab", "tab")
        await pilot.pause()
        assert bar_of(pilot).lists
        assert "call number" in pilot.text()
        bar_of(pilot).ready()  # a step was undone by its key
        await pilot.pause()
        assert bar_of(pilot).text == ""
        assert "call number" not in pilot.text()


async def test_a_lone_answer_right_after_a_returned_command_changes_nothing(run: Run) -> None:
    screen = Bar()
    async with run(screen, clock=monotonic_later) as pilot:
        for key in ("y", "n", "Y"):
            bar_of(pilot).restore("celebrate")
            await pilot.press(key)
            assert bar_of(pilot).text == "celebrate"
        await pilot.press("enter")  # and the command is still there
        await pilot.pause()
        assert screen.given == ["celebrate"]


async def test_a_command_that_begins_like_an_answer_keeps_its_letter(run: Run) -> None:
    async with run(Bar(), clock=monotonic_later) as pilot:
        bar_of(pilot).restore("celebrate")
        pilot.type(*"next")
        await pilot.pause()
        assert bar_of(pilot).text == "next"


async def test_a_later_answer_replaces_the_returned_command(run: Run) -> None:
    async with run(Bar()) as pilot:  # its clock stands: the command came back long ago
        bar_of(pilot).restore("celebrate")
        await pilot.press("y")
        assert bar_of(pilot).text == "y"
