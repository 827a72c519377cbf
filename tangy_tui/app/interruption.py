"""Interrupted games: found at the next start, then resumed or ended."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from tangy_profiles.game_records import GameEnding
from tangy_profiles.game_world import SIMULATED, GameWorld
from tangy_profiles.past_game import PastGame, interrupted_game
from tangy_tui.app.rooms import check_places, find_room
from tangy_tui.monitoring.earlier import EarlierPart, read_earlier

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace


@dataclass(frozen=True, slots=True)
class TakenUp:
    """A resumed game, and the ids of people who came meanwhile and cannot join it."""

    past: PastGame
    waiting: tuple[str, ...] = ()


def find_interrupted(workspace: Workspace, world: GameWorld) -> PastGame | None:
    """Return the game of the workspace's activity that was interrupted in a world, if one was."""
    past = interrupted_game(workspace.store, workspace.activity.name)
    if past is None or past.world != world:
        return None
    game = past.beginning.game
    for one in past.changes:
        if (one.game, one.what) == (game, "joined"):
            past = past.joined_by(one.person, workspace.activity.unread, one.place)
    return past


def earlier_part(
    workspace: Workspace, past: PastGame | None, *, joined: bool
) -> EarlierPart | None:
    """Return what happened before a game was interrupted; None if there is no such game.

    Args:
        workspace: the workspace of the game.
        past: the interrupted game.
        joined: whether it was only interrupted for a new person.
    """
    if past is None:
        return None
    activity, names = workspace.activity, workspace.names
    return read_earlier(workspace.store, past, activity, names, joined=joined)


def can_join(workspace: Workspace, past: PastGame) -> bool:
    """Return whether people can join an interrupted game that is resumed.

    Simulated people cannot; where teams play, the teams stay the same.
    """
    return past.world != SIMULATED and not workspace.activity.teams


def take_up(
    workspace: Workspace, past: PastGame, places: Mapping[str, int] | None = None
) -> TakenUp:
    """Restore the seats and the room of an interrupted game that is resumed.

    People who came meanwhile join it if possible: at their `places` (from 0), on the seats that
    staff gave them before the interruption, or on the next ones.
    People who no longer take part count as participants of this game.

    Raises:
        TangyError: its room is not available, or is too small.
    """
    room = workspace.chosen_room
    if not workspace.room_is_given:
        named = past.beginning.room
        room = find_room(workspace.store.folder, named) if named else None
    there = past.beginning.people
    given = dict(past.came)
    new = tuple(one for one in (*given, *workspace.names) if one not in there)
    new = tuple(one for one in dict.fromkeys(new) if one in workspace.names)
    joins = new if can_join(workspace, past) else ()
    if room is not None:
        check_places(room, len(there) + len(joins))
    workspace.chosen_room = room
    workspace.gather((*there, *joins))
    going_on = replace(past, newcomers=joins)
    for person in joins:
        next_place = workspace.room.next_place(len(going_on.beginning.people))
        place = given.get(person, next_place) if places is None else places[person]
        going_on = going_on.joined_by(person, workspace.activity.unread, place)
    workspace.gather(going_on.beginning.people)
    return TakenUp(going_on, () if joins else new)


def end_interrupted(workspace: Workspace, past: PastGame, reason: str) -> None:
    """Log the end of an interrupted game, with a reason for people to read."""
    game = past.beginning.game
    workspace.store.append(GameEnding(game=game, steps=len(past.steps), stopped=reason))
