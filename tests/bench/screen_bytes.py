"""Bytes that teaching writes to the terminal: for a question, its answer, help and the palette.

Run by hand: `python -m tests.bench.screen_bytes`. The program runs in a real pty of each size.
After a few steps each action is done three times; the bench counts the bytes until
half a second passes without output. The largest of the three counts.
"""

from __future__ import annotations

import tempfile

from tests.support.terminal import TANGY, Terminal

SIZES = ((80, 24), (120, 40))
QUIET, READING = 0.5, 2.0  # s
TIMES = 3


def measured(columns: int, lines: int) -> dict[str, int]:
    """Return the bytes of each action at a size in columns and lines."""
    with tempfile.TemporaryDirectory() as folder:
        command = [TANGY, "--data", folder, "teach", "--teacher", "ann", "--seed", "3"]
        terminal = Terminal(command, columns=columns, lines=lines)
        try:
            terminal.until("type a command")
            terminal.settle(1.0)
            cost: dict[str, int] = {}

            def count(what: str, keys: str, seen: str) -> None:
                before = len(terminal.raw)
                terminal.type(keys)
                terminal.until(seen)
                terminal.settle(QUIET)
                cost[what] = max(cost.get(what, 0), len(terminal.raw) - before)

            for number in range(TIMES):
                phrase, question = ("call number", "Did you say: call number")
                if not number:
                    phrase, question = ("greet everyone", "Did you say: greet everyone")
                terminal.type(phrase)
                terminal.settle(QUIET)
                count("question", "\r", question)
                terminal.settle(READING)
                count("answer", "y", f"step {number + 1}")
            for _ in range(TIMES):
                count("help", "\x1bOP", "Help")
                count("help closed", "\x1b", "type a command")
                count("palette", "\x10", "Search")
                count("palette closed", "\x1b", "type a command")
        finally:
            terminal.end()
    return cost


def main() -> None:
    """Print a table."""
    found = {size: measured(*size) for size in SIZES}
    heads = " | ".join(f"{columns} x {lines}" for columns, lines in SIZES)
    print(f"| what | {heads} |\n|---|{'---|' * len(SIZES)}")
    for what in next(iter(found.values())):
        print(f"| {what} | {' | '.join(f'{found[size][what]:,}' for size in SIZES)} |")


if __name__ == "__main__":
    main()
