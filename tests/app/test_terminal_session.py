"""Detecting remote sessions and multiplexers from the environment and the processes."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_tui.app.terminal_session import TerminalSession, answers_for_another, terminal_session

Tree = dict[int, tuple[str, int]]
"""Names and parents of processes."""

SHELL: Tree = {1: ("systemd", 0), 40: ("bash", 30), 50: ("tangy (odd) name", 40)}


def listed(folder: Path, tree: Tree) -> Path:
    for pid, (name, parent) in tree.items():
        process = folder / str(pid)
        process.mkdir()
        (process / "stat").write_text(f"{pid} ({name}) S {parent} 1 1 0")
    (folder / "uptime").write_text("1 1")
    return folder


@pytest.mark.parametrize(
    ("environ", "tree", "expected"),
    [
        ({}, {30: ("login", 1)}, TerminalSession()),
        ({"TERM": "xterm"}, {30: ("gnome-terminal-", 1)}, TerminalSession()),
        ({"SSH_TTY": "/dev/pts/1"}, {30: ("su", 1)}, TerminalSession(remote=True)),
        ({}, {30: ("sshd-session", 20), 20: ("sshd", 1)}, TerminalSession(remote=True)),
        ({}, {30: ("sudo", 20), 20: ("dropbear", 1)}, TerminalSession(remote=True)),
        ({}, {30: ("mosh-server", 1)}, TerminalSession(remote=True, multiplexer=True)),
        ({"TMUX": "x,1,0"}, {30: ("tmux: server", 1)}, TerminalSession(multiplexer=True)),
        (
            {"TERM": "screen-256color", "SSH_CONNECTION": "a b"},
            {30: ("sshd", 1)},
            TerminalSession(remote=True, multiplexer=True),
        ),
        (
            {"STY": "1.a"},
            {30: ("SCREEN", 1), 60: ("screen", 61), 61: ("bash", 62), 62: ("login", 1)},
            TerminalSession(multiplexer=True),
        ),
        (
            {"STY": "1.a"},
            {30: ("SCREEN", 1), 60: ("screen", 61), 61: ("bash", 62), 62: ("sshd", 1)},
            TerminalSession(remote=True, multiplexer=True),
        ),
        (
            {"TMUX": "x,1,0"},
            {30: ("tmux: server", 1), 60: ("tmux: client", 61), 61: ("mosh-server", 1)},
            TerminalSession(remote=True, multiplexer=True),
        ),
    ],
)
def test_the_session_is_detected_from_the_environment_and_processes(
    tmp_path: Path, environ: dict[str, str], tree: Tree, expected: TerminalSession
) -> None:
    proc = listed(tmp_path, {**SHELL, **tree})
    assert terminal_session(environ, pid=50, proc=proc) == expected


def test_the_session_is_detected_from_the_environment_alone(tmp_path: Path) -> None:
    nowhere = tmp_path / "none"
    assert terminal_session({}, pid=50, proc=nowhere) == TerminalSession()
    found = terminal_session({"SSH_TTY": "x", "TMUX": "y"}, pid=50, proc=nowhere)
    assert found == TerminalSession(remote=True, multiplexer=True)


@pytest.mark.parametrize(
    ("attributes", "another"),
    [
        ("84;0;0", True),
        ("83;40900;0", True),
        ("1;10;0", True),
        ("41;366;0", False),
        ("0;276;0", False),
        ("1;4000;21", False),
        ("", False),
    ],
)
def test_tmux_screen_and_mosh_are_detected_by_device_attributes(
    attributes: str, another: bool
) -> None:
    assert answers_for_another(attributes) is another
