"""Every kind of fault with every behaviour, false alarms, pairs of faults, and games full of them.

Run by hand: `python tests/bench/faults.py [--seeds 50] [--games 2000] [--jobs -1]` (minutes). A
fault comes exactly with the behaviour, where it can show. The goals: 99% detected within that
behaviour (a person who follows nothing: within the requests that this takes), the right class
always, the right cause in 95%, and at most .01 false alarms a game. All of it is simulated.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from itertools import product
from time import perf_counter
from typing import Any

from rich.console import Console
from rich.table import Table

from tangy_profiles.behaviour import Behaviour
from tangy_profiles.fault_file import load_faults
from tangy_profiles.robot import load_robot
from tangy_sim.worlds.injection import (
    ASKING,
    CLOSING,
    DRIVING,
    KINDS,
    LOOKING,
    MOVING_ON,
    WAITING,
)
from tangy_tui.experiments.classroom import activity_of
from tangy_tui.experiments.induced import kinds_by_recovery
from tangy_tui.experiments.sweep import Case, Settings, Sweep, Where
from tests.bench import fault_games

SETTINGS: dict[str, Any] = {"activity": "bingo", "users": 4}
LESSONS = (0, 1, 2, 3, 4)
"""The seeds of the triples of demonstrations, whose games are random."""

REASONS = {
    DRIVING: "the robot does not drive with it",
    LOOKING: "Tangy need not see a card for it, or sees none yet",
    ASKING: "it asks nobody to do anything",
    CLOSING: "it closes no request",
    MOVING_ON: "nothing would be otherwise after it (or a request would look stuck)",
    WAITING: "nobody else can wait meanwhile who is seen to ask no more",
}

console = Console(width=190)


def shown(title: str, *columns: str) -> Table:
    """Begin a table."""
    table = Table(title=title, title_justify="left")
    for column in columns:
        first = column in ("", "kind", "other")
        table.add_column(column, justify="left" if first else "right", no_wrap=first)
    return table


def swept(
    name: str, piece: Callable[[Settings, Case], Any], cases: Sequence[Case], jobs: int, **more: Any
) -> list[Any]:
    """Run tasks on all cores."""
    return Sweep(name, piece, {**SETTINGS, **more}, cases).run(Where(jobs=jobs))


def matrix(seeds: int, jobs: int, **more: Any) -> list[dict[str, Any]]:
    """Return a row for each kind with each behaviour."""
    cases = [(kind, 0, seeds) for kind in KINDS]
    return [
        row for rows in swept("matrix", fault_games.matrix, cases, jobs, **more) for row in rows
    ]


def print_matrix(rows: Sequence[Mapping[str, Any]], behaviours: Sequence[Behaviour]) -> None:
    """Print in how many games with the fault it was detected, and how well explained."""
    names = [behaviour.name for behaviour in behaviours]
    table = shown(
        "Detected / came, with the behaviour above; ! where class or cause was not always right",
        "kind", *names, "class", "cause", "false",
    )  # fmt: skip
    impossible: dict[str, list[str]] = {}
    unlucky: list[str] = []
    for kind in KINDS:
        mine = {row["behaviour"]: row for row in rows if row["kind"] == kind}
        cells = []
        for name in names:
            row = mine[name]
            came = row.get("came", 0)
            if not came:
                if row.get("executed") and KINDS[kind].shows in REASONS:
                    impossible.setdefault(KINDS[kind].shows, []).append(f"{kind} / {name}")
                else:
                    unlucky.append(f"{kind} / {name}")
                cells.append("-")
                continue
            wrong = row.get("class", 0) < came or row.get("cause", 0) < came
            cells.append(f"{row.get('detected', 0)}/{came}{'!' if wrong else ''}")
        every = list(mine.values())
        came = fault_games.added(every, "came")
        table.add_row(
            kind, *cells,
            *(f"{fault_games.added(every, what)}/{came}" for what in ("class", "cause")),
            str(fault_games.added(every, "false")),
        )  # fmt: skip
    console.print(table)
    sums = {n: fault_games.added(rows, n) for n in ("came", "detected", "class", "cause", "false")}
    came = sums["came"]
    console.print(
        f"{came} faults: detected within their behaviour {sums['detected'] / came:.4f}, right "
        f"class {sums['class'] / came:.4f}, right cause {sums['cause'] / came:.4f}, "
        f"false alarms {sums['false']}."
    )
    for shows, pairs in impossible.items():
        behaviours_of: dict[str, list[str]] = {}
        for pair in pairs:
            kind, name = pair.split(" / ")
            behaviours_of.setdefault(name, []).append(kind)
        console.print(f"Cannot show - {REASONS.get(shows, shows)}:")
        for name, kinds in behaviours_of.items():
            console.print(f"  {name}: {', '.join(kinds)}")
    console.print(f"Never came up in these games: {', '.join(unlucky) or 'none'}.")
    for row in rows:
        for key, count in row.items():
            if key.startswith("told: "):
                console.print(f"  {row['kind']} with {row['behaviour']}, {key} {count} times")


def print_alarms(games: int, jobs: int) -> None:
    """Print the diagnoses in games without faults."""
    table = shown("Games without faults, after three demonstrations by chance",
                  "", "demonstrations", "games", "behaviours", "only asked", "diagnosed",
                  "false alarms a game")  # fmt: skip
    each = -(-games // len(LESSONS))
    for words, more in (
        ("as usual", {}),
        ("comply with 60%", {"complies": 0.6}),
        ("follow only 60%", {"follows": 0.6}),
    ):
        cases = [(lesson, 1_000 * lesson + 7, each) for lesson in LESSONS]
        every: Counter[str] = Counter()
        for lesson, one in zip(
            LESSONS, swept("alarms", fault_games.alarms, cases, jobs, **more), strict=True
        ):
            every.update(one["codes"])
            false = sum(
                n for code, n in one["codes"].items()
                if not ("follows" in more and code == "never-complies")
            )  # fmt: skip
            told = ", ".join(f"{code} {n}" for code, n in one["codes"].items()) or "nothing"
            table.add_row(
                words, f"seed {lesson}", str(one["games"]), str(one["steps"]), str(one["asked"]),
                told, f"{false / one['games']:.4f}",
            )  # fmt: skip
    console.print(table)


def print_pairs(seeds: int, jobs: int) -> None:
    """Print whether the critical fault comes first, for every pair with another kind."""
    classes = kinds_by_recovery(load_faults(load_robot()))
    others = [kind for name, kinds in classes.items() if name != "expert" for kind in kinds]
    cases = [(a, b, 0, seeds) for a, b in product(classes["expert"], others)]
    rows = swept("pairs", fault_games.pairs, cases, jobs)
    table = shown("Two faults at once: came / both told / the critical one first / both ended",
                  "other", *classes["expert"])  # fmt: skip
    for other in others:
        cells = []
        for critical in classes["expert"]:
            (row,) = [r for r in rows if (r["critical"], r["other"]) == (critical, other)]
            counts = [row.get(name, 0) for name in ("came", "diagnosed", "first", "ended")]
            alike = len(set(counts)) == 1
            cells.append("/".join(map(str, counts)) + ("" if alike else " !") if counts[0] else "-")
        table.add_row(other, *cells)
    console.print(table)
    sums = [fault_games.added(rows, name) for name in ("came", "diagnosed", "first", "ended")]
    console.print(
        f"{sums[0]} pairs came, {sums[1]} with both told, {sums[2]} with the critical one first, "
        f"{sums[3]} with both ended. -: they cannot show with the same behaviour."
    )


def print_crowds() -> None:
    """Print how games full of faults end."""
    table = shown(
        "Twenty games in which every kind may come at every step",
        "", "faults came", "diagnosed", "critical", "left open", "longest game", "ended",
    )  # fmt: skip
    for chance in (0.004, 0.01, 0.03):
        played = fault_games.crowd(SETTINGS, (1, 20, chance))
        table.add_row(
            f"P = {chance} a step",
            *(str(sum(game[name] for game in played))
              for name in ("came", "faults", "critical", "open")),
            str(max(game["steps"] for game in played)),
            ", ".join(f"{n} {how}" for how, n in Counter(g["ended"] for g in played).items()),
        )  # fmt: skip
    console.print(table)


def main() -> None:
    """Measure, and print every table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=50)
    parser.add_argument("--games", type=int, default=2_000)
    parser.add_argument("--jobs", type=int, default=-1)
    asked = parser.parse_args()
    began = perf_counter()
    behaviours = list(activity_of("bingo").behaviours.values())
    usual = matrix(asked.seeds, asked.jobs)
    print_matrix(usual, behaviours)
    reluctant = matrix(asked.seeds, asked.jobs, complies=0.6)
    differs = sum(a != b for a, b in zip(usual, reluctant, strict=True))
    console.print(
        f"With people who comply with 60% of every strategy: {differs} of {len(usual)} cells "
        "differ from this."
    )
    print_alarms(asked.games, asked.jobs)
    print_pairs(max(3, asked.seeds // 5), asked.jobs)
    print_crowds()
    console.print(f"{perf_counter() - began:.0f} s.")


if __name__ == "__main__":
    main()
