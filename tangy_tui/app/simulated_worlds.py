"""The simulated world that suits an activity: one with cards, or one declared by facts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from tangy_profiles.activity import Activity
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import TangyError
from tangy_profiles.store import Store
from tangy_tui.world import World

if TYPE_CHECKING:
    from tangy_profiles.health import Health
    from tangy_profiles.robot import Robot
    from tangy_sim.worlds.injection import Injection


def game_world(
    activity: Activity,
    people: Sequence[str],
    seed: int,
    injections: Sequence[Injection] | None,
    live: Callable[[], Health] | None = None,
    robot: Robot | None = None,
) -> World:
    """Create the simulated world for games.

    Args:
        activity: the activity to play.
        people: the ids of the participants.
        seed: seeds the random generators.
        injections: faults to inject; None creates a world without faults.
        live: returns the readings of real devices, which replace simulated ones.
        robot: the robot whose devices are simulated; None: all that can be.

    Raises:
        TangyError: the activity has no faults to inject.
    """
    if isinstance(activity, DeclaredActivity):
        from tangy_sim.worlds.clarity import UNCLEAR
        from tangy_sim.worlds.declared_world import DeclaredWorld

        if injections:
            raise TangyError(f"No fault can be brought about in {activity.title} yet.")
        return DeclaredWorld(activity, people, seed=seed, unclear=UNCLEAR, robot=robot)
    if live is not None:
        from tangy_tui.app.partly_live_world import PartlyLiveWorld

        to_come = injections or ()
        return PartlyLiveWorld(
            activity, people, seed=seed, injections=to_come, live=live, robot=robot
        )
    if injections is None:
        from tangy_sim.worlds.world import SimulatedWorld

        return SimulatedWorld(activity, people, seed=seed, robot=robot)
    from tangy_sim.worlds.faulty_world import FaultyWorld

    return FaultyWorld(activity, people, seed=seed, injections=injections, robot=robot)


def teaching_world(activity: Activity, shown: Demonstration, store: Store) -> World:
    """Create the simulated world of a demonstration, in which people ask more often.

    The guided world of a declared activity creates situations that earlier demonstrations in the
    log have not covered.
    """
    if isinstance(activity, DeclaredActivity):
        return _declared_teaching(activity, shown, store)
    from tangy_sim.worlds.guidance import GuidedWorld
    from tangy_sim.worlds.users import load_users
    from tangy_sim.worlds.world import SimulatedWorld

    kind = GuidedWorld if shown.guided else SimulatedWorld
    return kind(activity, shown.people, seed=shown.seed, users=load_users().teaching())


def _declared_teaching(activity: DeclaredActivity, shown: Demonstration, store: Store) -> World:
    from tangy_sim.worlds.declared_guidance import GuidedDeclaredWorld
    from tangy_sim.worlds.declared_world import DeclaredWorld

    if not shown.guided:
        return DeclaredWorld(activity, shown.people, seed=shown.seed)
    from tangy_profiles.declared.demonstrated_moves import DemonstratedMoves
    from tangy_tui.learning.library import read_library

    known = DemonstratedMoves(activity.behaviours)
    for id, entry in read_library(store, activity.name).entries.items():
        if id == shown.id:
            break
        for step in () if entry.hidden else entry.demonstration.steps:
            known.show(step.state, step.behaviour, step.target)
    return GuidedDeclaredWorld(activity, shown.people, seed=shown.seed, shown=known)
