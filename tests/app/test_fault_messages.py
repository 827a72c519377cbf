"""Faults and their ends are among the messages that staff can read again."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from types import SimpleNamespace
from typing import Any

from tangy_tui.monitoring.fault import Diagnosed, Moved, RecoveryEvent
from tangy_tui.ui.fault_console import FaultConsole
from tangy_tui.ui.game_picture import write_fault
from tangy_tui.ui.message_history import MessageHistoryApp


class Screen:
    """A screen that keeps what it was told; the log is hidden."""

    display = False

    def __init__(self) -> None:
        self.app = self
        self.remembered, self.notified = list[str](), list[str]()

    def query_one(self, widget: object) -> Any:
        return self

    def write(self, sentence: str, kind: str = "") -> None:
        """Write to the log."""

    def say(self, sentence: str) -> None:
        """Show words in the room."""

    def remember(self, sentence: str) -> None:
        self.remembered.append(sentence)

    def notify(self, sentence: str, *, markup: bool) -> None:
        self.notified.append(sentence)


def test_a_fault_is_a_message_and_its_end_is_shown() -> None:
    screen: Any = Screen()
    covered: Any = SimpleNamespace(
        asks_only=False, critical=False, name="Laser scanner covered", console="Uncover it.", at=""
    )
    covered.why = "it sees nothing"
    asked = RecoveryEvent("asked", 1.0, attempt=1, speech="Could somebody help?")
    write_fault(screen, Diagnosed(covered), shows_end=True)
    write_fault(screen, Moved(covered, asked), shows_end=True)
    write_fault(screen, Moved(covered, RecoveryEvent("recovered", 2.0)), shows_end=True)
    assert screen.remembered == [
        "Fault, non-critical: Laser scanner covered. Uncover it.",
        "Laser scanner covered: asked for help. Tangy says: Could somebody help?",
    ]
    assert screen.notified == ["Laser scanner covered: this fault has gone."]


def test_a_message_of_a_fault_has_the_time_at_which_it_was_found() -> None:
    app = MessageHistoryApp()
    screen: Any = Screen()
    screen.app, screen.notify = app, lambda words, **_: app.remember(words)
    covered: Any = SimpleNamespace(
        asks_only=False, critical=False, name="Laser scanner covered", console="Uncover it.",
        why="it sees nothing", at="2026-11-28T09:00:00+00:00", seconds=60.0, real_time=True,
    )  # fmt: skip
    write_fault(screen, Diagnosed(covered), shows_end=True)
    write_fault(screen, Moved(covered, RecoveryEvent("recovered", 75.0)), shows_end=True)
    found = datetime(2026, 11, 28, 9, 0, tzinfo=UTC)
    assert [at for at, _ in app.told] == [found, found + timedelta(seconds=15)]


def test_the_words_are_shown_while_tangy_still_speaks() -> None:
    fault = SimpleNamespace(moves=[])
    supervision: Any = SimpleNamespace(over=False, status=("", ""), faults=[fault])
    control: Any = SimpleNamespace(supervision=supervision, by="staff", look=lambda: None)
    told = list[int]()
    screen: Any = None
    workspace: Any = None
    faults = FaultConsole(
        screen, workspace, control, tell=lambda events, known: told.append(1), failed=lambda _: None
    )
    faults.tick()
    assert not told
    fault.moves.append("asked")  # the step that asks has not ended
    faults.tick()
    assert told
