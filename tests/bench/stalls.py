"""Effects of stopping a robot's process during a game: dialogs, their causes, and the base.

Run by hand: `python -m tests.bench.stalls [--times N] [--seconds S]... [--stage S]... [--load N]
[--link-delay S] [--link-loss SHARE]`. Games are played on the bench in real time, with staff who
clear faults that halt the robot, with N busy processes beside them, and over a link of that
quality. The robot's process is stopped for S s in each stage in turn, N times for each length:
while a number is due, while it drives to a person who asks, and beside that person; while it
speaks, watches a person's response, waits for people to clear its path, turns to find its place,
or waits for staff to answer a question. A dialog is a critical fault; other faults that are
diagnosed after a stall are printed, too.
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
from typing import Any

from tangy_profiles.behaviour import Action
from tangy_profiles.fault_file import load_faults
from tangy_profiles.faults import Remedy
from tangy_profiles.state import Outcome
from tangy_sim.servers.link_relay import LinkQuality
from tangy_tui.app.game_commands import TakeOver
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.robot_opening import open_bench
from tangy_tui.app.scripted_staff import go_on_by_script
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policies import load_policy
from tangy_tui.learning.scripted_teacher import SCRIPTED
from tangy_tui.monitoring.fault import Diagnosed, Fault
from tests.bench.fault_latency import teach
from tests.bench.jitter import busy

RESTS = (2.0, 6.0)  # s between two stalls, drawn at random
STAGES = ("facilitate", "navigate", "help")  # of the activity
SPEAKING, WATCHING, RECOVERING, TURNING = "speaking", "watching", "recovering", "turning"
ASKING = "asking"
MOMENTS = (SPEAKING, WATCHING, RECOVERING, TURNING, ASKING)
FAULTS = {RECOVERING: "path-blocked", TURNING: "carried-off"}  # the faults that it recovers from
REMEDIES = {"ask": RECOVERING, "spin": TURNING}
COMES = 120.0  # s in which a stage must begin
SETTLES = 4.0  # s after a stall in which its effects are reported


@dataclass
class Stall:
    """One stall: its length and stage, the faults reported after it, and the base's motion.

    If it drove, `told` is the s until the command to stand, and `stood` the s until it stood.
    """

    seconds: float
    stage: str
    dialogs: list[str] = field(default_factory=list)
    others: list[str] = field(default_factory=list)
    told: float | None = None
    stood: float | None = None

    def look(self, world: BenchedWorld, after: float) -> None:
        """Record the motion of the base some s after the stall began."""
        truth = world.truth()
        if self.told is None and not any(truth["commanded"]):
            self.told = after
        if self.stood is None and not truth["moving"]:
            self.stood = after


class WatchedBench(BenchedWorld):
    """A bench that lets another thread see what the robot is doing."""

    doing = ""
    _watches = False

    def execute(self, action: Action) -> Outcome:
        """Carry out an action; after a request, watch the person's response."""
        self._watches = action.behaviour.persuades and self.tracker.place in self.tracker.queue
        try:
            return super().execute(action)
        finally:
            self._watches, self.doing = False, ""

    def say(self, speech: str, *others: Any, **more: Any) -> None:
        """Speak."""
        before, self.doing = self.doing, SPEAKING
        super().say(speech, *others, **more)
        self.doing = WATCHING if self._watches else before

    def recover(self, remedy: Remedy) -> float:
        """Carry out a remedy."""
        self.doing = REMEDIES.get(remedy.kind, self.doing)
        try:
            return super().recover(remedy)
        finally:
            self.doing = ""


class StalledGames:
    """Games on another thread, and their events."""

    def __init__(self, control: GameController, world: WatchedBench) -> None:
        self.control = control
        self.world = world
        self.told: list[Fault] = []
        self.over, self.held = threading.Event(), threading.Event()
        self.wanted = ""
        """The stage of the next stall."""

    def play(self) -> None:
        """Play games until the bench ends; while the process is `held` staff only look."""
        game = self.control.supervision
        while not self.over.is_set():
            self.control.begin()
            while not game.over and not self.over.is_set():
                waits = self.held.is_set() and game.halted is not None
                waits |= game.question is not None and (self.held.is_set() or self.asked)
                events = (
                    self.control.look() if waits else go_on_by_script(self.control, expert=True)
                )
                self.told += [one.fault for one in events or () if isinstance(one, Diagnosed)]
                if waits:
                    time.sleep(0.05)

    @property
    def asked(self) -> bool:
        """Whether the next stall comes while a question is open."""
        return self.wanted == ASKING

    def come_to(self, stage: str, chance: Random) -> None:
        """Wait until a game is in a stage, and until it drives if the stage involves driving.

        Its cause is provided: a person asks for help, the path is blocked, staff take over.
        A stage that does not begin is skipped: the stall records its actual stage.
        """
        world, until = self.world, time.monotonic() + COMES
        self.wanted = stage
        asked = stage in (STAGES[0], ASKING)
        if stage in FAULTS:
            world.inject(FAULTS[stage])
        while time.monotonic() < until:
            now = world.tracker.state().situation.stage
            if not asked and now == STAGES[0] and not world.over:
                world.bench.do("ask", person=chance.choice(world.people))
                asked = True
            if stage == ASKING and self.control.phase == "running" and not world.over:
                self.control.apply(TakeOver())
            there = self.stage == stage
            if there and (stage not in ("navigate", TURNING) or world.truth()["moving"]):
                return
            time.sleep(0.05)

    @property
    def stage(self) -> str:
        """The robot's current action if the next stall needs it, else the activity's stage."""
        game = self.control.supervision
        if self.wanted not in MOMENTS:
            return self.world.tracker.state().situation.stage
        return ASKING if game.question is not None else self.world.doing

    def stall(self, seconds: float) -> Stall:
        """Stop the robot process for some s, and record the effects."""
        world = self.world
        pid = world.link.pid
        assert pid is not None
        one = Stall(seconds, self.stage)
        before = len(self.told)
        moving = any(world.truth()["commanded"])
        self.held.set()
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
                self.held.clear()
                self.wanted = ""
        for fault in self.told[before:]:
            (one.dialogs if fault.critical else one.others).append(fault.code)
        for kind in set(FAULTS.values()) & set(world.present):
            world.lift(kind)
        return one


def spread(found: Sequence[float | None], unit: str = "s") -> str:
    """Return the count, median, 95th percentile, and maximum."""
    there = sorted(one for one in found if one is not None)
    if len(there) < 2:
        return f"{there} {unit}"
    cuts = quantiles(there, n=20, method="inclusive")
    return f"p50 {cuts[9]:.2f} p95 {cuts[18]:.2f} most {there[-1]:.2f} {unit} ({len(there)} times)"


def main() -> None:
    """Play, stop, and print the results."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--times", type=int, default=3)
    parser.add_argument("--seconds", type=float, action="append")
    parser.add_argument("--stage", choices=(*STAGES, *MOMENTS), action="append")
    parser.add_argument("--load", type=int, default=0, help="busy processes beside it")
    parser.add_argument("--link-delay", type=float, default=0.0, help="s in each direction")
    parser.add_argument("--link-loss", type=float, default=0.0, help="the share of packets lost")
    given = parser.parse_args()
    link = LinkQuality(given.link_delay, given.link_loss)
    lengths = given.seconds or [0.3, 1.0, 4.0, 10.0]
    chance = Random(1)
    with TemporaryDirectory() as folder, closing(Workspace(Path(folder))) as workspace:
        teach(workspace)
        policy, _ = load_policy(workspace.store, workspace.activity)
        book = load_faults(workspace.robot)
        with (
            open_bench(
                workspace, seed=1, stepped=False, pace=1.0, book=book, kind=WatchedBench, link=link
            ) as world,
            busy(given.load),
        ):
            supervision = workspace.supervision(policy, 1, asks=True, world=world)
            control = GameController(supervision, SCRIPTED, robot=world, paced=False)
            games = StalledGames(control, world)
            thread = threading.Thread(target=games.play)
            thread.start()
            found: list[Stall] = []
            for stage, seconds in product(given.stage or STAGES, lengths * given.times):
                time.sleep(chance.uniform(*RESTS))
                games.come_to(stage, chance)
                found.append(games.stall(seconds))
                print(found[-1], flush=True)
            games.over.set()
            control.break_off()
            thread.join(60)
            pauses = world.link.state.pauses
    for seconds in lengths:
        those = [one for one in found if one.seconds == seconds]
        codes = Counter(code for one in those for code in one.dialogs)
        print(
            f"{seconds:g} s x {len(those)}: {sum(bool(o.dialogs) for o in those)} with a dialog, "
            f"{max(len(o.dialogs) for o in those)} at most, {dict(codes)}; "
            f"other faults {dict(Counter(code for o in those for code in o.others))}; "
            f"stages {dict(Counter(o.stage for o in those))}"
        )
    print("base told to stand after", spread([one.told for one in found]))
    print("base stood after", spread([one.stood for one in found]))
    print("pauses", pauses)


if __name__ == "__main__":
    main()
