"""The sensors on a real terminal, with a camera that fails and recovers."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.real.camera_server import CameraServer

if TYPE_CHECKING:
    from tests.real.conftest import OpenTerminal


def children(pid: int) -> list[int]:
    """Return the processes that a process has started."""
    listed = Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii")
    return [int(child) for child in listed.split()]


def alive(pid: int) -> bool:
    return Path(f"/proc/{pid}").exists()


@pytest.mark.slow
def test_the_screen_shows_a_camera_failing_and_recovering(
    open_terminal: OpenTerminal,
) -> None:
    with CameraServer() as server:
        terminal = open_terminal("sensors", "--camera", f"camera={server.url}")
        terminal.until("working")
        terminal.type("V")
        terminal.until("▀▀▀▀▀▀▀▀")
        started = children(terminal.process.pid)
        assert started
        server.mode = "covered"
        terminal.until("!  head camera       covered")
        server.mode = "live"
        terminal.until("   head camera       working")
        server.unplug()
        terminal.until("!! head camera       disconnected")
        server.mode = "live"
        server.listen()
        text = terminal.until("   head camera       working")
        assert "TANGY sensors" in text and "Last card" in text  # and nothing covers them
        terminal.type("\x1b")
        assert terminal.wait() == 0
        assert not [pid for pid in started if alive(pid)]


@pytest.mark.slow
def test_closing_the_window_ends_the_camera(open_terminal: OpenTerminal) -> None:
    with CameraServer() as server:
        terminal = open_terminal("sensors", "--camera", f"camera={server.url}")
        terminal.until("working")
        started = children(terminal.process.pid)
        terminal.close()
        terminal.process.wait(20)
        for pid in started:
            while alive(pid):
                os.sched_yield()
