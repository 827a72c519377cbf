"""The last number is said once more, however often staff ask for it meanwhile."""

from __future__ import annotations

import threading
from pathlib import Path

from tangy_tui.app.game_commands import CallAgain
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.workspace import Workspace
from tangy_tui.text.control import noted_words, waits_words
from tests.app.test_interruption import Robot
from tests.support.waiting import wait_until


def test_a_repeat_that_waits_for_its_turn_is_not_said_twice(taught: Path) -> None:
    workspace = Workspace(taught)
    robot = Robot(workspace)
    robot.next(3)
    control, ends = robot.control, threading.Event()
    begun = threading.Event()

    def hold(do: str, time: float) -> None:
        begun.set()
        ends.wait(20.0)

    said = len(robot.link.said)
    robot.link.meanwhile = hold
    step = threading.Thread(target=robot.next, args=(1,))
    step.start()
    assert begun.wait(20.0)
    first = threading.Thread(target=control.apply, args=(CallAgain(),))
    first.start()
    wait_until(lambda: control.repeats_call, "the first one waits")
    (note,) = control.apply(CallAgain())
    assert isinstance(note, StaffNote) and note.kind == "calls again soon"
    assert noted_words(note, str) == waits_words(CallAgain(), str)
    robot.link.meanwhile = lambda do, time: None
    ends.set()
    for thread in (step, first):
        thread.join(20.0)
    (label,) = {robot.link.said[-1]}
    assert robot.link.said[said + 1 :].count(label) == 1
    (note,) = control.apply(CallAgain())
    assert isinstance(note, StaffNote) and note.kind == "call again"
    workspace.close()
