"""Games demonstrated through the real teaching engine, and policies learnt from them.

The simulated teachers of these experiments use the same interface as people: commands in words,
answered questions, logged steps. Only the log is in a temporary folder, and each game is one
transaction, which takes 0.1 ms per step instead of 4.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Protocol

from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import TangyError
from tangy_profiles.given_file import read_given_text
from tangy_profiles.person import load_people
from tangy_profiles.reading import LARGEST_PROFILE
from tangy_profiles.store import Store
from tangy_sim.worlds.guidance import GuidedWorld
from tangy_sim.worlds.users import load_users
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.experiments.provenance import digest_of
from tangy_tui.learning.conflicts import Resolution
from tangy_tui.learning.policy import Policy, learn_policy
from tangy_tui.learning.reachable import joint_states
from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.learning.teaching_events import Next, TeachingEvent
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.world import World

GUIDED = "guided"
RANDOM = "random"
"""The kinds of games to demonstrate: arranged to show everything, or random."""

SEED_SPACE = 10_000
"""Seeds that belong to one --seed, so that different ones never share a game."""

PARTS = ("demonstrations", "teachers", "mistakes")
"""The parts of Scenario 1, each with its own games."""

PART_SPACE = 1_000_000
"""Courses that belong to one part and one --seed."""

Steps = Iterator[TeachingEvent]


class Teacher(Protocol):
    """A teacher who demonstrates one game to its end."""

    def demonstrate(self) -> Steps:
        """Demonstrate, event by event."""
        ...


class MakeTeacher(Protocol):
    """Creates a teacher for a session."""

    def __call__(self, teaching: TeachingSession) -> Teacher:
        """Return the teacher."""
        ...


@dataclass(frozen=True)
class Course:
    """A series of demonstrations: the activity (or its file), the people, the kind of games."""

    activity: str
    users: int
    games: str
    seed: int


def course_number(part: str, seed: int, place: int = 0, places: int = 1) -> int:
    """Return a unique course number for a part, a seed and a place.

    Args:
        part: the part of the experiments, one of `PARTS`.
        seed: seed of the random generators.
        place: the index of the course, among `places`.
        places: the number of courses per seed in this part.
    """
    block, at = divmod(seed, SEED_SPACE)
    return (len(PARTS) * block + PARTS.index(part)) * PART_SPACE + places * at + place


@cache
def activity_of(name: str) -> Activity:
    """Return an activity by name, cached in each process."""
    return load_activity(name)


def about(name: str) -> dict[str, Any]:
    """Return the settings of a sweep that identify its activity.

    They include the content of a user's file, which may change under the same name.

    Raises:
        TangyError: there is no such activity, or it does not declare the expected behaviours.
    """
    if not activity_of(name).expected:
        raise TangyError(
            f"{activity_of(name).title} does not say what is expected ([[expected]]), "
            "so nobody can tell whether it was learnt."
        )
    if not name.endswith(".toml"):
        return {"activity": name}
    return {"activity": name, "content": digest_of(read_given_text(Path(name), LARGEST_PROFILE))}


def taught(course: Course, make_teacher: MakeTeacher = ScriptedTeacher) -> Iterator[Demonstration]:
    """Yield finished demonstrations, endlessly.

    Their step ids are unique within the course, as in one log.
    """
    activity = activity_of(course.activity)
    kind = GuidedWorld if course.games == GUIDED else SimulatedWorld

    def make_world(shown: Demonstration) -> World:
        return kind(activity, shown.people, seed=shown.seed, users=load_users().teaching())

    numbers = count(1)
    with TemporaryDirectory(prefix="tangy-class-") as scratch, Store.open(Path(scratch)) as store:
        people = load_people(course.users)
        first = 1000 * course.seed  # each game of a course has the next seed
        teaching = TeachingSession(activity, people, store, make_world, teacher="class", seed=first)
        teacher = make_teacher(teaching)
        teaching.begin()
        while True:
            with store.transaction():
                deque(teacher.demonstrate(), maxlen=0)
            shown = teaching.demonstration
            yield replace(
                shown,
                id=f"{course.games}-{shown.seed}",
                steps=tuple(replace(step, id=next(numbers)) for step in shown.steps),
            )
            teaching.apply(Next())


def learnt(
    activity: Activity, shown: Sequence[Demonstration], resolutions: Sequence[Resolution] = ()
) -> Policy:
    """Learn a policy from demonstrations, as the program does."""
    return learn_policy(activity, shown, resolutions=resolutions)


def is_exact(policy: Policy, activity: Activity, users: int) -> bool:
    """Return whether a policy is right in every joint state."""
    people = [person.id for person in load_people(users)]
    return policy.exact(activity) and all(
        policy.decide(state.situation).behaviour == activity.expected.get(state.situation)
        for state in joint_states(activity, people)
    )


def covered(activity: Activity, shown: Sequence[Demonstration]) -> bool:
    """Return whether demonstrations show every situation that can occur in the activity."""
    seen = {step.state.situation for one in shown for step in one.steps}
    return seen >= set(activity.expected)
