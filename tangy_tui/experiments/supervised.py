"""A workspace for experiments on monitoring: demonstrations, a policy, supervised games.

It is in a temporary folder, where teachers' answers in games are learnt as in the program.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from tangy_profiles.demonstration import Demonstration
from tangy_profiles.fault_file import load_faults
from tangy_profiles.faults import FaultBook
from tangy_profiles.person import Person, load_people
from tangy_profiles.robot import Robot, load_robot
from tangy_profiles.store import Store
from tangy_profiles.teaching_records import (
    DemonstrationBegun,
    DemonstrationFinished,
    DemonstrationStep,
)
from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_tui.experiments.classroom import Course, activity_of, learnt, taught
from tangy_tui.interaction.facilitation import Facilitation
from tangy_tui.interaction.persuasion import Persuasion
from tangy_tui.learning.online_learning import OnlineLearning
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.accepted import expected_effects
from tangy_tui.monitoring.supervision import Supervision

DEMONSTRATIONS = 3
"""Demonstrations that a policy is learnt from, as in the paper."""


@dataclass(frozen=True)
class Supervised:
    """Demonstrations in a temporary log, the learnt policy and effects, and the fault rules."""

    activity: str
    people: tuple[Person, ...]
    policy: Policy
    store: Store
    robot: Robot
    book: FaultBook

    def games(self, world: FaultyWorld, seed: int) -> Supervision:
        """Return a supervision of games in a world, with a teacher to ask and unknown people."""
        people = tuple(person.id for person in self.people)
        names = {person.id: person.name for person in self.people}
        strategies = tuple(world.activity.strategies)
        game = Facilitation(
            world,
            self.policy,
            Persuasion(people, strategies, Random(f"{seed}/persuasion")),
            self.store,
            names=names,
            seed=seed,
            answers=OnlineLearning(self.store, world.activity),
        )
        return Supervision(
            game,
            self.book,
            self.robot,
            self.store,
            lambda policy: expected_effects(self.store, world.activity, policy),
            lambda person: names.get(person, person),
        )


@cache
def lessons(course: Course) -> tuple[tuple[Demonstration, ...], Policy]:
    """Return the first demonstrations of a course, and the policy learnt from them."""
    games = taught(course)
    shown = tuple(next(games) for _ in range(DEMONSTRATIONS))
    return shown, learnt(activity_of(course.activity), shown)


@contextmanager
def supervised(course: Course) -> Iterator[Supervised]:
    """Open a workspace with the demonstrations and the policy of a course.

    It is temporary, so everything is one transaction.
    """
    shown, policy = lessons(course)
    robot = load_robot()
    with (
        TemporaryDirectory(prefix="tangy-supervised-") as scratch,
        Store.open(Path(scratch)) as store,
        store.transaction(),
    ):
        for one in shown:
            keep(store, one)
        people = tuple(load_people(course.users))
        yield Supervised(course.activity, people, policy, store, robot, load_faults(robot))


def keep(store: Store, shown: Demonstration) -> None:
    """Write a demonstration into a log, as if it had been given in the program."""
    store.append(DemonstrationBegun.from_demonstration(shown))
    for step in shown.steps:
        store.append(DemonstrationStep(demonstration=shown.id, step=step))
    store.append(DemonstrationFinished(demonstration=shown.id))


def people_of(one: Supervised) -> Sequence[str]:
    """Return the participants' ids."""
    return [person.id for person in one.people]
