"""A yes counts only if the person has seen its question, however slow the link."""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.support.link import Answerer, FarTerminal, Link
from tests.support.terminal import TANGY, Terminal

ASKED = "Did you say: call number?"
REMARKED = "esc go on"
SSH = {"SSH_CONNECTION": "192.0.2.1 50000 192.0.2.2 22"}
FROM_HERE = {"SSH_CONNECTION": "", "SSH_TTY": "", "SSH_CLIENT": "", "TMUX": "", "STY": ""}

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


def ask(far: FarTerminal) -> None:
    """Give a command, and wait for its question; what is remarked on the last step comes first."""
    if REMARKED in far.text:
        far.type("\x1b")
        far.until(lambda: REMARKED not in far.text)
        far.rest()
    far.type("call number\r")
    far.until(lambda: ASKED in far.text)


def ask_blindly(far: FarTerminal, key: str, wait: float) -> None:
    """Give a command, press a key before its question can be seen, and wait for all of it."""
    assert ASKED not in far.text
    far.type("call number\r")
    far.run(wait)
    if ASKED not in far.text:
        far.type(key)
    far.until(lambda: ASKED in far.text)
    far.rest()


def steps(far: FarTerminal) -> int:
    found = re.search(r"step (\d+)", far.text)
    assert found is not None
    return int(found[1])


def refuse(far: FarTerminal) -> None:
    """Say no, and empty the line."""
    far.type("n")
    far.until(lambda: ASKED not in far.text)
    far.type("\x15")
    far.rest()


def yes_of(far: FarTerminal) -> str:
    """Read which key says yes."""
    found = re.search(r"(\S) yes, do it", far.text)
    assert found is not None
    return found[1]


def blind(far: FarTerminal, key: str, times: int, longest: float) -> int:
    """Count how often a key that was pressed blindly was taken for a yes."""
    rng = random.Random(7)
    taken = 0
    for _ in range(times):
        before = steps(far)
        ask_blindly(far, key, rng.uniform(0, longest))
        if ASKED not in far.text:
            taken += 1
        else:
            refuse(far)
        assert taken or steps(far) == before
    return taken


def test_a_yes_before_its_question_was_seen_is_told_to_be_too_early(start: Start) -> None:
    far = start(Link(delay=0.3), **SSH)
    ask_blindly(far, "y", 0.2)
    assert ASKED in far.text
    assert "Too early: please answer again." in far.text
    far.run(0.3)
    far.type("y")
    far.until(lambda: steps(far) == 1)


def test_what_answers_for_the_terminal_makes_the_yes_a_digit(start: Start) -> None:
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


def test_where_nothing_answers_a_remote_yes_is_a_digit(start: Start) -> None:
    far = start(Link(delay=0.2), "nobody", **SSH)
    ask(far)
    assert yes_of(far) in "456789"


def test_beside_the_machine_y_is_the_yes_whatever_answers(start: Start) -> None:
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
def test_no_blind_yes_is_taken(start: Start, link: Link) -> None:
    far = start(link, **SSH)
    assert blind(far, "y", 12, 2 * link.delay + link.jitter + 0.05) == 0
    taken = 0
    for _ in range(12):
        before = steps(far)
        ask(far)
        # The terminal is asked behind the question, and jitter may hold up what asks it.
        far.run(0.3 + link.jitter)
        far.type("y")
        far.rest()
        if taken_now := steps(far) == before + 1:
            taken += taken_now
        else:
            refuse(far)
    assert taken >= 11
