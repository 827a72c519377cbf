"""What becomes of a robot process that is stopped in a game: dialogs, their causes, and the base.

Run by hand: `python -m tests.bench.stalls [--times N] [--seconds S]... [--stage S]... [--load N]
[--link-delay S] [--link-loss SHARE]`. Games are played on the bench in real time, with staff who
clear what halts the robot, with N busy processes beside them, and over a link of that quality. The
robot's process is stopped for so many s in each stage in turn, N times for each length: while a
number is due, while it drives to a person who asks, and beside that person. A dialog is a critical
fault.
"""

from __future__ import annotations

import argparse
import os
import signal
import threading
import time
from collections import Counter
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from random import Random
from statistics import quantiles
from tempfile import TemporaryDirectory

from tangy_profiles.fault_file import load_faults
from tangy_sim.servers.link_relay import LinkQuality
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.robot_opening import open_bench
from tangy_tui.app.scripted_staff import go_on_by_script
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policies import load_policy
from tangy_tui.learning.scripted_teacher import SCRIPTED
from tangy_tui.monitoring.fault import Diagnosed
from tests.bench.fault_latency import teach
from tests.bench.jitter import busy

RESTS = (2.0, 6.0)  # s between two stalls, by chance
STAGES = ("facilitate", "navigate", "help")
COMES = 120.0  # s in which a stage has to come about
SETTLES = 4.0  # s after a stall in which what comes of it is told


@dataclass
class Stall:
    """One stall: how long it was, in which stage, the dialogs after it, and what the base did.

    If it drove, `told` is after how many s it was told to stand, and `stood` after how many it did.
    """

    seconds: float
    stage: str
    dialogs: list[str] = field(default_factory=list)
    told: float | None = None
    stood: float | None = None

    def look(self, world: BenchedWorld, after: float) -> None:
        """Note what the base does so many s after the stall began."""
        truth = world.truth()
        if self.told is None and not any(truth["commanded"]):
            self.told = after
        if self.stood is None and not truth["moving"]:
            self.stood = after


def play(
    control: GameController, over: threading.Event, held: threading.Event, dialogs: list[str]
) -> None:
    """Play games until it is over; while the process is `held` staff only look."""
    while not over.is_set():
        control.begin()
        while not control.supervision.over and not over.is_set():
            waits = held.is_set() and control.supervision.halted is not None
            events = control.look() if waits else go_on_by_script(control, expert=True)
            for event in events or ():
                if isinstance(event, Diagnosed) and event.fault.critical:
                    dialogs.append(event.fault.code)
            if waits:
                time.sleep(0.05)


def come_to(world: BenchedWorld, stage: str, chance: Random) -> None:
    """Wait until a game is in a stage, and drives where the stage has to do with driving.

    A person asks for help where that is needed. A stage that does not come about is left out: the
    stall says in which one it came.
    """
    until = time.monotonic() + COMES
    asked = stage == STAGES[0]
    while time.monotonic() < until:
        now = world.tracker.state().situation.stage
        if not asked and now == STAGES[0] and not world.over:
            world.bench.do("ask", person=chance.choice(world.people))
            asked = True
        if now == stage and (stage != "navigate" or world.truth()["moving"]):
            return
        time.sleep(0.05)


def stall(world: BenchedWorld, seconds: float, held: threading.Event, dialogs: list[str]) -> Stall:
    """Stop the robot process for so many s, and look what comes of it."""
    pid = world.link.pid
    assert pid is not None
    one = Stall(seconds, world.tracker.state().situation.stage)
    before = len(dialogs)
    moving = any(world.truth()["commanded"])
    held.set()
    os.kill(pid, signal.SIGSTOP)
    began = time.monotonic()
    try:
        while (now := time.monotonic()) < began + seconds:
            if moving:
                one.look(world, now - began)
            time.sleep(0.01)
    finally:
        os.kill(pid, signal.SIGCONT)
    until = time.monotonic() + SETTLES
    while time.monotonic() < until:
        if moving:
            one.look(world, time.monotonic() - began)
        time.sleep(0.02)
        if time.monotonic() > until - SETTLES / 2:
            held.clear()
    one.dialogs = dialogs[before:]
    return one


def spread(found: Sequence[float | None]) -> str:
    """Return how many there are, their median, 95th percentile, and most, in s."""
    there = sorted(one for one in found if one is not None)
    if len(there) < 2:
        return f"{there} s"
    cuts = quantiles(there, n=20, method="inclusive")
    return f"p50 {cuts[9]:.2f} p95 {cuts[18]:.2f} most {there[-1]:.2f} s ({len(there)} times)"


def main() -> None:
    """Play, stop, and print what came of it."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--times", type=int, default=3)
    parser.add_argument("--seconds", type=float, action="append")
    parser.add_argument("--stage", choices=STAGES, action="append")
    parser.add_argument("--load", type=int, default=0, help="busy processes beside it")
    parser.add_argument("--link-delay", type=float, default=0.0, help="s in each direction")
    parser.add_argument("--link-loss", type=float, default=0.0, help="the share of packets lost")
    given = parser.parse_args()
    link = LinkQuality(given.link_delay, given.link_loss)
    lengths = given.seconds or [0.3, 1.0, 4.0, 10.0]
    chance, dialogs = Random(1), list[str]()
    over, held = threading.Event(), threading.Event()
    with TemporaryDirectory() as folder, closing(Workspace(Path(folder))) as workspace:
        teach(workspace)
        policy, _ = load_policy(workspace.store, workspace.activity)
        book = load_faults(workspace.robot)
        with (
            open_bench(
                workspace, seed=1, stepped=False, pace=1.0, book=book, kind=BenchedWorld, link=link
            ) as world,
            busy(given.load),
        ):
            supervision = workspace.supervision(policy, 1, asks=True, world=world)
            control = GameController(supervision, SCRIPTED, robot=world, paced=False)
            game = threading.Thread(target=play, args=(control, over, held, dialogs))
            game.start()
            found: list[Stall] = []
            for stage, seconds in product(given.stage or STAGES, lengths * given.times):
                time.sleep(chance.uniform(*RESTS))
                come_to(world, stage, chance)
                found.append(stall(world, seconds, held, dialogs))
                print(found[-1], flush=True)
            over.set()
            control.break_off()
            game.join(60)
            pauses = world.link.state.pauses
    for seconds in lengths:
        those = [one for one in found if one.seconds == seconds]
        codes = Counter(code for one in those for code in one.dialogs)
        print(
            f"{seconds:g} s x {len(those)}: {sum(bool(o.dialogs) for o in those)} with a dialog, "
            f"{max(len(o.dialogs) for o in those)} at most, {dict(codes)}; "
            f"stages {dict(Counter(o.stage for o in those))}"
        )
    print("base told to stand after", spread([one.told for one in found]))
    print("base stood after", spread([one.stood for one in found]))
    print("pauses", pauses)


if __name__ == "__main__":
    main()
