"""The command line as a separate process: odd terminals, odd locales, closed pipes."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from time import sleep

import pytest

from tangy_profiles.past_game import interrupted_game
from tangy_profiles.store import Store
from tangy_tui.text.interruptions import GOES_ON_LATER

TANGY = [sys.executable, "-c", "from tangy_tui.cli import main; main()"]


def tangy(
    *arguments: str, home: Path, typed: str | bytes = "", **environment: str
) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(  # noqa: S603 - our own interpreter
        [*TANGY, *arguments],
        input=typed.encode() if isinstance(typed, str) else typed,
        capture_output=True,
        timeout=60,
        check=False,
        env={
            **{k: v for k, v in os.environ.items() if not k.startswith(("LC_", "LANG"))},
            "HOME": str(home),
            "XDG_DATA_HOME": str(home),
            **environment,
        },
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    "environment",
    [
        {"LANG": "C", "TERM": "dumb"},
        {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "TERM": "xterm"},
        {"LANG": "C.UTF-8", "TERM": "dumb", "NO_COLOR": "1"},
        {"PYTHONIOENCODING": "latin-1"},
    ],
)
def test_a_session_by_lines_runs_in_any_terminal_and_locale(
    environment: dict[str, str], tmp_path: Path
) -> None:
    taught = tangy(
        "teach", "--plain", home=tmp_path, typed="greet everyone\ny\nñandú\n", **environment
    )
    assert (taught.returncode, taught.stderr) == (0, b"")
    assert b"1. the game has not begun" in taught.stdout
    assert b"You left after 1 step." in taught.stdout


@pytest.mark.slow
def test_undecodable_bytes_are_unknown_words(tmp_path: Path) -> None:
    done = tangy("teach", "--plain", home=tmp_path, typed=b"\xff\xfe\x80\x1b[2J\nquit\n")
    assert (done.returncode, done.stderr) == (0, b"")
    assert b"I do not know what" in done.stdout
    assert b"\x1b" not in done.stdout


@pytest.mark.slow
def test_the_program_without_a_terminal_lists_its_commands(tmp_path: Path) -> None:
    done = tangy(home=tmp_path)
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.startswith(b"No screens here")


@pytest.mark.slow
def test_the_demo_prints_one_json_document(tmp_path: Path) -> None:
    done = tangy("demo", "--json", home=tmp_path, TERM="dumb", LANG="C")
    assert (done.returncode, done.stderr) == (0, b"")
    assert json.loads(done.stdout)["games"] == 1
    assert not list(tmp_path.rglob("tangy.db")), "a demonstration leaves nothing behind"


@pytest.mark.slow
def test_a_reader_that_closes_early_is_no_error(tmp_path: Path) -> None:
    with subprocess.Popen(  # noqa: S603 - our own interpreter
        [*TANGY, "demo", "--plain", "--data", str(tmp_path / "data")],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as told:
        assert told.stdout is not None
        assert told.stderr is not None
        assert told.stdout.readline().startswith(b"Scene 1 of ")
        told.stdout.close()
        assert told.stderr.read() == b""
        assert told.wait(60) == 1


@contextmanager
def greeting(data: list[str], until: bytes) -> Iterator[subprocess.Popen[bytes]]:
    """Teach by lines in another process, which has greeted everyone and given its first output."""
    with subprocess.Popen(  # noqa: S603 - our own interpreter
        [*TANGY, "teach", "--plain", *data], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as taught:
        assert taught.stdin is not None
        assert taught.stdout is not None
        taught.stdin.write(b"greet everyone\ny\n")
        taught.stdin.flush()
        assert any(until in line for line in iter(taught.stdout.readline, b""))
        yield taught


@pytest.mark.slow
def test_a_killed_writer_releases_the_folder(tmp_path: Path) -> None:
    data = ["--data", str(tmp_path / "data")]
    with greeting(data, b"Tangy says") as taught:
        busy = tangy("teach", "--plain", *data, home=tmp_path)
        assert busy.returncode == 2
        assert f"(process {taught.pid}) is writing to".encode() in busy.stderr
        taught.kill()
        taught.wait(60)
    again = tangy("teach", "--plain", *data, home=tmp_path)
    assert again.returncode == 0
    assert b"demonstration of 1 step " in again.stdout


@pytest.mark.slow
def test_ctrl_c_ends_a_session_by_lines_and_keeps_its_steps(tmp_path: Path) -> None:
    data = ["--data", str(tmp_path / "data")]
    with greeting(data, b"Now: Nobody asks") as taught:
        sleep(0.5)  # until it waits for the next line
        taught.send_signal(signal.SIGINT)
        try:
            assert taught.wait(3) == 130
        finally:
            taught.kill()
    again = tangy("teach", "--plain", *data, home=tmp_path)
    assert b"demonstration of 1 step " in again.stdout


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_game_by_lines_can_be_resumed_after_a_signal(
    number: signal.Signals, tmp_path: Path
) -> None:
    data = ("--data", str(tmp_path))
    for verb in (["teach", "--teacher", "scripted", "--games", "1"], ["learn"]):
        assert tangy(*verb, *data, home=tmp_path).returncode == 0
    with subprocess.Popen(  # noqa: S603 - our own interpreter
        [*TANGY, "play", "--plain", "--speed", "50", *data],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE,
    ) as played:  # fmt: skip
        assert played.stdout is not None
        for line in played.stdout:
            if line.startswith(b"3. "):
                break
        played.send_signal(number)
        said = played.stdout.read()
    assert played.returncode != 0
    if number == signal.SIGINT:
        assert GOES_ON_LATER.encode() in said
    with closing(Store.open(tmp_path)) as store:
        assert interrupted_game(store, "bingo") is not None
