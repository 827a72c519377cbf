"""Lines on a terminal are wrapped between words; piped lines stay whole."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_tui.verbs.common import fitted
from tests.support.terminal import TANGY, Terminal


@given(st.text(alphabet="ab .:-", max_size=200), st.integers(10, 90))
def test_wrapping_a_line_keeps_its_words(line: str, columns: int) -> None:
    broken = fitted(line, columns)
    assert broken.split() == line.split()
    longest = max((len(word) for word in line.split()), default=0)
    inset = len(line) - len(line.lstrip()) + 2
    for part in broken.split("\n"):
        assert len(part) <= columns or longest + inset > columns


def test_a_wrapped_list_item_is_indented() -> None:
    assert fitted("  undo: take the last step back", 20) == "  undo: take the\n    last step back"
    assert fitted("undo: take the last step back", 0) == "undo: take the last step back"


@pytest.mark.slow
@pytest.mark.parametrize("columns", [40, 80])
def test_teaching_by_lines_wraps_between_words(tmp_path: Path, columns: int) -> None:
    command = [TANGY, "--data", str(tmp_path), "teach", "--plain", "--teacher", "ann", "--seed=3"]
    terminal = Terminal(command, columns=columns, lines=90)
    try:
        terminal.until("Now:")
        terminal.type("help\n")
        text = terminal.until(lambda text: text.rstrip().endswith("kept"))
    finally:
        terminal.end()
    piped = subprocess.run(command, input="help\n", capture_output=True, text=True, check=True)  # noqa: S603
    known = set(piped.stdout.replace(str(tmp_path), "").split())
    assert max(map(len, piped.stdout.splitlines())) > columns
    seen = [line for line in text.splitlines() if str(tmp_path) not in line]
    assert {word for line in seen for word in line.split()} <= known | {"help"}
