"""Teaching sessions in a simulated room, and what is said in them."""

from __future__ import annotations

from collections import deque

from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.person import load_people
from tangy_profiles.store import Store
from tangy_sim.worlds.users import load_users
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.app.training import learn
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policies import load_policy
from tangy_tui.learning.policy import Policy
from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.learning.teaching_events import Executed
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import Asked, Reply, Say
from tangy_tui.world import World

BINGO = load_activity("bingo")
YES, NO = Reply(yes=True), Reply(yes=False)


def session(
    store: Store, *, teacher: str = "Ada", seed: int = 1, users: int = 4, activity: Activity = BINGO
) -> TeachingSession:
    """Make a session that has not begun yet."""

    def world(shown: Demonstration) -> World:
        return SimulatedWorld(
            activity, shown.people, seed=shown.seed, users=load_users().teaching()
        )

    return TeachingSession(activity, load_people(users), store, world, teacher=teacher, seed=seed)


def begun(store: Store, *, seed: int = 1, users: int = 4) -> TeachingSession:
    """Make a session that has begun."""
    teaching = session(store, seed=seed, users=users)
    teaching.begin()
    return teaching


def teach(teaching: TeachingSession, *phrases: str) -> list[Executed]:
    """Say each phrase, confirm it, and return the executed behaviours."""
    done = []
    for phrase in phrases:
        assert isinstance(teaching.apply(Say(phrase))[0], Asked)
        done += [e for e in teaching.apply(YES) if isinstance(e, Executed)]
    return done


def taught_until(workspace: Workspace, stage: str) -> TeachingSession:
    """Return a session of a declared activity after its first step in a stage."""
    teaching = workspace.teaching("Mary", 1)
    teaching.begin()
    teacher = ScriptedTeacher(teaching)
    while not teaching.demonstration.steps or teaching.demonstration.steps[-1].state.stage != stage:
        teaching.apply(teacher.command())
    return teaching


def taught_policy(workspace: Workspace) -> Policy:
    """Let the scripted teacher show one game of a workspace, and learn from it."""
    teaching = workspace.teaching("scripted", 1)
    teaching.begin()
    deque(ScriptedTeacher(teaching).demonstrate(), maxlen=0)
    learn(workspace)
    return load_policy(workspace.store, workspace.activity)[0]
