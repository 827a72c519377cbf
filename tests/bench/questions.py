"""How often a blind yes is accepted, and a seen one is not, over links and multiplexers.

Run by hand: `python -m tests.bench.questions [--times N] [NAME...]`. A person sits at the far end
of a relay with a delay each way, jitter and a rate (`tests/support/link.py`). Blindly: they type
`call number`, and `y` at a moment drawn between at once and a round trip later, unless the question
was readable by then. Seen: the yes that the question names, .3 s after it was readable at the far
end (later by the longest hold-up of the terminal's replies by jitter). The bench counts
steps of the demonstration.
"""

from __future__ import annotations

import argparse
import os
import random
import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from tests.support.asking import FROM_HERE, SSH, answered, blind
from tests.support.link import Answerer, FarTerminal, Link
from tests.support.terminal import TANGY, Terminal

A_GAME = 25
"""Calls that fit into a game before anybody may win it."""

READING = 0.3  # s

ASKED = re.compile(r"Type (\S) to do it")
DONE = re.compile(r"Tangy says:")


@dataclass(frozen=True)
class Counted:
    """The counts of one way to the program."""

    name: str
    times: int
    blind: int
    seen: int


HERE = Link()


@dataclass(frozen=True)
class Way:
    """One way to the program: a link, which end answers the terminal's queries, a multiplexer."""

    name: str
    link: Link = HERE
    answerer: Answerer = "far"
    remote: bool = True
    through: str = ""
    plain: bool = False


WAYS = (
    *(Way(f"{delay:g} s", Link(delay)) for delay in (0.0, 0.1, 0.3, 0.6, 1.2)),
    Way("0.3 s, jitter 0.4 s", Link(0.3, jitter=0.4)),
    Way("0.1 s, 2 kB/s", Link(0.1, rate=2000)),
    Way("no replies, 0.3 s", Link(0.3), "nobody"),
    Way("tmux over SSH, 0.3 s", Link(0.3), through="tmux"),
    Way("screen over SSH, 0.3 s", Link(0.3), through="screen"),
    Way("mosh, 0.3 s", Link(0.3), through="mosh"),
    Way("tmux here", Link(), through="tmux", remote=False),
    *(Way(f"lines, {delay:g} s", Link(delay), plain=True) for delay in (0.0, 0.1, 0.3, 0.6, 1.2)),
    Way("lines, 0.3 s, jitter 0.4 s", Link(0.3, jitter=0.4), plain=True),
    Way("lines, 0.1 s, 2 kB/s", Link(0.1, rate=2000), plain=True),
    Way("lines, no replies, 0.3 s", Link(0.3), "nobody", plain=True),
    Way("lines here", Link(), plain=True, remote=False),
)


def command_of(way: Way, folder: Path, seed: int) -> list[str]:
    """Return the command that starts teaching through the multiplexer."""
    tangy = [
        TANGY,
        "--data",
        str(folder),
        "teach",
        "--teacher",
        "ann",
        "--seed",
        str(seed),
        "--new",
    ]
    tangy += ["--plain"] if way.plain else []
    match way.through:
        case "tmux":
            tmux = ["tmux", "-S", str(folder / f"tmux{seed}"), "-f", "/dev/null", "new-session"]
            return [
                *tmux,
                *tangy,
                ";",
                "set",
                "-g",
                "status",
                "off",
                ";",
                "set",
                "-g",
                "escape-time",
                "0",
            ]
        case "screen":
            (folder / "screenrc").write_text("startup_message off\ndefutf8 on\n\n")
            return ["screen", "-U", "-c", str(folder / "screenrc"), *tangy]
        case "mosh":
            server = [shutil.which("mosh-server") or "", "new", "-i", "127.0.0.1", "--", *tangy]
            environment = {**os.environ, **FROM_HERE, "LANG": "C.UTF-8", "LC_ALL": "C.UTF-8"}
            environment["TERM"] = "xterm-256color"
            begun = subprocess.run(server, capture_output=True, text=True, env=environment)  # noqa: S603
            found = re.search(r"MOSH CONNECT (\d+) (\S+)", begun.stdout)
            assert found is not None, begun
            return ["env", f"MOSH_KEY={found[2]}", "mosh-client", "127.0.0.1", found[1]]
    return tangy


def open_far(way: Way, folder: Path, seed: int) -> tuple[FarTerminal, Terminal]:
    """Open the program at the far end of a way."""
    environment = {**FROM_HERE, **(SSH if way.remote and way.through != "mosh" else {})}
    environment["LC_ALL"] = "C.UTF-8"
    environment["SCREENDIR"] = str(folder / "screens")
    (folder / "screens").mkdir(mode=0o700, exist_ok=True)
    terminal = Terminal(command_of(way, folder, seed), environment=environment)
    far = FarTerminal(terminal, way.link, answerer=way.answerer)
    far.until(lambda: ("Now:" if way.plain else "type a command") in far.text)
    far.rest()
    return far, terminal


def lines_blind(far: FarTerminal, terminal: Terminal, times: int, longest: float, seed: int) -> int:
    """Count how often a y typed blindly after a command executes it, by lines."""
    rng = random.Random(seed)
    before = len(DONE.findall(read(terminal.raw)))
    for _ in range(times):
        far.rest()
        asked = len(ASKED.findall(read(terminal.raw)))
        far.type("call number\n")
        far.run(rng.uniform(0, longest))
        if len(ASKED.findall(read(far.arrived))) == asked:
            far.type("y\n")
        far.until(lambda asked=asked: len(ASKED.findall(read(far.arrived))) > asked)  # type: ignore[misc]
        far.rest()
        far.type("n\n")
    far.rest()
    return len(DONE.findall(read(terminal.raw))) - before


def lines_answered(far: FarTerminal, terminal: Terminal, times: int, reading: float) -> int:
    """Count how often the yes that a question names executes a command, by lines."""
    before = len(DONE.findall(read(terminal.raw)))
    for _ in range(times):
        far.rest()
        asked = len(ASKED.findall(read(terminal.raw)))
        far.type("call number\n")
        far.until(lambda asked=asked: len(ASKED.findall(read(far.arrived))) > asked)  # type: ignore[misc]
        far.run(reading)
        far.type(f"{ASKED.findall(read(far.arrived))[-1]}\n")
    far.rest()
    return len(DONE.findall(read(terminal.raw))) - before


def read(written: bytes) -> str:
    """Return the output without its line breaks."""
    return " ".join(written.decode(errors="replace").split())


def counted(way: Way, times: int) -> Counted:
    """Count on one way."""
    longest = 2 * way.link.delay + way.link.jitter + 0.05
    reading = READING + way.link.jitter
    taken = {"blind": 0, "seen": 0}
    for kind in taken:
        left, seed = times, 3
        while left:
            some = min(left, A_GAME)
            with tempfile.TemporaryDirectory() as folder:
                far, terminal = open_far(way, Path(folder), seed)
                try:
                    count: Callable[[], int]
                    if way.plain and kind == "blind":
                        count = partial(lines_blind, far, terminal, some, longest, seed)
                    elif way.plain:
                        count = partial(lines_answered, far, terminal, some, reading)
                    elif kind == "blind":
                        count = partial(blind, far, "y", some, longest, seed)
                    else:
                        count = partial(answered, far, some, reading)
                    taken[kind] += count()
                finally:
                    if way.through:
                        far.type("\x03")  # a multiplexer outlives its terminal
                        far.run(1.0)
                    terminal.end()
            left, seed = left - some, seed + 1
    return Counted(way.name, times, taken["blind"], taken["seen"])


def main() -> None:
    """Run the named ways, or all."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--times", type=int, default=50)
    parser.add_argument("names", nargs="*")
    given = parser.parse_args()
    print("| way | blind y taken | yes taken when seen |\n|---|---|---|", flush=True)
    for way in WAYS:
        if given.names and way.name not in given.names:
            continue
        found = counted(way, given.times)
        print(
            f"| {found.name} | {found.blind} of {found.times} | {found.seen} of {found.times} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
