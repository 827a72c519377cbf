"""CPU until the first screen is readable, and of `tangy --version`, beside two yardsticks.

The screen is compared with that of the SQL client harlequin, the version with `import typer`.

Run by hand: `python tests/bench/first_paint.py HARLEQUIN` with the path of harlequin's program.
Each is started in a pty of 120 x 40, and a terminal in memory reads its output. When a word of
its first screen is readable there, the bench notes the CPU that the process has used (user and
system, of /proc). The two take turns; the ratio of the medians counts.
"""

from __future__ import annotations

import os
import pty
import select
import signal
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from importlib.util import cache_from_source
from pathlib import Path
from statistics import median
from time import monotonic

import pyte

import tangy_profiles
import tangy_tui

ROUNDS = 7
COLUMNS, LINES = 120, 40
PATIENCE = 120.0  # s, also on a busy machine


def cpu_until(word: str, command: Sequence[str], home: str) -> tuple[float, float]:
    """Return CPU seconds and wall seconds until `word` is readable on the screen."""
    screen = pyte.Screen(COLUMNS, LINES)
    stream = pyte.ByteStream(screen)
    parent, child = pty.openpty()
    import fcntl
    import struct
    import termios

    fcntl.ioctl(child, termios.TIOCSWINSZ, struct.pack("HHHH", LINES, COLUMNS, 0, 0))
    environment = {
        **os.environ,
        "TERM": "xterm-256color",
        "HOME": home,
        "XDG_DATA_HOME": home,
        "LANG": "C.UTF-8",
    }
    begun = monotonic()
    process = subprocess.Popen(  # noqa: S603 - our own two programs
        command, stdin=child, stdout=child, stderr=child, env=environment, start_new_session=True
    )
    os.close(child)
    try:
        while monotonic() - begun < PATIENCE:
            if select.select([parent], [], [], 0.5)[0]:
                stream.feed(os.read(parent, 65536))
            if any(word in line for line in screen.display):
                fields = Path(f"/proc/{process.pid}/stat").read_text().rsplit(") ", 1)[1].split()
                ticks = int(fields[11]) + int(fields[12])
                return ticks / os.sysconf("SC_CLK_TCK"), monotonic() - begun
        shown = "\n".join(line.rstrip() for line in screen.display if line.strip())
        raise SystemExit(f"{command[0]} never showed {word!r}; it shows:\n{shown}")
    finally:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        os.close(parent)


def cpu_of(command: Sequence[str]) -> float:
    """Return CPU seconds (user and system) of a command that ends by itself."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)  # noqa: S603 - our own commands
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{command[0]} failed")
    return used.ru_utime + used.ru_stime


def print_version(tangy: str) -> None:
    """Print the CPU of `tangy --version` beside that of importing typer, which parses its options.

    Neither takes long, so each runs three times as often as a screen.
    """
    mine, theirs = list[float](), list[float]()
    for turn in range(3 * ROUNDS + 1):
        ours, typer = cpu_of([tangy, "--version"]), cpu_of([sys.executable, "-c", "import typer"])
        if turn:
            mine.append(ours)
            theirs.append(typer)
    print(f"  tangy --version {'':30}  {median(mine):7.3f}")
    print(f"  python -c 'import typer' {'':21}  {median(theirs):7.3f}")
    print(f"  ratio of CPU (wanted: at most 1.5) {'':8}   {median(mine) / median(theirs):7.2f}")


def compiled() -> bool:
    """Return whether every module of Tangy has an up-to-date compiled file beside it."""
    folders = [tangy_tui, tangy_profiles]
    sources = [path for one in folders for path in Path(one.__path__[0]).rglob("*.py")]
    pairs = [(path, Path(cache_from_source(str(path)))) for path in sources]
    return not os.environ.get("PYTHONDONTWRITEBYTECODE") and all(
        kept.exists() and kept.stat().st_mtime >= path.stat().st_mtime for path, kept in pairs
    )


def main() -> None:
    """Print the table."""
    if len(sys.argv) != 2:
        raise SystemExit("usage: python tests/bench/first_paint.py PATH_OF_HARLEQUIN")
    if not compiled():
        raise SystemExit(
            "Tangy has no compiled bytecode, or may not read it, and would compile itself at each "
            "start: run python -m compileall on its folders, without PYTHONDONTWRITEBYTECODE."
        )
    tangy = str(Path(sys.executable).parent / "tangy")
    rows: dict[str, list[tuple[float, float]]] = {"tangy": [], "harlequin": []}
    with tempfile.TemporaryDirectory() as home:
        for turn in range(ROUNDS + 1):
            mine = cpu_until("Teach", [tangy, "--data", home + "/data"], home)
            theirs = cpu_until("Catalog", [sys.argv[1]], home)
            if turn:  # the first turn fills the disk cache
                rows["tangy"].append(mine)
                rows["harlequin"].append(theirs)
    print(f"first paint at {COLUMNS} x {LINES}, median of {ROUNDS} turns   CPU s   wall s")
    for name, measured in rows.items():
        print(
            f"  {name:44}  {median(m[0] for m in measured):7.2f}  "
            f"{median(m[1] for m in measured):7.2f}"
        )
    ratio = median(m[0] for m in rows["tangy"]) / median(m[0] for m in rows["harlequin"])
    print(f"  ratio of CPU (wanted: at most .40) {'':8}  {ratio:7.2f}")
    print_version(tangy)


if __name__ == "__main__":
    main()
