"""A classroom: games demonstrated through the real teaching engine, and policies learnt from them.

What the simulated teachers of these experiments do goes through the door that people use:
commands in words, questions that are answered, steps in a log. Only the log is on a scratch
folder, and a game is committed as a whole, which takes .1 ms a step instead of 4.
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
"""How the games of a demonstration come about: planned to show everything, or by chance."""

SEED_SPACE = 10_000
"""Seeds that belong to one --seed, so that two of them never share a game."""

PARTS = ("demonstrations", "teachers", "mistakes")
"""The parts of Scenario 1, each of which has games that no other one has."""

PART_SPACE = 1_000_000
"""Courses that belong to one part and one --seed."""

Steps = Iterator[TeachingEvent]


class Teacher(Protocol):
    """Somebody who demonstrates one game to its end."""

    def demonstrate(self) -> Steps:
        """Demonstrate, event by event."""
        ...


class MakeTeacher(Protocol):
    """Puts a teacher into a session."""

    def __call__(self, teaching: TeachingSession) -> Teacher:
        """Return the teacher."""
        ...


@dataclass(frozen=True)
class Course:
    """What is taught (a shipped activity or its file), to how many people, in which games."""

    activity: str
    users: int
    games: str
    seed: int


def course_number(part: str, seed: int, place: int = 0, places: int = 1) -> int:
    """Return which course a part has for a seed; no two parts, seeds or places have the same.

    Args:
        part: of the experiments, one of `PARTS`.
        seed: of the random generators.
        place: which of a seed's courses in this part, of `places`.
        places: how many courses a seed has in this part.
    """
    block, at = divmod(seed, SEED_SPACE)
    return (len(PARTS) * block + PARTS.index(part)) * PART_SPACE + places * at + place


@cache
def activity_of(name: str) -> Activity:
    """Return an activity by name, read once in each process."""
    return load_activity(name)


def about(name: str) -> dict[str, Any]:
    """Return the settings of a sweep that say which activity it is about.

    A file of somebody's own may change under the same name, so its content is among them.

    Raises:
        TangyError: there is no such activity, or it does not say what is expected.
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
    """Yield one finished demonstration after another, without end.

    Their steps are numbered through the course, as they would be in one log.
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
    """Say whether a policy is right on every joint state, whatever comes about or does not."""
    people = [person.id for person in load_people(users)]
    return policy.exact(activity) and all(
        policy.decide(state.situation).behaviour == activity.expected.get(state.situation)
        for state in joint_states(activity, people)
    )


def covered(activity: Activity, shown: Sequence[Demonstration]) -> bool:
    """Say whether demonstrations show every situation that the activity can bring about."""
    seen = {step.state.situation for one in shown for step in one.steps}
    return seen >= set(activity.expected)
