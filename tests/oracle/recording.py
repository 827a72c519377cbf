"""Runs the program that is installed beside this Python, and records its output as text files."""

from __future__ import annotations

import os
import re
import shutil
import sqlite3
import subprocess
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.oracle.normal import Names
from tests.oracle.screens import SCREENS, Scene, show
from tests.support.terminal import TANGY

TEACHING = (
    "greet everyone\ny\ncall number\ny\ncal number\nn\ncall number\ny\nwhy\nwhat can I say\nundo\n"
    "redo\nnow\nseen\nsteps\nhelp\nstop\nnonsense words\ntell a joke\ny\nquit\n"
)
"""Lines of a teacher who also makes mistakes, asks, and takes a step back."""

DRILL = "0\n1\nn\n" * 12 + "1\n1\ny\n" * 12
FAULTS = ("base-stuck@12", "voice-dead~0.02", "never-complies@20", "camera-frozen~0.01")

Answer = tuple[str, list[str], str]
"""Name of the file, words of the command, and its standard input."""


def record(folder: Path, *, seeds: int, live: int, jobs: int) -> None:
    """Write the recording to an empty folder.

    Raises:
        FileExistsError: the folder is not empty.
    """
    folder.mkdir(parents=True, exist_ok=False)
    scripted = ["--teacher", "scripted"]
    tasks: list[Callable[[], None]] = [partial(_helps, folder)]
    for seed in range(1, seeds + 1):
        tasks.append(partial(_run, folder / f"seed-{seed:02}", _seed_commands(seed)))
    games = ["live", "--bench", "--headless", "--json", *scripted, "--expert", "scripted"]
    taught: list[Answer] = [
        ("teach", ["teach", *scripted, "--guided", "--seed", "1", "--json"], ""),
        ("learn", ["learn", "--json"], ""),
    ]
    for seed in range(1, live + 1):
        commands = [*taught, ("live", [*games, "--seed", str(seed)], "")]
        tasks.append(partial(_run, folder / f"live-{seed:02}", commands))
    tasks.append(partial(_run, folder / "experiments", EXPERIMENTS))
    tasks += [partial(_screens, folder / "screens", scene) for scene in SCREENS]
    with ThreadPoolExecutor(jobs) as pool:
        for count, _ in enumerate(pool.map(lambda task: task(), tasks), start=1):
            print(f"\r{count} of {len(tasks)} recorded", end="", flush=True)
    print()


EXPERIMENTS: list[Answer] = [
    (
        "one",
        ["experiment", "1", "--seeds", "2", "--no-typing", "--users", "4", "--jobs", "1", "--json"],
        "",
    ),
    ("two", ["experiment", "2", "--people", "20", "--jobs", "1", "--json"], ""),
    (
        "three",
        ["experiment", "3", "--simulated", "--games", "4", "--jobs", "1", "--json"],
        "",
    ),
]


def _seed_commands(seed: int) -> list[Answer]:
    """Return the commands for one data folder, in order."""
    own = ["--seed", str(seed)]
    scripted = ["--teacher", "scripted"]
    inject = [word for fault in FAULTS for word in ("--inject", fault)]
    return [
        ("plain", ["teach", "--plain", "--new", *own], TEACHING),
        ("teach", ["teach", *scripted, "--games", "3", *own, "--json", "--new"], ""),
        ("guided", ["teach", *scripted, "--guided", *own, "--plain", "--new"], ""),
        ("learn", ["learn", "--json"], ""),
        ("policy", ["policy", "--json"], ""),
        ("policy-words", ["policy"], ""),
        ("policy-why", ["policy", "--why", "wrong marks"], ""),
        ("play", ["play", "--games", "4", "--headless", "--json", *own], ""),
        ("play-words", ["play", "--headless", *own], ""),
        (
            "faults",
            [
                *["play", "--games", "3", "--headless", "--json", "--expert", "scripted"],
                *scripted,
                *inject,
                *own,
            ],
            "",
        ),
        ("drill", ["drill", "--json", "--rounds", "4", "--who", "Ada", *own], DRILL),
        ("drill-words", ["drill", "--plain", "--rounds", "3", "--who", "Ada", *own], DRILL),
        ("demonstrations", ["demonstrations", "list", "--json"], ""),
        ("people", ["people", "list", "--json"], ""),
        ("people-words", ["people", "list"], ""),
        ("log", ["log", "list", "--json"], ""),
        ("log-show", ["log", "show", "last"], ""),
        ("log-report", ["log", "report", "last"], ""),
        ("phrases", ["activity", "phrases"], ""),
    ]


def _run(folder: Path, commands: list[Answer]) -> None:
    """Run commands of the program in a new data folder, and record their output."""
    folder.mkdir()
    with TemporaryDirectory(prefix="tangy-oracle-") as data:
        for name, words, typed in commands:
            names = Names()
            done = _tangy([*words, *_data(words, data)], typed, data)
            said = names.document(done.stdout)
            errors = names.text(done.stderr)
            text = f"exit {done.returncode}\n{said}\n--- stderr\n{errors}"
            (folder / f"{name}.txt").write_text(text, encoding="utf-8")
        (folder / "events.txt").write_text(_events(Path(data)), encoding="utf-8")


def _data(words: list[str], data: str) -> list[str]:
    return [] if words[:2] == ["activity", "phrases"] else ["--data", data]


def _tangy(words: list[str], typed: str, home: str) -> subprocess.CompletedProcess[str]:
    environment = {
        **os.environ,
        "XDG_CACHE_HOME": f"{home}-cache",
        "COLUMNS": "100",
        "LC_ALL": "C.UTF-8",
        "USER": "ada",
        "LOGNAME": "ada",
    }
    done = subprocess.run(  # noqa: S603 - our own program
        [TANGY, *words], input=typed, capture_output=True, text=True, env=environment, check=False
    )
    shutil.rmtree(f"{home}-cache", ignore_errors=True)
    return done


def _events(data: Path) -> str:
    """Return the events of a log, in order."""
    if not (data / "tangy.db").exists():
        return ""
    with sqlite3.connect(data / "tangy.db") as store:
        rows = store.execute(
            "SELECT kind, person, strategy, complied, body FROM event ORDER BY seq"
        ).fetchall()
    return Names().events(rows)


def _helps(folder: Path) -> None:
    """Record the help page of every verb, found by walking from the first page."""
    pages = [_help_page([])]
    for text in pages:
        words = text.splitlines()[0].removeprefix("$ tangy").split()[:-1]
        listed = text.partition("\nCommands:\n")[2]
        below = re.findall(r"^  ([a-z0-9][\w-]*)  ", listed, flags=re.MULTILINE)
        pages += [_help_page([*words, verb]) for verb in below]
    (folder / "help.txt").write_text("\n".join(pages), encoding="utf-8")


def _help_page(words: list[str]) -> str:
    done = _tangy([*words, "--help"], "", "")
    return " ".join(["$ tangy", *words, "--help"]) + "\n" + done.stdout


def _screens(folder: Path, scene: Scene) -> None:
    """Record a scene's text after each of its steps."""
    folder.mkdir(exist_ok=True)
    with TemporaryDirectory(prefix="tangy-oracle-") as data:
        for words in scene.before:
            _tangy([*words, "--data", data], "", data)
        text = Names().text(show(scene, data))
        (folder / f"{scene.name}.txt").write_text(text, encoding="utf-8")
