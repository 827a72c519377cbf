"""Games that are killed at random moments and resumed: what differs, and how soon they go on.

A game is played by the program itself (`tangy play --plain`, or `tangy live --bench --headless`)
and killed with SIGKILL at a random line of its output, after a random delay. Its output up to then
was acknowledged, so the log must have it. Then the game is resumed as by `--resume`, and its
state, deck, calls, requests and beliefs are compared with the log of the same game without a
kill (simulated), or with the killed log itself (bench, whose games are never the same twice).

A game on the bench is killed up to `LEGS` times, each time while it goes on after the last kill.
Its log must begin with its entries at each kill, repeat no number, and keep the order of an
unkilled game of the same seed. One of `ENDS` games is then played to its end: the beliefs that the
program prints must be those of the logged responses.

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
from pathlib import Path

from tangy_profiles.game_world import BENCH, SIMULATED
from tangy_tui.text.command_line import SWITCHING_ON
from tests.bench.kill_checks import Found, compare, compare_end, compare_order, logged, steps_in

TANGY = (sys.executable, "-P", "-c", "from tangy_tui.cli import main; main()")
STEP = re.compile(r"^ *(\d+)\.? (?=\w)")
"""A line that reports an executed and stored step."""
LATEST = 0.02  # s after a line until the kill
START = 120.0  # s until the program's first output, on a busy machine
LEGS = 5  # kills of one game on the bench
FURTHER = 10  # at most this many steps, less one, from a resumption until the next kill
ENDS = 4  # one in this many games on the bench is played to its end


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
    """Yield the program's lines as they come."""
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
    """Run a game, and kill it some s after a number of reported steps; return how many it reported.

    Return None if it was over before.
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
                    os.killpg(process.pid, signal.SIGKILL)  # its children end with it
                killed = True
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    return told if killed else None


def restarted(folder: Path, *, bench: bool) -> tuple[float, float]:
    """Start the program with `--resume`; return after how many s the game is ready.

    A simulated game is then paused. On the bench the game has been read, and the robot's devices
    start next. The second number is the CPU time in s: for the rest the program waited
    for the machine.
    """
    words = ["live", "--bench"] if bench else ["play", "--speed", "1000"]
    there = SWITCHING_ON if bench else "paused"
    began = time.monotonic()
    process = subprocess.Popen(  # noqa: S603
        [*TANGY, *words, "--plain", "--resume", "--data", str(folder)],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        start_new_session=True,
    )  # fmt: skip
    try:
        for line in lines_of(process):
            if there in line:
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
    """Kill games and resume them; return the differences.

    Args:
        kills: how many.
        bench: on the bench of simulated devices; else in simulation.
        seed: for the moments and the games.
        scratch: an empty folder.
        every: one in this many killed simulated games is played to its end.
    """
    rng = random.Random(seed)
    taught = taught_folder(scratch / "taught")
    found, whole = Found(), dict[int, list[object]]()
    games = 0
    while found.kills < kills:
        games += 1
        game = seed if bench else 1 + (seed + games) % 5
        if game not in whole:
            folder = shutil.copytree(taught, scratch / f"whole-{game}")
            play_to_the_end(folder, game, bench=bench)
            whole[game], over = logged(folder)
            assert over
        folder = shutil.copytree(taught, scratch / f"killed-{games}")
        if bench:
            kill_again_and_again(folder, game, rng, whole[game], found, kills)
            if games % ENDS == 0 and (left := logged(folder)) and not left[1]:
                printed = play_to_the_end(folder, game, bench=True, resume=True)
                compare_end(folder, left[0], whole[game], json.loads(printed)["beliefs"], found)
        else:
            kill_once(folder, game, rng, whole[game], found)
            if found.kills % every == 0 and (left := logged(folder)) and not left[1]:
                play_to_the_end(folder, game, bench=False, resume=True)
                after, over = logged(folder)
                found.played_on += over and after[: len(left[0])] == left[0]
        shutil.rmtree(folder)
        print(json.dumps(found.document()), file=sys.stderr, flush=True)
    return found


def play_to_the_end(folder: Path, seed: int, *, bench: bool, resume: bool = False) -> str:
    """Play a game of a seed to its end, or an interrupted one; return the program's output."""
    command = playing(folder, seed, bench=bench, resume=resume) + (["--json"] if bench else [])
    done = subprocess.run(  # noqa: S603
        command, input="go on\n", stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False,
        text=True,
    )  # fmt: skip
    return done.stdout


def kill_once(
    folder: Path, game: int, rng: random.Random, whole: list[object], found: Found
) -> None:
    """Kill a simulated game, and compare it with the unkilled one."""
    steps, delay = rng.randrange(1, len(steps_in(whole))), rng.uniform(0, LATEST)
    told = kill_at(playing(folder, game, bench=False), steps, delay)
    events, over = logged(folder)
    if told is None or over:  # it ended before it could be killed
        return
    count(found, told, events)
    if events != whole[: len(events)]:
        found.differs("the log before the kill")
    compare(folder, SIMULATED, found)
    note_restart(found, folder, bench=False)


def kill_again_and_again(
    folder: Path, game: int, rng: random.Random, whole: list[object], found: Found, kills: int
) -> None:
    """Kill a game on the bench, again after each resume."""
    before: list[object] = []
    for leg in range(min(LEGS, kills - found.kills)):
        steps = len(steps_in(before)) + rng.randrange(1, FURTHER)
        command = playing(folder, game, bench=True, resume=leg > 0)
        told = kill_at(command, steps, rng.uniform(0, LATEST))
        events, over = logged(folder)
        if events[: len(before)] != before:
            found.differs("the log before an earlier kill")
        if told is None or over:
            break
        before = events
        count(found, told, events)
        compare_order(events, whole, found)
        compare(folder, BENCH, found)
        note_restart(found, folder, bench=True)


def count(found: Found, told: int, events: Sequence[object]) -> None:
    """Count a kill, and the steps that the program reported and its log has."""
    steps = len(steps_in(events))
    found.kills += 1
    found.at_steps.append(steps)
    found.acknowledged += told
    found.lost += max(0, told - steps)


def note_restart(found: Found, folder: Path, *, bench: bool) -> None:
    """Note the time of a restart."""
    took, computed = restarted(folder, bench=bench)
    found.restarts.append(took)
    found.computed.append(computed)


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
