"""A frozen program reports its freeze; a busy machine is no freeze."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_profiles.faults import Evidence
from tangy_profiles.staff_records import StaffAction
from tangy_tui.app.freeze_watch import (
    FROZEN_SECONDS,
    WAKES_SECONDS,
    WORKED_SECONDS,
    FreezeGuard,
    FreezeWatch,
)
from tangy_tui.app.game_commands import GoOn
from tangy_tui.app.scripted_staff import scripted_controller
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import GameEvent
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.supervision import Event
from tangy_tui.monitoring.watch import FaultWatch


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
    assert not guard.awake()
    assert (control.phase, told, control.next()) == ("paused", [42.0], [])
    (note,) = workspace.store.events(StaffAction)
    assert (note.record.did, note.record.detail) == ("program frozen", "42")
    assert not note.record.by


def test_devices_are_judged_once_they_report_again(
    workspace: Workspace, learnt: Policy, monkeypatch: pytest.MonkeyPatch
) -> None:
    looks, clocks = list[str](), Clocks()
    control = scripted_controller(workspace.supervision(learnt, 5))
    FreezeGuard(control, lambda seconds: None, clocks.watch)
    control.begin()

    def devices(self: FaultWatch) -> Evidence:
        looks.append("looked")
        return {}

    monkeypatch.setattr(FaultWatch, "devices", property(devices))
    clocks.time += 42.0
    control.next()
    control.apply(GoOn())
    clocks.time += WAKES_SECONDS - 0.1
    assert (control.next(), looks, control.supervision.steps) == ([], [], 0)
    clocks.time += 0.2
    assert control.next() and looks


def test_a_step_that_a_freeze_interrupted_is_not_judged(
    workspace: Workspace, learnt: Policy, monkeypatch: pytest.MonkeyPatch
) -> None:
    clocks, judged = Clocks(), list[bool]()
    control = scripted_controller(workspace.supervision(learnt, 5))
    FreezeGuard(control, lambda seconds: None, clocks.watch)
    after, step = FaultWatch.after, control.supervision.game.step

    def frozen() -> list[GameEvent]:
        events = step()
        clocks.time += 42.0
        control.awake()
        return events

    def judge(self: FaultWatch, events: list[GameEvent], *, ordered: bool) -> list[Event]:
        judged.append(not ordered)
        return after(self, events, ordered=ordered)

    monkeypatch.setattr(FaultWatch, "after", judge)
    control.begin()
    control.next()
    monkeypatch.setattr(control.supervision.game, "step", frozen)
    control.next()
    assert judged == [True, False] and control.phase == "paused"
