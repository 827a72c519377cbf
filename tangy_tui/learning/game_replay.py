"""Replay of demonstrated games, step by step, each in its own world."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeAlias

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import TangyError
from tangy_tui.learning.editing import new_id
from tangy_tui.learning.library_entries import Library, LibraryEntry
from tangy_tui.learning.teaching_events import Again
from tangy_tui.world import World

MakeWorld: TypeAlias = Callable[[Demonstration], World]
"""Make the world of a demonstration (its seed, people, guided), in its first state."""


class NotAsBefore(Exception):
    """A redone step had a different result."""


@dataclass(frozen=True, slots=True)
class ReplayedGame:
    """The world after a demonstration, and the numbers of each step (see `Outcome.numbers`)."""

    world: World
    numbers: tuple[tuple[int, ...], ...]


def replay_game(
    activity: Activity, make_world: MakeWorld, demonstration: Demonstration
) -> ReplayedGame | None:
    """Replay a demonstration; return None if its states differ."""
    world = make_world(demonstration)
    numbers: list[tuple[int, ...]] = []
    for step in demonstration.steps:
        behaviour = activity.behaviours.get(step.behaviour)
        if behaviour is None or world.observe() != step.state:
            return None
        numbers.append(world.execute(activity.action(behaviour, step.target, None)).numbers)
        if world.observe() != step.after:
            return None
    return ReplayedGame(world, tuple(numbers))


def shown_again(library: Library, again: Again, teacher: str) -> Demonstration:
    """Return a new demonstration that repeats another one's first steps, ready to continue.

    Raises:
        TangyError: it cannot be shown again; the message says why.
    """
    entry = library.find(again.demonstration)
    source, kept = entry.demonstration, again.kept
    if entry.hidden not in ("", "deleted"):
        raise TangyError(f"It is not in use ({entry.hidden}): show again what took its place.")
    if not source.replayable:
        raise TangyError("It was not shown in one game, so there is no game to go back to.")
    if not 0 <= kept < len(source.steps):
        raise TangyError(f"It has {len(source.steps)} steps: there is no step {kept + 1}.")
    return replace(
        source,
        id=new_id(),
        teacher=teacher,
        steps=source.steps[:kept],
        finished=False,
        origin="again",
        of=(source.id,),
    )


def unfinished(library: Library, teacher: str, *, guided: bool) -> LibraryEntry | None:
    """Return a teacher's latest unfinished demonstration; with `guided`, only a guided one."""
    for entry in reversed(library.entries.values()):
        kept = entry.demonstration
        wanted = kept.guided or not guided
        if wanted and kept.teacher == teacher and not kept.finished and not entry.hidden:
            return entry
    return None
