"""`tangy mic` is explained where it is looked for: for Linux, for macOS, and what it does."""

from __future__ import annotations

from collections.abc import Callable
from subprocess import CompletedProcess

import pytest


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
