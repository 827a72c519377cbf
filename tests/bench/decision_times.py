"""Time from the observation to the chosen behaviour, for 4 and for 24 people.

Run by hand: `python -m tests.bench.decision_times [ACTIVITY ...] [--games 3]`. A scripted teacher
shows a guided game to a group of each size; then simulated games are played under monitoring. The
decision is everything that a step computes before it carries out its behaviour: state, policy,
addressee, persuasion. The step adds log, beliefs and monitoring. Times are processor times.
"""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from tangy_profiles.activity import shipped_activities
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.app.training import learn
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.scripted_teacher import ScriptedTeacher

GROUPS = (4, 24)
SEED = 1


@dataclass
class Times:
    """Times in s of the steps that carried out a behaviour."""

    decided: list[float] = field(default_factory=list)
    whole: list[float] = field(default_factory=list)


def measured(activity: str, people: int, games: int) -> Times:
    """Teach a group, and play games with it."""
    with tempfile.TemporaryDirectory() as folder:
        workspace = Workspace(Path(folder) / "data", activity=activity, users=people)
        try:
            teaching = workspace.teaching("scripted", SEED, guided=True)
            teaching.begin()
            list(ScriptedTeacher(teaching).demonstrate())
            return _played(workspace, games)
        finally:
            workspace.close()


def _played(workspace: Workspace, games: int) -> Times:
    game = workspace.supervision(learn(workspace), SEED, asks=True)
    control, times, chosen = scripted_controller(game), Times(), [0.0]
    execute = game.world.execute

    def noting(*args: Any, **kwargs: Any) -> Any:
        chosen.append(process_time())
        return execute(*args, **kwargs)

    game.world.execute = noting  # type: ignore[method-assign]
    for _ in range(games):
        control.begin()
        while not game.over:
            count, begun = len(chosen), process_time()
            go_on_by_script(control, expert=True)
            ended = process_time()
            if len(chosen) == count + 1:
                times.decided.append(chosen[-1] - begun)
                times.whole.append(ended - begun)
    return times


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("activities", nargs="*", help="default: all that ship")
    parser.add_argument("--games", type=int, default=3)
    options = parser.parse_args()
    print("| activity | people | steps | decision, ms median / p95 | step, ms median / p95 |")
    print("|---|---|---|---|---|")
    for activity in options.activities or shipped_activities():
        for people in GROUPS:
            times = measured(activity, people, options.games)
            cells = [
                " / ".join(f"{value * 1e3:.2f}" for value in np.percentile(found, [50, 95]))
                for found in (times.decided, times.whole)
            ]
            print(f"| {activity} | {people} | {len(times.whole)} | {' | '.join(cells)} |",
                  flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
