"""A snapshot of the game that a program runs, for other consoles."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from tangy_profiles.codec import Count, Sparse
from tangy_profiles.game_world import GameWorld
from tangy_profiles.planned_game import PlannedGame
from tangy_profiles.scene import Scene
from tangy_tui.app.game_commands import Autonomy, Phase
from tangy_tui.app.readiness import battery_of
from tangy_tui.app.staff_view import PersonNow

if TYPE_CHECKING:
    from tangy_tui.app.game_controller import GameController


@dataclass(frozen=True, slots=True)
class GameView:
    """A snapshot of a game: who controls it, where it is played, and its scene.

    `game` is its id in the log, `number` counts from 1 over all games of the log, `robot` is the
    overall state of the robot with its `cause`, `pose` the position of the robot (m, m), if there
    is a real one.
    """

    driver: str
    game: str
    activity: str
    world: GameWorld
    number: Count
    step: Count
    phase: Phase
    robot: str
    cause: str
    scene: Scene
    pose: Sparse[tuple[float, float] | None] = None
    room: Sparse[str] = ""
    """As in `GameBeginning`."""
    seconds: Sparse[Count] = 0
    """Since the game began, in s, rounded down."""
    ends: Sparse[str] = ""
    """When the planned time of the session is over (ISO 8601); "": no limit."""
    paused: Sparse[Count | None] = None
    """How long the pause has lasted, in s, rounded down; null: the game is not paused."""
    people: Sparse[tuple[PersonNow, ...]] = ()
    """The state of each person, with times in whole s."""
    autonomy: Sparse[Autonomy] = "alone"
    pace: Sparse[float] = 0.0
    """The time between two calls in s; 0: nothing is called."""
    patterns: Sparse[tuple[str, ...]] = ()
    """The labels of the pattern that is played for, and of those that follow."""
    several: Sparse[bool] = False
    """Whether everybody who has the pattern at the same call wins."""
    battery: Sparse[float | None] = None
    """The share of the robot's charge, 0 to 1, rounded; null: no device tells it."""


TRIES = 5
"""How often a game that is changing is looked at, before there is no snapshot of it."""


def view_of(control: GameController) -> GameView | None:
    """Return a snapshot of a controller's game; None if there is none yet, or it changes on."""
    for _ in range(TRIES):
        with suppress(RuntimeError, LookupError):  # the game's thread changed it meanwhile
            return _view_now(control)
    return None


def _view_now(control: GameController) -> GameView | None:
    supervision = control.supervision
    world = supervision.world
    link = getattr(world, "link", None)
    if not supervision.games:
        return None
    robot, cause = supervision.status
    pose = link.state.pose if link is not None and link.state.number else None
    seen = control.view()
    return GameView(
        driver=control.by,
        game=supervision.game.game,
        activity=world.activity.name,
        world=world.played_in,
        number=supervision.game.log.number(supervision.game.game),
        step=supervision.steps,
        phase=control.phase,
        robot=robot,
        cause=cause,
        scene=control.plan.scene,
        pose=None if pose is None else (round(pose.x, 2), round(pose.y, 2)),
        room=supervision.game.room,
        seconds=int(seen.seconds),
        paused=None if seen.paused is None else int(seen.paused),
        ends="" if (ends := control.time.ends) is None else ends.isoformat(),
        people=tuple(_in_whole_seconds(person) for person in seen.people),
        autonomy=control.autonomy.level,
        pace=seen.pace,
        patterns=_patterns(world),
        several=supervision.game.changes.plan.several,
        battery=None if (charge := battery_of(world)) is None else round(charge, 2),
    )


def _patterns(world: object) -> tuple[str, ...]:
    patterns = world.patterns if isinstance(world, PlannedGame) else None
    return () if patterns is None else tuple(one.label for one in patterns.chosen)


def _in_whole_seconds(person: PersonNow) -> PersonNow:
    """Round a person's times down, so that the snapshot changes at most once a second."""
    waits, unvisited = person.waits, person.unvisited
    return replace(
        person,
        waits=None if waits is None else float(int(waits)),
        unvisited=None if unvisited is None else float(int(unvisited)),
    )
