"""Lines that are typed while the program writes: both are readable."""

from __future__ import annotations

import os
import pty
import signal
import termios
import threading
from collections.abc import Callable, Iterator

import pyte
import pytest

from tangy_tui.console.typed_lines import LineEditor, TypedLines, at_continue, cells_of
from tests.support.waiting import wait_until

COLUMNS = 20


class Desk:
    """A terminal with a person who types, and its screen."""

    def __init__(self, *, dumb: bool = False) -> None:
        self.parent, self.child = pty.openpty()
        termios.tcsetwinsize(self.child, (12, COLUMNS))
        self._screen = pyte.Screen(COLUMNS, 12)
        self._screen.set_mode(pyte.modes.LNM)
        self._stream = pyte.Stream(self._screen)
        self.lines = TypedLines(self.child, self, self.print_line, dumb=dumb)  # type: ignore[arg-type]
        self.read: list[str | None] = []

    def write(self, text: str) -> None:
        self._stream.feed(text)

    def flush(self) -> None:
        """Do nothing, as there is no buffer."""

    def print_line(self, line: str) -> None:
        self.write(f"{line}\n")

    def reads(self) -> None:
        """Read lines in a thread, up to the end of the input."""

        def read() -> None:
            while not self.read or self.read[-1] is not None:
                self.read.append(self.lines.read())

        self.lines.prepare()
        threading.Thread(target=read, daemon=True).start()

    def type(self, text: str) -> None:
        os.write(self.parent, text.encode())

    @property
    def shown(self) -> list[str]:
        return [line.rstrip() for line in self._screen.display if line.strip()]

    def shows(self, *lines: str) -> Callable[[], bool]:
        return lambda: self.shown == list(lines)


@pytest.fixture
def desk() -> Iterator[Desk]:
    made = Desk()
    made.reads()
    yield made
    made.type("\x15\x04")
    wait_until(lambda: made.read[-1:] == [None])
    made.lines.restore()


def typed(keys: str) -> tuple[list[str], str]:
    """Return the lines that keys complete, and the text of the next one."""
    editor = LineEditor()
    lines = [line for one in keys if (line := editor.take(one)) is not None]
    return lines, editor.text


@pytest.mark.parametrize(
    ("keys", "lines", "text"),
    [
        ("end\r", ["end"], ""),
        ("emd\x7f\x7fnd\n", ["end"], ""),
        ("take bakc\x17back\r", ["take back"], ""),
        ("nonsense\x15where", [], "where"),
        ("a\x1b[A\x1b[1;5Cb\x1bOPc", [], "abc"),
        ("\x07ñandú", [], "ñandú"),
        ("\x7f\x17\x15", [], ""),
    ],
)
def test_keys_edit_the_line(keys: str, lines: list[str], text: str) -> None:
    assert typed(keys) == (lines, text)


def test_wide_and_combining_characters_have_their_width() -> None:
    assert cells_of("a") == 1 and cells_of("日本") == 4 and cells_of("e\u0301") == 1


def test_output_goes_above_the_typed_text(desk: Desk) -> None:
    desk.type("take b")
    wait_until(desk.shows("take b"))
    desk.lines.write("B-9 is called.")
    assert desk.shown == ["B-9 is called.", "take b"]
    desk.type("ack\r")
    wait_until(lambda: desk.read == ["take back\n"])
    desk.lines.write("Taken back.")
    assert desk.shown == ["B-9 is called.", "take back", "Taken back."]


def test_typed_text_that_wraps_is_moved_as_a_whole(desk: Desk) -> None:
    long = "x" * COLUMNS + "y" * COLUMNS + "z"
    desk.type(long)
    wait_until(lambda: desk.shown[-1:] == ["z"])
    desk.lines.write("Called.")
    assert desk.shown == ["Called.", "x" * COLUMNS, "y" * COLUMNS, "z"]
    desk.type("\x7f")
    wait_until(desk.shows("Called.", "x" * COLUMNS, "y" * COLUMNS))


def test_an_answer_begun_before_its_question_is_dropped(desk: Desk) -> None:
    desk.type("y")
    wait_until(desk.shows("y"))
    desk.lines.drop(lambda text: text == "y")
    desk.lines.write("End the game?")
    desk.type("n\r")
    wait_until(lambda: desk.read == ["n\n"])
    wait_until(desk.shows("End the game?", "n"))


def test_lines_typed_at_once_come_one_by_one(desk: Desk) -> None:
    desk.type("where\rwhy\r")
    wait_until(lambda: desk.read == ["where\n", "why\n"])


def test_a_dumb_terminal_gets_the_typed_text_again() -> None:
    desk = Desk(dumb=True)
    desk.reads()
    desk.type("en")
    wait_until(desk.shows("en"))
    desk.lines.write("Called.")
    assert desk.shown == ["en", "Called.", "en"]
    desk.type("d\r\x04")
    wait_until(lambda: desk.read == ["end\n", None])


def test_the_terminal_is_given_back_as_it_was() -> None:
    desk = Desk()
    before = termios.tcgetattr(desk.child)
    desk.lines.prepare()
    assert not termios.tcgetattr(desk.child)[3] & termios.ECHO
    desk.lines.restore()
    assert termios.tcgetattr(desk.child) == before
    desk.lines.prepare()  # as in a thread that still reads lines
    assert termios.tcgetattr(desk.child) == before


def is_yes(line: str) -> bool:
    return line.strip() == "y"


def test_an_answer_counts_only_after_the_terminal_has_shown_its_question(desk: Desk) -> None:
    told: list[str] = []
    desk.lines.too_early = lambda: told.append("early")
    desk.type("y")
    wait_until(desk.shows("y"))
    desk.lines.drop(is_yes)
    desk.lines.write("Take it back?")
    desk.type("y\rstop\r")
    wait_until(lambda: desk.read == ["stop\n"])
    desk.lines.ask_terminal()
    desk.type("y\r")
    wait_until(lambda: told == ["early", "early"])
    desk.type("y\x1b[3;1R\ry\r")  # the first of these was begun before the terminal's reply
    wait_until(lambda: desk.read == ["stop\n", "\n", "y\n"])


def test_the_second_of_two_questions_needs_a_reply_of_its_own(desk: Desk) -> None:
    for question in ("Call?", "Take it back?"):
        desk.lines.drop(is_yes)
        desk.lines.write(question)
        desk.lines.ask_terminal()
    desk.type("\x1b[3;1Ry\rwhere\r\x1b[4;1Ry\r")
    wait_until(lambda: desk.read == ["where\n", "y\n"])


def test_a_terminal_that_never_replies_is_not_asked_again(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tangy_tui.console.typed_lines.REPLY_SECONDS", 0.0)
    for number in (1, 2):
        desk.lines.drop(is_yes)
        desk.lines.ask_terminal()
        desk.type("y\r")
        wait_until(lambda wanted=number: desk.read == ["y\n"] * wanted)  # type: ignore[misc]


def test_keys_are_not_echoed_after_a_stopped_program_goes_on(desk: Desk) -> None:
    mode = termios.tcgetattr(desk.child)
    mode[3] |= termios.ECHO | termios.ICANON  # as a shell leaves it
    termios.tcsetattr(desk.child, termios.TCSANOW, mode)
    with at_continue(desk.lines.prepare):
        os.kill(os.getpid(), signal.SIGCONT)
        assert not termios.tcgetattr(desk.child)[3] & (termios.ECHO | termios.ICANON)
