"""Giving a command at the far end of a link, and answering its question: seen, or blindly."""

from __future__ import annotations

import random
import re

from tests.support.link import FarTerminal

ASKED = "Did you say: call number?"
REMARKED = "esc go on"
SSH = {"SSH_CONNECTION": "192.0.2.1 50000 192.0.2.2 22"}
FROM_HERE = {"SSH_CONNECTION": "", "SSH_TTY": "", "SSH_CLIENT": "", "TMUX": "", "STY": ""}


def ask(far: FarTerminal) -> None:
    """Give a command, and wait for its question, after any remark on the last step."""
    while REMARKED in far.text:
        far.type("\x1b")  # GNU screen holds back the first one
        far.rest()
    far.type("call number\r")
    far.until(lambda: ASKED in far.text)


def ask_blindly(far: FarTerminal, key: str, wait: float) -> None:
    """Give a command, press a key before its question is visible, and wait for all output."""
    assert ASKED not in far.text
    far.type("call number\r")
    far.run(wait)
    if ASKED not in far.text:
        far.type(key)
    far.until(lambda: ASKED in far.text)
    far.rest()


def steps(far: FarTerminal) -> int:
    """Return the number of steps on the screen."""
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
    """Return the key that says yes."""
    found = re.search(r"(\S) yes, do it", far.text)
    assert found is not None
    return found[1]


def blind(far: FarTerminal, key: str, times: int, longest: float, seed: int = 7) -> int:
    """Count how often a key that was pressed blindly counted as a yes."""
    rng = random.Random(seed)
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


def answered(far: FarTerminal, times: int, reading: float) -> int:
    """Count how often the yes of a question counts some s after the question was visible."""
    taken = 0
    for _ in range(times):
        before = steps(far)
        ask(far)
        far.run(reading)
        far.type(yes_of(far).lower())
        far.rest()
        if steps(far) == before + 1:
            taken += 1
        else:
            refuse(far)
    return taken
