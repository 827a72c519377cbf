"""The terminal's answer to a query proves that earlier output has reached it."""

from __future__ import annotations

import re

import pytest

from tangy_tui.app.terminal_session import TerminalSession
from tangy_tui.ui.round_trip import READING_SECONDS, ReplyParser, RoundTrip

REMOTE = TerminalSession(remote=True)


class Terminal:
    """A terminal that answers on demand, and counts positions from `base`."""

    def __init__(self, session: TerminalSession = REMOTE, base: int = 1) -> None:
        self.written: list[str] = []
        self.now = 10.0
        self.base = base
        self.seen: list[float] = []
        self.trip = RoundTrip(
            self.written.append, lambda: session, lambda: self.now, cursor=lambda: (4, 7)
        )
        self.trip.begin((80, 24))

    def answer(self, number: int = -1) -> None:
        place = re.fullmatch(r"\x1b\[(\d+);(\d+)H\x1b\[6n\x1b\[8;5H", self.written[number])
        assert place is not None
        assert 2 <= int(place[1]) <= 24
        assert 1 <= int(place[2]) <= 80
        shift = 1 + (1 - self.base)  # Textual subtracts one; some terminals count from 0
        self.trip.reported(int(place[2]) - shift, int(place[1]) - shift, self.now)


@pytest.mark.parametrize("base", [0, 1])
def test_only_the_answer_to_the_current_query_counts(base: int) -> None:
    terminal = Terminal(base=base)
    terminal.answer()
    terminal.trip.ask(terminal.seen.append)
    terminal.answer(1)  # the query at the terminal's start
    assert terminal.seen == []
    terminal.now = 12.0
    terminal.answer()
    assert terminal.seen == [pytest.approx(12.0)]


def test_query_positions_are_unique_and_never_in_the_first_line() -> None:
    terminal = Terminal()
    for _ in range(2000):
        terminal.trip.ask(terminal.seen.append)
    places = [text for text in terminal.written if "6n" in text]
    assert len(set(places[:1700])) == 1700
    assert not any(place.startswith("\x1b[1;") for place in places)


@pytest.mark.parametrize("modifier", range(2, 9))
def test_shift_f3_is_never_taken_for_an_answer(modifier: int) -> None:
    terminal = Terminal()
    for _ in range(2000):  # every position was the awaited one
        terminal.trip.ask(terminal.seen.append)
        terminal.trip.reported(modifier - 1, 0, terminal.now)  # CSI 1;2R, as Textual reads it
    assert terminal.seen == []
    assert not terminal.trip.answers
    assert terminal.trip.yes in "456789"


def test_a_delayed_answer_shortens_the_reading_time() -> None:
    terminal = Terminal()
    for trip, margin in ((0.2, READING_SECONDS), (0.25, READING_SECONDS - 0.05), (0.6, 0.0)):
        terminal.trip.ask(terminal.seen.append)
        terminal.now += trip
        terminal.answer()
        assert terminal.seen[-1] == pytest.approx(terminal.now + margin)


def test_a_resize_repeats_the_query() -> None:
    terminal = Terminal()
    terminal.trip.ask(terminal.seen.append)
    asked = len(terminal.written)
    terminal.trip.resized((60, 20))
    assert len(terminal.written) > asked
    terminal.answer()
    assert len(terminal.seen) == 1


def test_a_lost_answer_is_requested_again_a_few_times() -> None:
    terminal = Terminal()
    for _ in range(50):
        terminal.trip.ask_again(terminal.seen.append)
    assert sum("6n" in text for text in terminal.written) < 8


def test_the_yes_key_of_a_local_terminal_is_y() -> None:
    terminal = Terminal(TerminalSession(multiplexer=True))
    assert not terminal.trip.answers
    assert terminal.trip.yes == "y"
    terminal.answer()
    assert terminal.trip.answers
    assert terminal.trip.yes == "y"


def test_the_yes_key_of_a_remote_terminal_is_a_digit_until_it_answers() -> None:
    terminal = Terminal()
    assert terminal.trip.yes in "456789"
    terminal.answer()
    assert terminal.trip.yes == "y"
    terminal.trip.attributes("84;0;0")  # it was tmux
    assert terminal.trip.yes in "456789"


@pytest.mark.parametrize(
    "chunks",
    [
        ["a\x1b[>84;0;0cb"],
        ["a\x1b[>84;", "0;0cb"],
        ["a\x1b[", ">84;0;0cb"],
        ["a", "\x1b[>84;0;0c", "b"],
    ],
)
def test_device_attributes_are_removed_from_the_input(
    chunks: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    heard: list[str] = []
    monkeypatch.setattr(ReplyParser, "heard", heard.append)
    parser = ReplyParser()
    keys = [getattr(event, "key", event) for chunk in chunks for event in parser.feed(chunk)]
    assert keys == ["a", "b"]
    assert heard == ["84;0;0"]
