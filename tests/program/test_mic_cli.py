"""`tangy mic`: its help for Linux and macOS, and its message on a terminal."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tangy_profiles.errors import TangyError
from tangy_tui.verbs.mic import forward


@pytest.mark.parametrize(
    "command",
    [
        "arecord -q -t raw -f S16_LE -r 16000 -c 1 | ssh ROBOT tangy mic",
        "rec -q -t raw -b 16 -e signed -r 16000 -c 1 - | ssh ROBOT tangy mic",
        "ffmpeg -loglevel error -f avfoundation -i :default -f s16le -ar 16000 -ac 1 -",
    ],
)
def test_help_has_a_command_to_copy_for_each_system(
    tangy: Callable[..., CompletedProcess[str]], command: str
) -> None:
    done = tangy("mic", "--help")
    assert done.returncode == 0
    assert command in (line.strip(" \\") for line in done.stdout.splitlines())


class Terminal(io.StringIO):
    """Standard input without data."""

    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(
    ("data", "socket", "options"),
    [
        (None, None, ""),
        (Path("two words"), None, " --data 'two words'"),
        (Path("mine"), Path("my.sock"), " --data mine --socket my.sock"),
    ],
)
def test_a_terminal_as_input_prints_the_commands_for_the_laptop(
    data: Path | None,
    socket: Path | None,
    options: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(sys, "stdin", Terminal())
    with pytest.raises(TangyError, match="no sound comes in"):
        forward(data, socket)
    told = capsys.readouterr().err.splitlines()
    assert [line.partition(":")[0] for line in told] == ["Linux", "macOS"]
    assert all(line.endswith(f"| ssh ROBOT tangy mic{options}") for line in told)
