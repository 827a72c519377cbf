"""The load processes beside a bench game run as long as the game."""

from __future__ import annotations

import subprocess

import pytest

from tangy_tui.app.machine_load import machine_load


def test_the_load_runs_as_long_as_the_game(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    begun: list[subprocess.Popen[bytes]] = []

    class Noted(subprocess.Popen[bytes]):
        def __init__(self, *args: object, **more: object) -> None:
            super().__init__(*args, **more)  # type: ignore[call-overload]
            begun.append(self)

    monkeypatch.setattr(subprocess, "Popen", Noted)
    with machine_load(2):
        assert len(begun) == 2
        assert all(one.poll() is None for one in begun)
    assert all(one.returncode is not None for one in begun)


def test_no_process_starts_without_load(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(subprocess, "Popen", None)
    with machine_load(0):
        pass
