"""Guided games in tests: by a good teacher, and by one who makes mistakes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from hypothesis import strategies as st

from tangy_profiles.activity import load_activity, read_activity
from tangy_profiles.behaviour import Action
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.person import load_people
from tangy_profiles.scene import Scene
from tangy_profiles.state import Outcome, Situation
from tangy_sim.worlds.guidance import GuidedWorld
from tangy_tui.world import World

BINGO = load_activity("bingo")
LANTERNS = read_activity(Path(__file__).parents[1] / "lanterns.toml")
IDS = tuple(person.id for person in load_people(8))
SEEDS = range(100)
LEAVING = {s for s in LANTERNS.situations if s.stage == "leaving"}


@dataclass(frozen=True)
class Turn:
    """One step of a game: the action, its outcome, and what was visible then."""

    step: Step
    outcome: Outcome
    scene: Scene

    @property
    def asking(self) -> set[str]:
        return set(self.scene.requests)


def expected(world: World) -> Action:
    state = world.observe()
    behaviour = world.activity.behaviours[world.activity.expected[state.situation]]
    return world.activity.action(behaviour, state.attended if behaviour.attends else None, None)


def turn(world: GuidedWorld, action: Action) -> Turn:
    before = world.observe()
    outcome = world.execute(action)
    step = Step(action.behaviour.name, action.target, before, world.observe())
    return Turn(step, outcome, world.scene())


def play(world: GuidedWorld, most: int = 200) -> Iterator[Turn]:
    """Play the expected behaviours to the end."""
    for _ in range(most):
        if world.over:
            return
        yield turn(world, expected(world))
    raise AssertionError(f"the game does not end: {world.plan.lacking}")


@cache
def guided(activity: str, seed: int, users: int) -> tuple[Turn, ...]:
    described = BINGO if activity == "bingo" else LANTERNS
    return tuple(play(GuidedWorld(described, IDS[:users], seed=seed)))


def shown(turns: Sequence[Turn]) -> set[Situation]:
    return {t.step.state.situation for t in turns}


def demonstration(activity: str, seed: int, users: int) -> Demonstration:
    steps = tuple(t.step for t in guided(activity, seed, users))
    return Demonstration(f"{seed}", activity, "test", seed, IDS[:users], steps, True)


def games(activity: str = "bingo", seeds: int = 100) -> Iterator[tuple[Turn, ...]]:
    for users in range(1, 9):
        for seed in range(seeds):
            yield guided(activity, seed, users)


Mistake = tuple[int, int, int]
"""The number of correct steps before it, the index of the behaviour, and of its addressee."""

MISTAKES = st.lists(
    st.tuples(st.integers(0, 6), st.integers(0, 99), st.integers(0, 99)), max_size=30
)


def mistaken(world: GuidedWorld, mistakes: Sequence[Mistake], *but: str) -> Iterator[Action]:
    """Yield the actions of a teacher who makes these mistakes first, and then none, to the end.

    A mistake is any behaviour except those in `but` and those that end the game.
    """
    activity, people = world.activity, world.people
    ends = {rule.behaviour for rule in activity.stage_rules if rule.condition == "after"}
    ends.update(but, (b.name for b in activity.behaviours.values() if b.ends))
    choices = [b for b in activity.behaviours.values() if b.name not in ends]
    for right, which, whom in mistakes:
        for _ in range(right):
            if not world.over:
                yield expected(world)
        behaviour = choices[which % len(choices)]
        if not world.plan.ended(world.tracker):
            target = people[whom % len(people)] if behaviour.attends else None
            yield activity.action(behaviour, target, None)
    for _ in range(200):
        if not world.over:
            yield expected(world)
    assert world.over, world.plan.lacking
