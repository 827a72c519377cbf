"""The word stop among the keys."""

from __future__ import annotations

import pytest

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
