"""Bytes that the staff screen writes for 4 and for 24 people: a moving robot, and waiting times.

Run by hand: `python -m tests.bench.group_frames`. A child shows the room and the staff panel in a
real pty. The robot moves for some seconds, at ten frames a second; then it stands, and the panel
gets everybody's time of waiting or since the last visit once a second. A quarter of the people
ask for help. The exit status is 1 if 24 people cost more than `MOST` times the bytes of four.
"""

from __future__ import annotations

import sys
from time import monotonic
from typing import ClassVar

from tests.support.terminal import Terminal

SIZES = ((80, 24), (120, 40), (160, 45))
GROUPS = (4, 24)
SECONDS = 10.0
MOST = 1.5


def main() -> int:
    """Print the table."""
    kept = True
    for columns, lines in SIZES:
        costs = [measured(people, columns, lines) for people in GROUPS]
        for what, four, many in zip(("walking", "waiting"), *costs, strict=True):
            kept = kept and many <= MOST * four
            print(f"{columns:>4} x {lines}  {what}: {four:6.0f} and {many:6.0f} bytes/s"
                  f"  x {many / four:.2f}", flush=True)  # fmt: skip
    return 0 if kept else 1


def measured(people: int, columns: int, lines: int) -> tuple[float, float]:
    """Return the bytes/s of a walk, and of the times alone."""
    command = [sys.executable, "-m", "tests.bench.group_frames", "--child", str(people)]
    terminal = Terminal(command, columns=columns, lines=lines)
    try:
        terminal.until("Front")
        terminal.settle(1.0)
        found = []
        for key in ("\x07", "\x0f"):
            before = len(terminal.raw)
            terminal.type(key)
            until = monotonic() + SECONDS
            while (left := until - monotonic()) > 0:
                terminal.read(left)
            found.append((len(terminal.raw) - before) / SECONDS)
            terminal.settle(1.0)
        return found[0], found[1]
    finally:
        terminal.end()


def show(people: int) -> int:
    """Run as the child: ctrl+g moves the robot, ctrl+o lets the times pass."""
    from textual.app import ComposeResult
    from textual.binding import Binding, BindingType
    from textual.containers import Horizontal

    from tangy_profiles.person import load_people
    from tangy_profiles.room import room_for
    from tangy_profiles.scene import Scene
    from tangy_profiles.state import FRONT
    from tangy_tui.app.staff_view import PersonNow
    from tangy_tui.ui.app import TangyApp, run_app
    from tangy_tui.ui.base import TangyScreen
    from tangy_tui.ui.screens.play_view import person_lines
    from tangy_tui.ui.terminal import terminal_kind
    from tangy_tui.ui.widgets.room_view import RoomView
    from tangy_tui.ui.widgets.staff_panel import StaffPanel
    from tangy_tui.ui.widgets.status_line import Status, StatusLine

    everybody = load_people(people)
    ids = [person.id for person in everybody]
    asking = tuple(ids[::4])

    class Staff(TangyScreen[None]):
        DEFAULT_CSS = "Staff Horizontal { height: 1fr; } Staff StaffPanel { width: 1fr; }"
        BINDINGS: ClassVar[list[BindingType]] = [
            Binding("ctrl+g", "walk", priority=True),
            Binding("ctrl+o", "wait", priority=True),
        ]
        seconds = 0

        def compose(self) -> ComposeResult:
            yield StatusLine(Status("bench", "OK", "help", 1, 1))
            with Horizontal():
                yield RoomView(room_for(people), everybody)
                yield StaffPanel()

        def on_mount(self) -> None:
            doing = dict.fromkeys(ids, "marks B7")
            self.query_one(RoomView).show(Scene(FRONT, asking, doing, (7, 22), None))
            self.call_after_refresh(self.tick)

        def action_walk(self) -> None:
            self.query_one(RoomView).drive(ids[-1], SECONDS)

        def action_wait(self) -> None:
            self.set_interval(1.0, self.tick)

        def tick(self) -> None:
            self.seconds += 1
            now = [self._now(number, id) for number, id in enumerate(ids)]
            lines = person_lines(now, lambda id: f"User {id.removeprefix('user')}")
            clock = f"12:{self.seconds % 60:02} so far"
            self.query_one(StaffPanel).show("B7", "Next: call number.", [clock], lines)

        def _now(self, number: int, id: str) -> PersonNow:
            since = float(60 + 7 * number + self.seconds)
            if id in asking:
                return PersonNow(id, "asks", asking.index(id) + 1, since / 2, since)
            return PersonNow(id, "plays", unvisited=since)

    return run_app(TangyApp(Staff, kind=terminal_kind()))


if __name__ == "__main__":
    sys.exit(show(int(sys.argv[2])) if "--child" in sys.argv else main())
