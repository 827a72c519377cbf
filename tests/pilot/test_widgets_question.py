"""The question that verifies a command: only a y typed after it appeared counts as yes."""

from __future__ import annotations

import re
from time import monotonic
from typing import TYPE_CHECKING, Any

import pytest
from textual import events
from textual.app import ComposeResult

from tangy_tui.app.terminal_session import TerminalSession
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.dialogs.question import Answer, QuestionDialog
from tangy_tui.ui.round_trip import READING_SECONDS, RoundTrip
from tangy_tui.ui.screens import teach_keys
from tangy_tui.ui.screens.help import help_for
from tangy_tui.ui.widgets.command_bar import CommandBar

if TYPE_CHECKING:
    from tests.pilot.conftest import Run, StillClock, TangyPilot

SMALL = (80, 24)
LARGE = (160, 45)


class Asking(TangyScreen[None]):
    """A command bar that verifies its commands."""

    AUTO_FOCUS = "#command-input"

    def __init__(self, alternatives: tuple[str, ...] = ("tell a joke", "go to the user")) -> None:
        super().__init__()
        self.answers: list[Answer | None] = []
        self.given: list[str] = []
        self.alternatives = alternatives
        self.deleted = 0

    def compose(self) -> ComposeResult:
        yield CommandBar()

    def on_key(self, event: events.Key) -> None:
        """Count keys that should have gone to the bar or to the question."""
        self.deleted += 1

    def on_command_bar_given(self, event: CommandBar.Given) -> None:
        text = event.text
        self.given.append(text)

        def answered(answer: Answer | None) -> None:
            self.answers.append(answer)
            if answer is None or not answer.yes:
                event.bar.restore(text)

        self.app.push_screen(
            QuestionDialog(
                "call number", heard=text, confidence=0.83, alternatives=self.alternatives
            ),
            answered,
        )


def bar_of(pilot: TangyPilot) -> CommandBar:
    return pilot.app.screen_stack[0].query_one(CommandBar)


async def ask(pilot: TangyPilot, text: str = "call number") -> None:
    pilot.type(*text, "enter")
    await pilot.pause()
    await pilot.pause()
    assert isinstance(pilot.app.screen, QuestionDialog)


@pytest.mark.parametrize(
    ("key", "answer", "left"),
    [
        ("y", Answer(True), ""),
        ("Y", Answer(True), ""),
        ("n", Answer(False), "call number"),
        ("N", Answer(False), "call number"),
        ("escape", Answer(False), "call number"),
        ("1", Answer(False, 0), "call number"),
        ("2", Answer(False, 1), "call number"),
    ],
)
async def test_answering_keys_close_the_question(
    run: Run, key: str, answer: Answer, left: str
) -> None:
    screen = Asking()
    async with run(screen) as pilot:
        await ask(pilot)
        await pilot.press(key)
        await pilot.pause()
        assert screen.answers == [answer]
        assert bar_of(pilot).text == left
        assert pilot.app.screen is screen


@pytest.mark.parametrize(
    "key", ["enter", "space", "3", "4", "0", "tab", "up", "x", "ctrl+y", "j", "f5", "backspace"]
)
async def test_other_keys_leave_the_question_open(run: Run, key: str) -> None:
    screen = Asking()
    async with run(screen) as pilot:
        await ask(pilot)
        await pilot.press(key)
        await pilot.pause()
        assert screen.answers == []
        assert isinstance(pilot.app.screen, QuestionDialog)


async def test_a_y_in_the_same_write_as_enter_is_swallowed(run: Run) -> None:
    screen = Asking()
    async with run(screen, clock=monotonic) as pilot:
        pilot.type(*"greet everyone", "enter", "y", "y", "enter")
        await pilot.pause()
        await pilot.pause()
        assert screen.given == ["greet everyone"]
        assert screen.answers == []
        assert isinstance(pilot.app.screen, QuestionDialog)
        assert bar_of(pilot).text == ""
        assert screen.deleted == 0


async def test_keys_of_the_first_moment_do_not_answer(run: Run, clock: StillClock) -> None:
    screen = Asking()
    clock.now = monotonic() + 1000
    async with run(screen, clock=clock) as pilot:
        await ask(pilot)
        for key in ("y", "n", "escape", "1"):
            pilot.type(key, at=clock.now + 0.19)
            await pilot.pause()
        assert screen.answers == []
        pilot.type("y", at=clock.now + 0.21)
        await pilot.pause()
        assert screen.answers == [Answer(True)]


async def test_keys_typed_after_a_number_are_dropped(
    run: Run,
) -> None:
    class AskingAgain(TangyScreen[None]):
        AUTO_FOCUS = "#command-input"

        def __init__(self) -> None:
            super().__init__()
            self.answers: list[Answer | None] = []

        def compose(self) -> ComposeResult:
            yield CommandBar()

        def on_command_bar_given(self, event: CommandBar.Given) -> None:
            def answered(answer: Answer | None) -> None:
                self.answers.append(answer)
                self.app.push_screen(QuestionDialog("tell a joke", clock=monotonic))

            dialog = QuestionDialog("call number", alternatives=("tell a joke",))
            self.app.push_screen(dialog, answered)

    screen = AskingAgain()
    async with run(screen) as pilot:
        await ask(pilot)
        pilot.type("1", "y", "y")
        await pilot.pause()
        await pilot.pause()
        assert screen.answers == [Answer(False, 0)]
        assert isinstance(pilot.app.screen, QuestionDialog)
        assert pilot.app.screen.behaviour == "tell a joke"
        assert bar_of(pilot).text == ""


async def test_only_the_first_answer_counts(run: Run) -> None:
    screen = Asking()
    async with run(screen) as pilot:
        await ask(pilot)
        pilot.type("y", "y", "n")
        await pilot.pause()
        assert screen.answers == [Answer(True)]
        assert pilot.app.screen is screen


async def test_a_rejected_text_can_be_edited_and_given_again(run: Run) -> None:
    screen = Asking()
    async with run(screen) as pilot:
        await ask(pilot)
        await pilot.press("n")
        await pilot.pause()
        await pilot.press("right", "s", "enter")
        await pilot.pause()
        assert screen.given == ["call number", "call numbers"]


async def test_stop_works_inside_the_question_and_answers_no(run: Run) -> None:
    screen = Asking()
    async with run(screen) as pilot:
        await ask(pilot)
        await pilot.press("ctrl+x")
        await pilot.pause()
        assert screen.answers == [Answer(False)]
        assert pilot.app.screen is screen


async def test_the_question_names_behaviour_words_confidence_and_alternatives(run: Run) -> None:
    async with run(Asking(("one", "two", "three", "four"))) as pilot:
        await ask(pilot, "cal numbr")
        text = pilot.text()
        assert "Did you say: call number?" in text
        assert "cal numbr" in text
        assert "83% sure" in text
        assert "3 three" in text
        assert "four" not in text


@pytest.mark.parametrize("size", [(60, 18), SMALL, LARGE])
async def test_the_longest_question_fits(run: Run, size: tuple[int, int]) -> None:
    async with run(size=size) as pilot:
        dialog = QuestionDialog(
            "ask to move the card closer",
            heard="please " * 30,
            confidence=0.5,
            alternatives=("go to the user with the longest name of all of them here", "b", "c"),
        )
        await pilot.app.push_screen(dialog)
        await pilot.pause()
        box = dialog.query_one(".box")
        assert box.region.bottom <= size[1]
        lines = pilot.text().splitlines()
        last = next(n for n, line in enumerate(lines) if "3 c" in line)
        assert last < box.region.bottom


class FakeTerminal:
    """A terminal that records queries and answers on demand."""

    def __init__(self, pilot: TangyPilot, session: TerminalSession, **settings: Any) -> None:
        self.written: list[str] = []
        app: Any = pilot.app
        self.trip = RoundTrip(self.written.append, lambda: session, app.clock, **settings)
        app.round_trip = self.trip
        self.trip.begin((80, 24))

    def answer(self, time: float) -> None:
        """Answer the last query, at this time."""
        place = re.search(r"\[(\d+);(\d+)H\x1b\[6n", self.written[-1])
        assert place is not None
        self.trip.reported(int(place[2]) - 1, int(place[1]) - 1, time)


async def test_a_y_counts_only_after_the_terminal_has_answered(run: Run, clock: StillClock) -> None:
    screen = Asking()
    async with run(screen, clock=clock) as pilot:
        terminal = FakeTerminal(pilot, TerminalSession(remote=True))
        terminal.answer(monotonic())
        await ask(pilot)
        await pilot.press("y")
        await pilot.pause()
        assert screen.answers == []
        assert "Too early: please answer again." in pilot.text()
        terminal.answer(monotonic() - READING_SECONDS)
        await pilot.press("y")
        await pilot.pause()
        assert screen.answers == [Answer(True)]


async def test_the_yes_key_behind_a_remote_multiplexer_is_a_changing_digit(
    run: Run,
) -> None:
    screen = Asking()
    async with run(screen) as pilot:
        terminal = FakeTerminal(pilot, TerminalSession(remote=True, multiplexer=True))
        terminal.answer(monotonic())
        digits: list[str] = []
        for count in range(3):
            await ask(pilot)
            found = re.search(r"(\d) yes, do it", pilot.text())
            assert found is not None
            digits.append(found[1])
            await pilot.press("y", *({*"456789"} - {found[1]}))
            await pilot.pause()
            assert len(screen.answers) == count
            assert f"The yes of this question is {found[1]}." in pilot.text()
            await pilot.press(found[1])
            await pilot.pause()
            assert screen.answers[-1] == Answer(True)
            bar_of(pilot).ready()
        assert digits[0] != digits[1] != digits[2]


async def test_a_confirmation_takes_the_same_digit(run: Run) -> None:
    answers: list[bool | None] = []
    async with run() as pilot:
        FakeTerminal(pilot, TerminalSession(), setting="digit")
        await pilot.app.push_screen(ConfirmDialog("Forget User 2?"), answers.append)
        await pilot.pause()
        found = re.search(r"(\d)  yes", pilot.text())
        assert found is not None
        await pilot.press("y", found[1])
        await pilot.pause()
        assert answers == [True]


async def test_help_over_a_question_names_the_digit_for_yes(run: Run) -> None:
    for dialog in (QuestionDialog("call number"), ConfirmDialog("Forget User 2?")):
        async with run() as pilot:
            FakeTerminal(pilot, TerminalSession(), setting="digit")
            await pilot.app.push_screen(dialog)
            told = help_for(dialog)
            yes = dialog.yes_key
            assert yes in "456789"
            assert f"Press {yes} " in told.paragraphs[0]
            assert yes in [key for key, _ in told.here]
            assert "y" not in [key for key, _ in told.here]


async def test_help_elsewhere_names_the_current_yes_key(run: Run) -> None:
    for setting, told in (("y", "press y and"), ("digit", "the digit it shows")):
        screen = Asking()
        screen.HELP = teach_keys.HELP  # type: ignore[misc]
        async with run(screen) as pilot:
            FakeTerminal(pilot, TerminalSession(), setting=setting)
            assert told in help_for(screen).paragraphs[0]


async def test_confirm_accepts_only_y_and_n(run: Run) -> None:
    for key, result in (("y", True), ("n", False), ("escape", False)):
        answers: list[bool | None] = []
        async with run() as pilot:
            await pilot.app.push_screen(ConfirmDialog("Forget User 2?"), answers.append)
            await pilot.press("enter", "space", "x")
            assert answers == []
            await pilot.press(key)
            await pilot.pause()
            assert answers == [result]


async def test_confirm_and_message_drop_keys_typed_ahead(run: Run, clock: StillClock) -> None:
    clock.now = monotonic() + 1000
    async with run(clock=clock) as pilot:
        for dialog in (ConfirmDialog("Sure?"), MessageDialog("Read this.")):
            await pilot.app.push_screen(dialog)
            await pilot.press("y", "enter", "escape")
            await pilot.pause()
            assert pilot.app.screen is dialog
            pilot.app.pop_screen()
            await pilot.pause()


async def test_message_closes_on_enter_and_keeps_its_paragraphs(run: Run) -> None:
    async with run() as pilot:
        await pilot.app.push_screen(MessageDialog("First line.\nSecond line.", "Play"))
        await pilot.pause()
        lines = pilot.text().splitlines()
        first = next(n for n, line in enumerate(lines) if "First line." in line)
        assert "Second line." in lines[first + 1]
        await pilot.press("enter")
        await pilot.pause()
        assert len(pilot.app.screen_stack) == 1
