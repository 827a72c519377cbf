"""Scenario 3 on the bench: games with planned faults of simulated devices."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tangy_profiles.behaviour import Action
from tangy_profiles.fault_file import load_faults
from tangy_profiles.faults import Remedy
from tangy_profiles.state import ActivityState, Outcome
from tangy_sim.worlds.injection import KINDS, WAITING
from tangy_tui.app.robot_opening import open_bench
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.app.workspace import Workspace
from tangy_tui.experiments.classroom import GUIDED, Course
from tangy_tui.experiments.induced import Inducer, Planned
from tangy_tui.experiments.kept_games import keep_games, to_read
from tangy_tui.experiments.recovering import plan_of, play_games
from tangy_tui.experiments.supervised import keep, lessons
from tangy_tui.experiments.sweep import Case, Settings

GAMES_A_PIECE = 5
"""Games on one bench with the same people: few, so that each core has work."""


PLACED = ("path-detour", "request-stuck")
"""Kinds that may find no occasion on the bench; its ground truth says so."""


class InducingBench(BenchedWorld):
    """A world on the bench with planned faults."""

    def plan(self, plan: Sequence[Sequence[Planned]]) -> InducingBench:
        """Set the planned faults of each game."""
        self.inducer = Inducer(plan)
        return self

    def begin(self) -> ActivityState:
        """Begin the next game of the plan."""
        self.inducer.begin()
        self.link.release()  # nobody is there to release it
        return super().begin()

    def execute(self, action: Action) -> Outcome:
        """Inject a planned fault that can show now, and carry out the action."""
        if not self.over:
            self._note_lifted()
            step = self.tracker.step + 1
            there = [KINDS[name] for name in self.present]
            name = self.inducer.choose(
                step, action, there, lambda kind: self.can_show(kind, action)
            )
            if name:
                self.inducer.came(name, step, self.link.time)
                self.inject(name)
        outcome = super().execute(action)
        if self.over:
            self._note_hidden()
        return outcome

    def _note_hidden(self) -> None:
        """At a game's end, mark the faults that could no longer be observed.

        These are a chair that found no room in front of the robot, a sign that was already down,
        and a withdrawn request, which only shows with the next behaviour.
        """
        self._note_lifted()
        placed = {fault["kind"]: fault["shown"] for fault in self.truth()["faults"]}
        for fault in self.inducer.induced:
            nowhere = fault.kind.name in PLACED and placed.get(fault.kind.name) is False
            late = fault.lifted is not None and fault.lifted > self.tracker.step
            fault.hidden = nowhere or (late and fault.kind.shows == WAITING)

    def recover(self, remedy: Remedy) -> float:
        """Record that a fault is treated, and carry out the remedy; return the s it took."""
        self.inducer.treated(remedy.fault)
        seconds = super().recover(remedy)
        self._note_lifted()
        return seconds

    def _note_lifted(self) -> None:
        there, step = self.present, self.tracker.step
        for fault in self.inducer.induced:
            if fault.kind.name not in there:
                late = fault.kind.shows == WAITING  # a withdrawn request shows one step later
                self.inducer.lifted(fault.kind.name, step + late)


def play_on_bench(settings: Settings, case: Case, logs: Path | None = None) -> dict[str, Any]:
    """Play games on a bench: a case is (seed, first game, games, games in all).

    Args:
        settings: those of the sweep.
        case: the case.
        logs: where to keep the data folder if one of the games should be read.

    Returns:
        As `experiments.recovering.play`, and the `score` of perception against the ground truth; a
        game that should be read has its folder as `log`.
    """
    seed, first, some, games = case
    plan = plan_of(games, seed, GAMES_A_PIECE)[first : first + some]
    number = seed * 1_000_000 + first
    activity, users = settings["activity"], settings["users"]
    shown, policy = lessons(Course(activity, users, GUIDED, 1))
    with TemporaryDirectory(prefix="tangy-bench-") as scratch:
        workspace = Workspace(Path(scratch), activity=activity, users=users)
        try:
            for one in shown:  # also used to learn the effects
                keep(workspace.store, one)
            with open_bench(
                workspace,
                seed=number,
                stepped=True,
                book=load_faults(workspace.robot),
                kind=InducingBench,
            ) as world:
                world.plan(plan)
                game = workspace.supervision(policy, number, asks=True, world=world)
                played = play_games(game, world.inducer, first, some)
        finally:
            workspace.close()
        if logs is not None and (read := [one for one in played["games"] if to_read(one)]):
            folder = logs / f"seed-{seed}-games-{first + 1}-to-{first + some}"
            for one in read:
                one["log"] = str(folder)
            keep_games(Path(scratch), folder, read)
    return {**played, "score": world.score.to_json()}
