"""Checks against the log of a killed game: see `kills`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import cast

from tangy_profiles.activity import load_activity
from tangy_profiles.behaviour import calling
from tangy_profiles.game_records import GameBeginning, GameEnding, GameStep
from tangy_profiles.game_world import SIMULATED, GameWorld
from tangy_profiles.people_records import ResponseGiven
from tangy_profiles.store import Store
from tangy_profiles.tracker import Tracker
from tangy_tui.app.interruption import find_interrupted
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policies import load_policy


@dataclass
class Found:
    """The result of killing games: counts, and the time of each restart (s)."""

    kills: int = 0
    acknowledged: int = 0
    lost: int = 0
    not_offered: int = 0
    other: dict[str, int] = field(default_factory=dict)
    """The count of each difference, by its subject."""
    restarts: list[float] = field(default_factory=list)
    computed: list[float] = field(default_factory=list)
    """The CPU time of each restart, in s."""
    at_steps: list[int] = field(default_factory=list)
    played_on: int = 0
    """The number of resumed games that were played to their end."""

    def differs(self, what: str) -> None:
        """Count a difference."""
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
    """Return the percentile at this share of 100; None of an empty list."""
    ordered = sorted(values)
    return round(ordered[-(-percent * len(ordered) // 100) - 1], 2) if ordered else None


def logged(folder: Path) -> tuple[list[object], bool]:
    """Return the steps and responses of the last game, in order, and whether it ended."""
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
    """Return the steps among logged events."""
    return [event for event in events if isinstance(event, tuple) and len(event) == 6]


def compare(folder: Path, world: GameWorld, found: Found) -> None:
    """Resume the killed game, and count the differences from its log."""
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
        draws = calling(activity.behaviours)
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


def compare_end(
    folder: Path,
    before: list[object],
    whole: list[object],
    believed: dict[str, dict[str, list[float]]],
    found: Found,
) -> None:
    """Count the errors of a game on the bench that was played to its end."""
    events, over = logged(folder)
    found.played_on += over
    if not over:
        found.differs("the end")
    if events[: len(before)] != before:
        found.differs("the log before the last kill")
    compare_order(events, whole, found)
    responses = [event for event in events if isinstance(event, tuple) and len(event) == 3]
    for person, strategies in believed.items():
        for strategy, belief in strategies.items():
            mine = [event[2] for event in responses if event[:2] == (person, strategy)]
            if belief != [1 + sum(mine), 1 + len(mine) - sum(mine)]:  # uniform priors
                found.differs("beliefs")


def compare_order(events: list[object], whole: list[object], found: Found) -> None:
    """Count games with repeated numbers, or with another order than an unkilled game."""
    called, others = calls_in(events), calls_in(whole)
    both = min(len(called), len(others))
    if len(set(called)) != len(called) or called[:both] != others[:both]:
        found.differs("order of the calls")


def calls_in(events: Sequence[object]) -> list[int]:
    """Return the numbers that were called in a game, in order."""
    draws = calling(load_activity("bingo").behaviours)
    return [
        n for step in steps_in(events) if step[0] in draws for n in cast(tuple[int, ...], step[3])
    ]
