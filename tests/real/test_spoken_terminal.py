"""A spoken command through the real decoder ends at the same question as a typed one."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tests.real.conftest import OpenTerminal, Tmux

flite = shutil.which("flite")
needs_flite = pytest.mark.skipif(flite is None, reason="flite is not installed")


@pytest.fixture
def spoken(tmp_path: Path) -> Callable[[str], Path]:
    """Say a sentence into a WAV file, with the voice slt."""

    def say(words: str) -> Path:
        file = tmp_path / f"{words.replace(' ', '-')}.wav"
        assert flite is not None
        subprocess.run(  # noqa: S603 - flite, found on the path
            [flite, "-voice", "slt", "-t", words, "-o", str(file)], check=True
        )
        return file

    return say


@needs_flite
def test_a_recording_is_asked_about_and_becomes_a_step(
    open_terminal: OpenTerminal, spoken: Callable[[str], Path], tangy: str, tmp_path: Path
) -> None:
    terminal = open_terminal("teach", "--seed", "1", "--mic", str(spoken("greet everyone")))
    terminal.until("Did you say: greet everyone?")
    terminal.settle(0.4)
    terminal.type("y")
    terminal.until("-> greeting")
    terminal.type("\x03")
    assert terminal.wait() == 0
    kept = subprocess.run(  # noqa: S603 - our own program
        [tangy, "teach", "--json", "--data", str(tmp_path / "data")],
        input="",
        capture_output=True,
        text=True,
        check=True,
    )
    trajectory = json.loads(kept.stdout)["demonstrations"][0]["trajectory"]
    assert [step["behaviour"] for step in trajectory] == ["greeting"]


@needs_flite
def test_sound_on_standard_input_leaves_the_keys_to_the_terminal(
    open_tmux: Callable[[int, int], Tmux],
    spoken: Callable[[str], Path],
    tangy: str,
    tmp_path: Path,
) -> None:
    tmux = open_tmux(80, 24)
    file = spoken("greet everyone")
    tmux.run("cat", str(file), "|", tangy, "teach", "--mic", "-", "--data", str(tmp_path / "data"))
    tmux.until("Did you say: greet everyone?")
    tmux.until(lambda text: _confirmed(tmux, text))
    tmux("send-keys", "C-c")


def _confirmed(tmux: Tmux, text: str) -> bool:
    if "-> greeting" in text:
        return True
    if "Did you say" in text:
        tmux("send-keys", "y")
    return False


@needs_flite
def test_no_is_heard_as_nothing_done_and_the_next_command_is_taken(
    open_terminal: OpenTerminal, spoken: Callable[[str], Path]
) -> None:
    terminal = open_terminal("teach", "--seed", "1", "--mic", str(spoken("call a number")))
    terminal.until("Did you say: call number?")
    terminal.settle(0.4)
    terminal.type("n")
    terminal.until(lambda text: "Did you say" not in text and "> call a number" in text)
    assert "No steps yet" in terminal.text
