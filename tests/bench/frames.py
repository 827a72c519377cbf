"""Bytes that the room writes to the terminal: while the robot moves at 10 Hz, and while it stands.

Run by hand: `python tests/bench/frames.py [--rounds N]`. A child shows a room that fills the
window, with a focused command bar, in a real pty; keys make the robot move for
five seconds, back and forth, and the output is counted. Then nothing happens for three seconds.
CPU is the child's user and system time over the walks, of one core.
"""

from __future__ import annotations

import fcntl
import os
import pty
import select
import struct
import subprocess
import sys
import termios
from dataclasses import dataclass
from pathlib import Path
from time import monotonic

SIZES = ((120, 40), (80, 24), (160, 45))
WALK_SECONDS = 5.0
IDLE_SECONDS = 3.0
HERTZ = 10
MOST_BYTES = 600
"""The limit of a frame's average size at 120 x 40."""

SYNC_QUERY = b"\x1b[?2026$p"
SYNC_YES = b"\x1b[?2026;2$y"


@dataclass(frozen=True)
class Measured:
    """The cost of one window size."""

    bytes_a_frame: float
    painted_frames: int
    idle_bytes: int
    cpu_share: float


class Child:
    """The demo in its own pty."""

    def __init__(self, columns: int, lines: int, environ: dict[str, str]) -> None:
        self.terminal, child = pty.openpty()
        fcntl.ioctl(child, termios.TIOCSWINSZ, struct.pack("HHHH", lines, columns, 0, 0))
        self.process = subprocess.Popen(  # noqa: S603 - our own program
            [sys.executable, __file__, "--child"],
            stdin=child,
            stdout=child,
            stderr=child,
            env={**os.environ, "LANG": "C.UTF-8", "LC_ALL": "C.UTF-8", **environ},
            start_new_session=True,
        )
        os.close(child)

    def read(self, seconds: float) -> list[bytes]:
        """Collect the output of some seconds, one piece for each write."""
        until = monotonic() + seconds
        pieces: list[bytes] = []
        while (left := until - monotonic()) > 0:
            if select.select([self.terminal], [], [], left)[0]:
                try:
                    piece = os.read(self.terminal, 1 << 16)
                except OSError:  # it has ended
                    break
                if SYNC_QUERY in piece:
                    os.write(self.terminal, SYNC_YES)
                pieces.append(piece)
        return pieces

    def press(self, keys: bytes) -> None:
        """Type keys."""
        os.write(self.terminal, keys)

    def cpu(self) -> float:
        """Return the seconds of CPU it has used."""
        stat = Path(f"/proc/{self.process.pid}/stat").read_text(encoding="ascii")
        fields = stat.rsplit(") ", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def end(self) -> int:
        """Leave by ctrl+c and return the exit status."""
        self.press(b"\x03")
        self.read(1.0)
        status = self.process.wait(10)
        os.close(self.terminal)
        return status


def measure(columns: int, lines: int, rounds: int, environ: dict[str, str]) -> Measured:
    """Let the robot move and stand in a window of this size."""
    child = Child(columns, lines, environ)
    child.read(3.0)
    begun = child.cpu()
    written = painted = 0
    for _ in range(rounds):
        child.press(b"\x07")  # ctrl+g: walk on
        pieces = child.read(WALK_SECONDS + 0.3)
        written += sum(map(len, pieces))
        painted += len(pieces)
    cpu = child.cpu() - begun
    child.read(0.5)
    idle = sum(map(len, child.read(IDLE_SECONDS)))
    status = child.end()
    if status:
        raise SystemExit(f"the demo ended with {status}")
    frames = rounds * WALK_SECONDS * HERTZ
    return Measured(written / frames, painted, idle, cpu / (rounds * (WALK_SECONDS + 0.3)))


def main() -> int:
    """Print the table; the exit status is 1 if a limit is exceeded."""
    rounds = int(sys.argv[sys.argv.index("--rounds") + 1]) if "--rounds" in sys.argv else 4
    kinds = {
        "true colour": {"TERM": "xterm-256color", "COLORTERM": "truecolor"},
        "256 colours": {"TERM": "xterm-256color", "COLORTERM": ""},
        "ANSI": {"TERM": "xterm", "COLORTERM": ""},
    }
    print(f"{'window':>9} {'colours':<12} {'bytes/frame':>11} {'idle B/s':>9} {'CPU':>6}")
    kept = True
    for columns, lines in SIZES:
        for name, environ in kinds.items():
            got = measure(columns, lines, rounds, environ)
            print(
                f"{columns:>4} x {lines:<2} {name:<12} {got.bytes_a_frame:>11.0f} "
                f"{got.idle_bytes / IDLE_SECONDS:>9.1f} {got.cpu_share:>6.1%}",
                flush=True,
            )
            kept = kept and not got.idle_bytes
            kept = kept and (columns != 120 or got.bytes_a_frame <= MOST_BYTES)
    print(f"limits: {MOST_BYTES} bytes a frame at 120 x 40, 0 bytes/s idle:", end=" ")
    print("kept" if kept else "NOT KEPT")
    return 0 if kept else 1


def show_demo() -> int:
    """Run as the child: a room and a command bar; ctrl+g moves the robot to the next place."""
    from typing import ClassVar

    from textual.app import ComposeResult
    from textual.binding import Binding, BindingType

    from tangy_profiles.person import load_people
    from tangy_profiles.room import load_room
    from tangy_profiles.scene import Scene
    from tangy_profiles.state import FRONT
    from tangy_tui.ui.app import TangyApp, run_app
    from tangy_tui.ui.base import TangyScreen
    from tangy_tui.ui.terminal import terminal_kind
    from tangy_tui.ui.widgets.command_bar import CommandBar
    from tangy_tui.ui.widgets.room_view import RoomView
    from tangy_tui.ui.widgets.status_line import Status, StatusLine

    class Demo(TangyScreen[None]):
        AUTO_FOCUS = "#command-input"
        BINDINGS: ClassVar[list[BindingType]] = [Binding("ctrl+g", "walk", priority=True)]
        way: ClassVar[list[str]] = ["user1", "user4", FRONT, "user3"]

        def compose(self) -> ComposeResult:
            yield StatusLine(Status("bench", "OK", "help", 1, 1))
            yield RoomView(load_room(), load_people(4), classes="panel")
            yield CommandBar()

        def on_mount(self) -> None:
            doing = {f"user{n}": "marks B7" for n in range(1, 5)}
            self.query_one(RoomView).show(Scene(FRONT, ("user2",), doing, (7, 22), None))

        def action_walk(self) -> None:
            self.way.append(self.way.pop(0))
            self.query_one(RoomView).drive(self.way[-1], WALK_SECONDS)

    return run_app(TangyApp(Demo, kind=terminal_kind()))


if __name__ == "__main__":
    sys.exit(show_demo() if "--child" in sys.argv else main())
