"""How games of the shipped activities end on the bench, Tangy's questions, and diagnosed faults.

Run by hand: `python -m tests.bench.activity_games [--seed N] [--games N] [--people N] [NAME...]`.
NAME is an activity or its file. A scripted teacher shows each activity in two guided games. Then
the learnt policy plays with simulated devices and the given number of people; each game has its
own seed. No fault is injected: each fault in the table is a false alarm or a defect of the
bench. `asked` counts Tangy's questions to the teacher.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import time
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tangy_profiles.activity import shipped_activities
from tests.support.terminal import TANGY

PEOPLE = (1, 2, 4, 12)
TAUGHT = 4  # people in the guided games
LONGEST = 3600.0  # s
HEAD = ("activity", "people", "seed", "finished", "asked", "steps", "minutes", "faults")


def tangy(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Run Tangy on a data folder, and return its output."""
    command = [TANGY, *words, "--data", str(folder)]
    return subprocess.run(command, text=True, capture_output=True, timeout=LONGEST)  # noqa: S603


def teach(folder: Path, activity: str, seed: int) -> None:
    """Show an activity in two guided games, and learn it."""
    to = ("--activity", activity)
    shown = tangy(
        folder, "teach", "--teacher", "scripted", "--guided", "--games", "2",
        "--users", str(TAUGHT), "--seed", str(seed), *to,
    )  # fmt: skip
    learnt = tangy(folder, "learn", *to)
    if shown.returncode or learnt.returncode:
        raise SystemExit(f"{activity} could not be taught: {shown.stderr}{learnt.stderr}")


def play(folder: Path, activity: str, people: int, seed: int) -> tuple[Any, ...]:
    """Play a game on the bench, and return its row of the table."""
    began = time.monotonic()
    try:
        played = tangy(
            folder, "live", "--bench", "--headless", "--json", "--teacher", "scripted",
            "--expert", "scripted", "--activity", activity, "--users", str(people),
            "--seed", str(seed),
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return activity, people, seed, 0, "-", "-", f"{LONGEST / 60:.1f}", "no end"
    took = (time.monotonic() - began) / 60
    if not played.stdout:
        return activity, people, seed, 0, "-", "-", f"{took:.1f}", played.stderr.strip()[-200:]
    found = json.loads(played.stdout)
    faults = Counter(one.get("fault") or one.get("reason") or "?" for one in found["faults"])
    told = ", ".join(f"{name} {count}" for name, count in faults.items()) or "none"
    return (
        activity, people, seed, found["finished"], found["asked"], found["steps"],
        f"{took:.1f}", told,
    )  # fmt: skip


def main() -> None:
    """Teach, play, and print a row for each game."""
    parser = argparse.ArgumentParser()
    parser.add_argument("activities", nargs="*", default=[*shipped_activities()])
    parser.add_argument("--seed", type=int, default=1, help="of the first game")
    parser.add_argument("--games", type=int, default=1, help="with each number of people")
    parser.add_argument("--people", type=int, action="append")
    given = parser.parse_args()
    seed = given.seed
    print("\t".join(HEAD), flush=True)
    for activity in given.activities:
        with TemporaryDirectory() as place:
            teach(Path(place), activity, seed)
            for people in given.people or PEOPLE:
                for _ in range(given.games):
                    print(*play(Path(place), activity, people, seed), sep="\t", flush=True)
                    seed += 1


if __name__ == "__main__":
    main()
