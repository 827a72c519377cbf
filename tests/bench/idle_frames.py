"""Frames that the program writes to the terminal, and how many of them change no cell.

Run by hand: `python -m tests.bench.idle_frames [SECONDS]`. Each session runs in a pty of 80 x 24
and of 120 x 40: teaching with questions, help, palette, undo and library; a simulated game and a
second console that watches it; a live game on the bench. A frame counts as idle if it leaves
every cell and the cursor as they were before.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from tests.support.frames import FramedTerminal, Frames, frames_of
from tests.support.terminal import TANGY

SIZES = ((80, 24), (120, 40))
SECONDS = 30.0
REMARKED = ("esc go on", "esc decide later")
"""The end of the screen while it shows a remark on a step."""
COMMANDS = ("greet everyone", *["call number"] * 4, "tell a joke", "call number")


def teaching(folder: Path, size: tuple[int, int], seconds: float) -> dict[str, Frames]:
    """Teach some steps, take some back, and look at everything that can be opened."""
    terminal = _opened(folder, size, "teach", "--teacher", "ann", "--seed", "3")
    try:
        terminal.until("type a command")
        for command in COMMANDS:
            terminal.type(command)
            terminal.settle(0.3)
            terminal.type("\r")
            terminal.until("Did you say")
            terminal.settle(0.5)
            terminal.type("y")
            terminal.until(lambda text: "Did you say" not in text)
            terminal.settle(1.0)
            if any(" ".join(terminal.text.split()).endswith(end) for end in REMARKED):
                terminal.type("\x1b")
                terminal.settle(1.0)
        for keys in ("\x1a", "\x19", "\x1bOP", "\x1b", "\x10", "\x1b", "\t", "\t", "\x15", "\x1b[A",
                     "\x0f", "\x0f", "\x1b[17~", "\x1b[B", "\x1b", "\x0c"):  # fmt: skip
            terminal.type(keys)
            terminal.settle(0.7)
        return {"teaching": frames_of(terminal.raw, *size)}
    finally:
        terminal.end()


def playing(folder: Path, size: tuple[int, int], seconds: float) -> dict[str, Frames]:
    """Play a simulated game, look at its decisions, and watch it from a second console."""
    terminal = _opened(folder, size, "play", "--seed", "5", "--speed", "20")
    watching: FramedTerminal | None = None
    try:
        terminal.until("STOP")
        watching = _opened(folder, size, "watch")
        for keys in ("", "u", "\t", "p", "p", "u", "?", "\x1b"):
            terminal.type(keys)
            for _ in range(10):
                terminal.watch(seconds / 160)
                watching.watch(seconds / 160)
        found = {"playing": frames_of(terminal.raw, *size)}
        return found | {"watching": frames_of(watching.raw, *size)}
    finally:
        terminal.end()
        if watching is not None:
            watching.end()


def live(folder: Path, size: tuple[int, int], seconds: float) -> dict[str, Frames]:
    """Play a live game on the bench."""
    terminal = _opened(folder, size, "live", "--bench", "--begin", "--seed", "5")
    try:
        terminal.until("STOP")
        for keys in ("", "u", "p", "p", "u"):
            terminal.type(keys)
            terminal.watch(seconds / 5)
        return {"live": frames_of(terminal.raw, *size)}
    finally:
        terminal.type("\x03")
        terminal.watch(1.0)
        terminal.type("y")
        terminal.watch(5.0, lambda: terminal.process.poll() is not None)
        terminal.end()


SESSIONS: tuple[Callable[[Path, tuple[int, int], float], dict[str, Frames]], ...] = (
    teaching,
    playing,
    live,
)


def _opened(folder: Path, size: tuple[int, int], *verb: str) -> FramedTerminal:
    columns, lines = size
    command = [TANGY, *verb, "--data", str(folder)]
    return FramedTerminal(command, columns=columns, lines=lines)


def prepare(folder: Path) -> None:
    """Teach a game by script, and learn from it."""
    import subprocess

    for verb in (["teach", "--teacher", "scripted", "--seed", "1"], ["learn"]):
        subprocess.run([TANGY, *verb, "--data", str(folder)], check=True, capture_output=True)  # noqa: S603


def main() -> None:
    """Print a table."""
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else SECONDS
    print("| session | size | frames | idle | bytes |\n|---|---|---|---|---|", flush=True)
    for size in SIZES:
        for session in SESSIONS:
            with tempfile.TemporaryDirectory() as folder:
                prepare(Path(folder))
                for name, found in session(Path(folder), size, seconds).items():
                    row = f"| {name} | {size[0]} x {size[1]} | {found.all} | {len(found.idle)} "
                    print(f"{row}| {found.bytes:,} |", flush=True)
                    for frame in sorted(set(found.idle))[:6]:
                        print(f"  {frame!r}", flush=True)


if __name__ == "__main__":
    main()
