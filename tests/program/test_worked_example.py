"""The worked example of docs/activities.md: each command prints what the page shows."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tangy_tui.text.staff_lines import NO_MORE

PAGE = Path(__file__).parents[2] / "docs" / "activities.md"
BLOCK = re.compile(r"^```console\n(.*?)^```", re.DOTALL | re.MULTILINE)
Tangy = Callable[..., CompletedProcess[str]]


def shown() -> list[tuple[str, list[str]]]:
    """Return the commands of the page, and the lines that it shows after each."""
    found = list[tuple[str, list[str]]]()
    for block in BLOCK.findall(PAGE.read_text(encoding="utf-8")):
        for line in block.splitlines():
            if line.startswith("$ "):
                found.append((line[2:], []))
            else:
                found[-1][1].append(line.rstrip())
    return found


def pattern(lines: list[str]) -> str:
    """Return a pattern of the output; a line of three dots stands for any lines."""
    parts = [r"(?:.*\n)*?" if line == "..." else re.escape(line) + "\n" for line in lines]
    return "".join(parts)


@pytest.mark.slow
def test_each_command_of_the_worked_example_prints_what_the_page_shows(
    tangy: Tangy, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    commands = shown()
    assert [shlex.split(command)[1] for command, _ in commands] == [
        "activity", "activity", "teach", "learn", "play",
    ]  # fmt: skip
    for command, lines in commands:
        answers = "".join(f"{line[2:]}\n" for line in lines if line.startswith(">"))
        done = tangy(*shlex.split(command)[1:], stdin=answers)
        assert (done.returncode, done.stderr) == (0, ""), command
        said = "".join(f"{line.rstrip()}\n" for line in done.stdout.splitlines() if line != NO_MORE)
        assert re.fullmatch(pattern(lines), said), f"{command} printed:\n{said}"
