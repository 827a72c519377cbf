"""The word stop among the keys."""

from __future__ import annotations

import pytest
from textual import events
from textual.widgets import Input

from tangy_tui.ui.early_keys import EarlyKeys
from tangy_tui.ui.key_reading import KeyReader
from tangy_tui.ui.typed_stop import REST_SECONDS, TOGETHER_SECONDS, TypedStop


def taken(text: str, apart: float = 0.1) -> list[str]:
    typed = TypedStop()
    return [typed.take(letter, number * apart) for number, letter in enumerate(text)]


@pytest.mark.parametrize("text", ["stop", "STOP", "sstop", "please stop"])
def test_the_word_stop_stops_after_any_other_keys(text: str) -> None:
    assert taken(text)[-1] == "stop" and taken(text)[:-1] == ["key"] * (len(text) - 1)


def test_the_rest_of_the_sentence_is_swallowed_until_a_pause() -> None:
    typed = TypedStop()
    for number, letter in enumerate("stop"):
        typed.take(letter, number / 10)
    assert [typed.take(letter, 0.5) for letter in " it!\n"] == ["rest"] * 5
    assert typed.take("p", 0.5 + REST_SECONDS + 0.1) == "key"


def test_slow_or_interrupted_letters_are_keys() -> None:
    assert "stop" not in taken("stop", apart=TOGETHER_SECONDS + 0.1)
    typed = TypedStop()
    for letter in ("s", "t", None, "o", "p"):
        assert typed.take(letter, 0.0) == "key"


class Typist:
    """Types keys, each in a line or outside of it, as an app reads them before its widgets."""

    def __init__(self) -> None:
        self.focused: Input | None = None
        self.screen_stack: list[object] = []
        self.now = 0.0
        self.stops = 0
        self._reader = KeyReader(self, EarlyKeys(self))  # type: ignore[arg-type]

    def action_stop(self) -> None:
        self.stops += 1

    def types(self, text: str, *, line: bool, apart: float = 0.1) -> str:
        """Type a text; return the part of it that goes to the widgets."""
        self.focused = Input() if line else None
        left = ""
        for letter in text:
            self.now += apart
            key = events.Key("enter" if letter == "\n" else letter, letter)
            key.time = self.now
            if not self._reader.takes(key):
                left += letter
        return left


@pytest.mark.parametrize("keys", ["s", "st", "sto", "xs", "S"])
def test_the_word_goes_on_in_a_line_that_one_of_its_letters_opened(keys: str) -> None:
    typist = Typist()
    typist.types(keys, line=False)
    rest = "stop"[len(keys.lstrip("x")) :]
    assert typist.types(rest, line=True) == rest[:-1] and typist.stops == 1
    assert typist.types(" the robot\n", line=True) == ""  # it is no answer to a question
    typist.now += REST_SECONDS
    assert typist.types("greet Rosa", line=True) == "greet Rosa"
    assert typist.stops == 1


@pytest.mark.parametrize(
    ("keys", "text"),
    [
        ("", "stop it"), ("", "unstoppable"), ("s:", "top"), ("o", "stop"), ("s", "atop"),
        ("so", "top"), ("s", "the top"), ("st", "sop"), ("stx", "op"),
    ],
)  # fmt: skip
def test_a_text_that_is_typed_into_a_line_is_not_the_word(keys: str, text: str) -> None:
    typist = Typist()
    assert typist.types(keys, line=False) == keys
    assert typist.types(text, line=True) == text and not typist.stops


def test_a_pause_after_a_letter_of_the_word_ends_it() -> None:
    typist = Typist()
    typist.types("s", line=False)
    typist.now += TOGETHER_SECONDS
    assert typist.types("top", line=True) == "top" and not typist.stops


def test_letters_typed_together_are_one_word_if_a_busy_program_handles_them_late() -> None:
    typist = Typist()
    typist.clock = lambda: typist.now * 20  # type: ignore[attr-defined]
    assert typist.types("stop", line=False) == "sto" and typist.stops == 1
