"""Staff at the lines are told of a freeze and asked, before Tangy takes another step."""

from __future__ import annotations

from itertools import count
from pathlib import Path
from threading import Event

import pytest

from tangy_profiles.staff_records import StaffAction
from tangy_tui.app.freeze_watch import FreezeWatch
from tangy_tui.app.game_commands import GameCommand, GoOn
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.terminal_session import TerminalSession
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.confirming import ConfirmingStaff
from tangy_tui.console.staff import StaffLines
from tangy_tui.console.typed_yes import TypedYes
from tangy_tui.learning.policies import load_policy
from tangy_tui.monitoring import supervision
from tangy_tui.text.freezes import stood_words

FROZEN = 42.0  # s
STEPS = 3


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


class FrozenOnce(FreezeWatch):
    """Finds the freeze at the look before one of the steps."""

    def __init__(self, control: GameController) -> None:
        super().__init__()
        self._control, self._found = control, False

    def tick(self) -> float:
        if self._found or self._control.supervision.steps < STEPS:
            return 0.0
        self._found = True
        return FROZEN


def frozen_game(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch, told: Event, *, typed: bool
) -> list[str]:
    """Play a game that freezes, and of which no line comes after `told`; return the output."""
    learnt, _ = load_policy(workspace.store, workspace.activity)
    control = GameController(workspace.supervision(learnt, 4, asks=True), "Ada")
    written, ticks, steps = list[str](), count(), list[int]()
    step = control.supervision.step

    def counted() -> list[supervision.Event]:
        steps.append(len(written))
        return step()

    monkeypatch.setattr(control.supervision, "step", counted)

    def read() -> None:
        told.wait(20)

    games = StaffLines(
        control, workspace.name, str, read, written.append,
        yes=TypedYes(
            terminal=typed, session=TerminalSession, flush=lambda: None, clock=lambda: next(ticks)
        ),
        watch=FrozenOnce(control),
    )  # fmt: skip
    games.run(1)
    assert len(steps) == STEPS
    return written


def test_no_step_is_taken_after_a_freeze_until_staff_say_so(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    told = Event()
    told.set()
    assert stood_words(FROZEN) in frozen_game(workspace, monkeypatch, told, typed=False)
    first = next(event.record for event in workspace.store.events(StaffAction))
    assert (first.did, first.detail) == ("program frozen", "42")


def test_a_person_who_types_is_asked_after_a_freeze(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    told, asked = Event(), list[GameCommand]()

    def ask(self: ConfirmingStaff, command: GameCommand, typed: object) -> bool:
        asked.append(command)
        told.set()
        return True

    monkeypatch.setattr(ConfirmingStaff, "ask", ask)
    written = frozen_game(workspace, monkeypatch, told, typed=True)
    assert stood_words(FROZEN) in written and asked == [GoOn()]
