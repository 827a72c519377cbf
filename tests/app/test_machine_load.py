"""Busy processes beside a bench game are there for as long as it is, and no longer."""

from __future__ import annotations

import subprocess

import pytest

from tangy_tui.app.machine_load import machine_load


def test_processes_are_busy_while_the_game_goes_on_and_gone_after_it(
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


def test_without_load_nothing_is_begun(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(subprocess, "Popen", None)
    with machine_load(0):
        pass
