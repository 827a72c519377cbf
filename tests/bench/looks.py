"""What Tangy says when single looks are late, misread or unreadable.

Run by hand: `python tests/bench/looks.py [--games 500][--share .05]` (minutes). Only the
looks are wrong in these games, so each reported fault is a false alarm; an accusation is
a request to a person to correct a card that was right.
"""

from __future__ import annotations

import argparse
from collections import Counter
from time import perf_counter
from typing import Any

from rich.console import Console
from rich.table import Table

from tangy_tui.experiments.classroom import RANDOM, Course, activity_of
from tangy_tui.experiments.supervised import people_of, supervised
from tests.support.games import play
from tests.support.odd_looks import ODD, OddCards, OddStates, OddWorld

WORLDS: dict[str, type[OddWorld]] = {"a card": OddCards, "all that is observed": OddStates}
LESSONS = (0, 1, 2, 3, 4)
"""The seeds of the triples of demonstrations, whose games are random."""


def played(kind: type[OddWorld], odd: str, share: float, games: int) -> dict[str, Any]:
    """Play games with odd looks of one kind.

    Returns:
        The number of `games`, `looks` and odd ones, how often a person was `accused`, how
        often Tangy only `asked`, how many were `stopped`, and how often each code was diagnosed.
    """
    found: Counter[str] = Counter()
    codes: Counter[str] = Counter()
    for lesson in LESSONS:
        with supervised(Course("bingo", 4, RANDOM, lesson)) as workspace:
            seed = 1_000 * lesson + 7
            people = people_of(workspace)
            world = kind(activity_of(workspace.activity), people, seed=seed, odd=odd, share=share)
            game = workspace.games(world, seed)
            for _ in range(-(-games // len(LESSONS))):
                play(game)
                found["games"] += 1
                found["stopped"] += not world.over
                found["asked"] += sum(fault.asks_only for fault in game.faults)
                codes.update(fault.code for fault in game.faults if not fault.asks_only)
            found.update(looks=world.looks, odd=world.odd_looks, accused=world.accused)
    return {**found, "codes": dict(codes)}


def main() -> None:
    """Measure, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--games", type=int, default=500)
    parser.add_argument("--share", type=float, default=0.05)
    asked = parser.parse_args()
    began = perf_counter()
    table = Table(title=f"Games in which {asked.share:.0%} of looks are odd", title_justify="left")
    for column in ("a look at", "is", "games", "looks", "odd", "accused", "only asked", "stopped"):
        table.add_column(column)
    table.add_column("alarms")
    for (words, kind), odd in ((one, odd) for one in WORLDS.items() for odd in ODD):
        found = played(kind, odd, asked.share, asked.games)
        told = ", ".join(f"{code} {n}" for code, n in sorted(found["codes"].items())) or "none"
        numbers = ("games", "looks", "odd", "accused", "asked", "stopped")
        table.add_row(words, odd, *(str(found.get(name, 0)) for name in numbers), told)
    console = Console(width=150)
    console.print(table)
    console.print(f"{perf_counter() - began:.0f} s.")


if __name__ == "__main__":
    main()
