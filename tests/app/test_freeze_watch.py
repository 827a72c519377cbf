"""A frozen program reports its freeze; a busy machine is no freeze."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_profiles.staff_records import StaffAction
from tangy_tui.app.freeze_watch import (
    FROZEN_SECONDS,
    WORKED_SECONDS,
    FreezeGuard,
    FreezeWatch,
)
from tangy_tui.app.scripted_staff import scripted_controller
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy


class Clocks:
    def __init__(self) -> None:
        self.time = self.worked = 100.0
        self.watch = FreezeWatch(lambda: self.time, lambda: self.worked)

    def pass_(self, seconds: float, worked: float) -> float:
        self.time += seconds
        self.worked += worked
        return self.watch.tick()


def test_a_freeze_is_reported_once_with_its_duration() -> None:
    clocks = Clocks()
    assert clocks.pass_(1.0, 0.1) == 0.0
    assert clocks.pass_(42.0, 0.1) == 42.0
    assert clocks.pass_(1.0, 0.1) == 0.0


@pytest.mark.parametrize(
    ("seconds", "worked"),
    [(FROZEN_SECONDS - 0.1, 0.0), (2 * FROZEN_SECONDS, WORKED_SECONDS), (60.0, 30.0)],
)
def test_short_gaps_and_busy_times_are_no_freeze(seconds: float, worked: float) -> None:
    assert Clocks().pass_(seconds, worked) == 0.0


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


@pytest.mark.slow
def test_a_freeze_pauses_the_game_and_is_logged(workspace: Workspace, learnt: Policy) -> None:
    clocks, told = Clocks(), list[float]()
    control = scripted_controller(workspace.supervision(learnt, 5))
    guard = FreezeGuard(control, told.append, clocks.watch)
    control.begin()
    control.next()
    assert not guard.look() and control.phase == "running"
    clocks.time += 42.0
    assert guard.look() and not guard.look()
    assert (control.phase, told, control.next()) == ("paused", [42.0], [])
    (note,) = workspace.store.events(StaffAction)
    assert (note.record.did, note.record.detail) == ("program frozen", "42")
    assert not note.record.by
