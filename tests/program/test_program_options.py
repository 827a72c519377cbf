"""`tangy` with only its own options opens the program as the option parser would."""

from __future__ import annotations

import gc
import sys
from pathlib import Path
from typing import Any

import pytest

from tangy_tui import cli
from tangy_tui.verbs import opening, program

SAME = [
    [],
    ["--ascii"],
    ["--data", "mine"],
    ["--data=mine", "--ascii"],
    ["--robot", "other", "--data", "mine"],
    ["--robot=other"],
    ["--data", "a", "--data=b"],
]


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """Return the options of every opened program."""
    calls: list[dict[str, Any]] = []

    def opens(data: Path | None = None, *, robot: str = "tangy", ascii_only: bool = False) -> int:
        calls.append({"data": data, "robot": robot, "ascii_only": ascii_only})
        return 0

    for module in (opening, program):
        monkeypatch.setattr(module, "full_screen", lambda: True)
        monkeypatch.setattr(module, "open_program", opens)
    return calls


@pytest.mark.parametrize("words", SAME, ids=" ".join)
def test_both_ways_open_the_same_program(
    words: list[str], opened: list[dict[str, Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "argv", ["tangy", *words])
    assert cli.run() == 0
    assert cli.parsed() == 0
    assert len(opened) == 2 and opened[0] == opened[1]


@pytest.mark.parametrize("full", [True, False])
def test_garbage_is_collected_again_with_and_without_a_screen(
    full: bool, opened: list[dict[str, Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "argv", ["tangy"])
    monkeypatch.setattr(opening, "full_screen", lambda: full)
    monkeypatch.setattr(cli, "parsed", lambda: 0)
    assert cli.run() == 0
    assert gc.isenabled() and len(opened) == full


@pytest.mark.parametrize(
    "words", [["--data"], ["--data", "--ascii"], ["--dat", "x"], ["teach"], ["--help"], ["--data="]]
)
def test_other_options_are_left_to_the_option_parser(words: list[str]) -> None:
    assert cli.program_options(words) is None
