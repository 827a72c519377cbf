"""Interrupted games: found at the next start, then resumed or ended."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_profiles.game_records import GameEnding
from tangy_profiles.game_world import GameWorld
from tangy_profiles.past_game import PastGame, interrupted_game
from tangy_tui.app.rooms import find_room

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace


def find_interrupted(workspace: Workspace, world: GameWorld) -> PastGame | None:
    """Return the interrupted game of the workspace's activity in a world, None if there is none."""
    past = interrupted_game(workspace.store, workspace.activity.name)
    return past if past is not None and past.world == world else None


def take_up(workspace: Workspace, past: PastGame) -> None:
    """Restore the seats and the room of an interrupted game that is to be resumed.

    Raises:
        TangyError: its room is not available.
    """
    if not workspace.room_is_given:
        room = past.beginning.room
        workspace.choose_room(find_room(workspace.store.folder, room) if room else None)
    workspace.seat(past.beginning.people)


def end_interrupted(workspace: Workspace, past: PastGame, reason: str) -> None:
    """Log the end of an interrupted game, with a reason for people to read."""
    game = past.beginning.game
    workspace.store.append(GameEnding(game=game, steps=len(past.steps), stopped=reason))
