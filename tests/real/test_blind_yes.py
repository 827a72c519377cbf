"""A yes counts only if the person has seen its question, however slow the link."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.support.asking import (
    ASKED,
    FROM_HERE,
    SSH,
    answered,
    ask,
    ask_blindly,
    blind,
    steps,
    yes_of,
)
from tests.support.link import Answerer, FarTerminal, Link
from tests.support.terminal import TANGY, Terminal

Start = Callable[..., FarTerminal]


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Start]:
    """Start teaching at the far end of a link."""
    started: list[Terminal] = []

    def begin(link: Link, answerer: Answerer = "far", **environment: str) -> FarTerminal:
        command = [TANGY, "--data", str(tmp_path), "teach", "--teacher", "ann", "--seed", "3"]
        terminal = Terminal(command, environment={**FROM_HERE, **environment})
        started.append(terminal)
        far = FarTerminal(terminal, link, answerer=answerer)
        far.until(lambda: "type a command" in far.text)
        far.rest()
        return far

    yield begin
    for terminal in started:
        terminal.end()


@pytest.mark.slow
def test_a_yes_before_its_question_appears_is_rejected_as_too_early(start: Start) -> None:
    far = start(Link(delay=0.3), **SSH)
    ask_blindly(far, "y", 0.2)
    assert ASKED in far.text
    assert "Too early: please answer again." in far.text
    far.run(0.3)
    far.type("y")
    far.until(lambda: steps(far) == 1)


@pytest.mark.slow
def test_the_yes_key_is_a_digit_if_a_multiplexer_answers(start: Start) -> None:
    far = start(Link(delay=0.3), "near", TMUX="a-socket,1,0", **SSH)
    assert blind(far, "y", 3, 0.5) == 0
    ask(far)
    far.run(0.3)
    digit = yes_of(far)
    assert digit in "456789"
    far.type("y")
    far.until(lambda: f"The yes of this question is {digit}." in far.text)
    far.type(digit)
    far.until(lambda: steps(far) == 1)


@pytest.mark.slow
def test_the_yes_key_of_a_silent_remote_terminal_is_a_digit(start: Start) -> None:
    far = start(Link(delay=0.2), "nobody", **SSH)
    ask(far)
    assert yes_of(far) in "456789"


@pytest.mark.slow
def test_the_yes_key_of_a_local_terminal_is_y(start: Start) -> None:
    far = start(Link(), "nobody")
    ask(far)
    far.run(0.3)
    assert yes_of(far) == "Y"
    far.type("y")
    far.until(lambda: steps(far) == 1)


@pytest.mark.slow
@pytest.mark.parametrize(
    "link",
    [
        Link(),
        Link(0.1),
        Link(0.3),
        Link(0.6),
        Link(1.2),
        Link(0.3, jitter=0.4),
        Link(0.1, rate=2000),
    ],
)
def test_no_blind_yes_is_accepted(start: Start, link: Link) -> None:
    far = start(link, **SSH)
    assert blind(far, "y", 12, 2 * link.delay + link.jitter + 0.05) == 0
    # The terminal gets the query after the question, and jitter may delay the query.
    assert answered(far, 12, 0.3 + link.jitter) >= 11
