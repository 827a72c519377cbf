"""Games that are killed at random moments, and gone on with: what is the same, and how soon.

A game is played by the program itself (`tangy play --plain`, or `tangy live --bench --headless`)
and killed with SIGKILL at a random line of its output, after a random delay. What it said before
was acknowledged: it has to be in the log. Then the game is taken up as `--resume` does, and its
state, deck, calls, requests and beliefs are held against the log of the same game that nobody
killed (simulated), or against the killed log itself (bench, whose games are never the same twice).

    python -m tests.bench.kills --kills 200
    python -m tests.bench.kills --kills 20 --bench
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import random
import re
import selectors
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tangy_profiles.game_records import GameBeginning, GameEnding, GameStep
from tangy_profiles.game_world import BENCH, SIMULATED, GameWorld
from tangy_profiles.people_records import ResponseGiven
from tangy_profiles.store import Store
from tangy_profiles.tracker import Tracker
from tangy_tui.app.interruption import find_interrupted
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policies import load_policy

TANGY = (sys.executable, "-P", "-c", "from tangy_tui.cli import main; main()")
STEP = re.compile(r"^ *(\d+)\.? (?=\w)")
"""A line that tells a step that was carried out, and kept."""
LATEST = 0.02  # s after a line until the kill
START = 120.0  # s until a program says something, on a busy machine
REPLAYED = (GameStep, ResponseGiven)


@dataclass
class Found:
    """What came of killing games: counts, and how long each restart took (s)."""

    kills: int = 0
    acknowledged: int = 0
    lost: int = 0
    not_offered: int = 0
    other: dict[str, int] = field(default_factory=dict)
    """How often something was not the same, by what it was."""
    restarts: list[float] = field(default_factory=list)
    computed: list[float] = field(default_factory=list)
    """How many s of each restart the program was computing."""
    at_steps: list[int] = field(default_factory=list)
    played_on: int = 0
    """How many of the resumed games were played to their end."""

    def differs(self, what: str) -> None:
        """Count something that is not the same."""
        self.other[what] = self.other.get(what, 0) + 1

    def document(self) -> dict[str, object]:
        """Return the figures."""
        return {
            "kills": self.kills,
            "acknowledged_steps": self.acknowledged,
            "lost_steps": self.lost,
            "not_offered": self.not_offered,
            "differences": self.other,
            "restart_s": {"median": share(self.restarts, 50), "p95": share(self.restarts, 95)},
            "computing_s": {"median": share(self.computed, 50), "p95": share(self.computed, 95)},
            "played_on": self.played_on,
            "killed_at_step": [min(self.at_steps, default=0), max(self.at_steps, default=0)],
        }


def share(values: Sequence[float], percent: int) -> float | None:
    """Return the value that so many of 100 are not above; None of none."""
    ordered = sorted(values)
    return round(ordered[-(-percent * len(ordered) // 100) - 1], 2) if ordered else None


def taught_folder(folder: Path) -> Path:
    """Teach and learn, so that games can be played."""
    for words in (("teach", "--teacher", "scripted", "--games", "3"), ("learn",)):
        subprocess.run(  # noqa: S603
            [*TANGY, *words, "--data", str(folder)], check=True, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )  # fmt: skip
    return folder


def playing(folder: Path, seed: int, *, bench: bool, resume: bool = False) -> list[str]:
    """Return the command that plays a game of a seed, step by step."""
    words = ["live", "--bench", "--headless"] if bench else ["play", "--plain", "--speed", "1000"]
    words += ["--resume"] if resume else ["--seed", str(seed)]
    words += ["--teacher", "scripted", "--expert", "scripted"] if bench else []
    return [*TANGY, *words, "--data", str(folder)]


def lines_of(process: subprocess.Popen[bytes]) -> Iterator[str]:
    """Yield the lines that a program says, as they come."""
    assert process.stdout is not None
    rest = b""
    with selectors.DefaultSelector() as ready:
        ready.register(process.stdout, selectors.EVENT_READ)
        while True:
            if not ready.select(START):
                raise AssertionError("the program said nothing more")
            said = os.read(process.stdout.fileno(), 65536)
            if not said:
                return
            *lines, rest = (rest + said).split(b"\n")
            yield from (line.decode(errors="replace") for line in lines)


def kill_at(command: Sequence[str], steps: int, delay: float) -> int | None:
    """Run a game, and kill it so many s after it has told so many steps; return how many it told.

    None where it was over before.
    """
    process = subprocess.Popen(  # noqa: S603
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        start_new_session=True,
    )  # fmt: skip
    told = 0
    killed = False
    try:
        for line in lines_of(process):
            found = STEP.match(line)
            told = int(found[1]) if found else told
            if told >= steps and not killed:
                time.sleep(delay)
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL)  # what it started ends with it
                killed = True
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    return told if killed else None


def logged(folder: Path) -> tuple[list[object], bool]:
    """Return the steps and responses of the last game, in their order, and whether it ended."""
    with Store.open(folder, write=False) as store:
        begun = store.last(GameBeginning)
        if begun is None:
            return [], False
        found: list[object] = []
        over = False
        for event in store.events(GameStep, ResponseGiven, GameEnding, after=begun.seq):
            record = event.record
            if isinstance(record, GameEnding):
                over = True
            elif isinstance(record, GameStep):
                found.append((record.behaviour, record.target, record.strategy, record.numbers,
                              record.state, record.after))  # fmt: skip
            else:
                found.append((event.person, event.strategy, event.complied))
        return found, over


def steps_in(events: Sequence[object]) -> list[tuple[object, ...]]:
    """Return the steps among what was logged."""
    return [event for event in events if isinstance(event, tuple) and len(event) == 6]


def compare(folder: Path, world: GameWorld, found: Found) -> None:
    """Take the killed game up, and count what is not as its log has it."""
    workspace = Workspace(folder)
    try:
        past = find_interrupted(workspace, world)
        if past is None:
            found.not_offered += 1
            return
        activity, people = workspace.activity, past.beginning.people
        last = past.steps[-1].after
        assert last is not None
        tracker = Tracker(activity, people)
        past.follow(tracker, lambda change: None)
        if tracker.state() != last:
            found.differs("state by the tracker")
        draws = {b.name for b in activity.behaviours.values() if b.effect == "draw"}
        called = [n for step in past.steps if step.behaviour in draws for n in step.numbers]
        if past.called(activity) != called:
            found.differs("calls")
        order = past.order(activity.deck.numbers, called)
        if order[: len(called)] != called or sorted(order) != sorted(activity.deck.numbers):
            found.differs("deck")
        if world == SIMULATED:
            policy, _ = load_policy(workspace.store, activity)
            supervision = workspace.supervision(policy, past.beginning.seed)
            counts = workspace.memory(world).responses()
            supervision.begin(past)
            scene = supervision.world.scene()
            if supervision.world.observe() != last:
                found.differs("state of the world")
            if list(scene.called) != called:
                found.differs("calls in the world")
            if list(scene.requests) != [u.id for u in last.users if u.request == "AR"] and sorted(
                scene.requests
            ) != sorted(u.id for u in last.users if u.request == "AR"):
                found.differs("requests")
            believed = supervision.persuasion.beliefs
            for (person, strategy), (yes, no) in counts.items():
                belief = believed[person][strategy]
                if (belief.complied, belief.trials) != (yes, yes + no):
                    found.differs("beliefs")
    finally:
        workspace.close()


def restarted(folder: Path) -> tuple[float, float]:
    """Start the program with `--resume`; return after how many s the game stands there, paused.

    The second number is how many of them it was computing: the rest it waited for the machine.
    """
    began = time.monotonic()
    process = subprocess.Popen(  # noqa: S603
        [*TANGY, "play", "--plain", "--resume", "--speed", "1000", "--data", str(folder)],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        start_new_session=True,
    )  # fmt: skip
    try:
        for line in lines_of(process):
            if "paused" in line:
                took = time.monotonic() - began
                os.killpg(process.pid, signal.SIGKILL)
                _, process.returncode, used = os.wait4(process.pid, 0)
                return took, used.ru_utime + used.ru_stime
        raise AssertionError("it did not go on")
    finally:
        if process.returncode is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def run(kills: int, *, bench: bool, seed: int, scratch: Path, every: int = 10) -> Found:
    """Kill games and take them up again; return what was found.

    Args:
        kills: how many.
        bench: on the bench of simulated devices; else in simulation.
        seed: of the moments, and of the games.
        scratch: an empty folder.
        every: of so many killed games one is played on to its end.
    """
    rng = random.Random(seed)
    taught = taught_folder(scratch / "taught")
    found, whole = Found(), dict[int, list[object]]()
    while found.kills < kills:
        game = 1 + (seed + found.kills) % 5
        if game not in whole and not bench:
            folder = shutil.copytree(taught, scratch / f"whole-{game}")
            subprocess.run(  # noqa: S603
                playing(folder, game, bench=False), check=True, stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            )  # fmt: skip
            whole[game], over = logged(folder)
            assert over
        folder = shutil.copytree(taught, scratch / f"killed-{found.kills}", dirs_exist_ok=True)
        most = len(steps_in(whole[game])) if not bench else 40
        told = kill_at(
            playing(folder, game, bench=bench), rng.randrange(1, most), rng.uniform(0, LATEST)
        )
        events, over = logged(folder)
        if told is None or over:  # it came to its end before it could be killed
            shutil.rmtree(folder)
            continue
        found.kills += 1
        steps = len(steps_in(events))
        found.at_steps.append(steps)
        found.acknowledged += told
        found.lost += max(0, told - steps)
        if not bench and events != whole[game][: len(events)]:
            found.differs("the log before the kill")
        compare(folder, BENCH if bench else SIMULATED, found)
        if not bench:
            took, computed = restarted(folder)
            found.restarts.append(took)
            found.computed.append(computed)
        if found.kills % every == 0:
            subprocess.run(  # noqa: S603
                playing(folder, game, bench=bench, resume=True), input=b"go on\n",
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False,
            )  # fmt: skip
            after, over = logged(folder)
            found.played_on += over and after[: len(events)] == events
        shutil.rmtree(folder)
        if found.kills % 20 == 0:
            print(json.dumps(found.document()), file=sys.stderr, flush=True)
    return found


def main() -> None:
    """Run it, and print the figures as JSON."""
    options = argparse.ArgumentParser()
    options.add_argument("--kills", type=int, default=200)
    options.add_argument("--bench", action="store_true")
    options.add_argument("--seed", type=int, default=1)
    given = options.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        found = run(given.kills, bench=given.bench, seed=given.seed, scratch=Path(scratch))
    print(json.dumps(found.document(), indent=2))


if __name__ == "__main__":
    main()
