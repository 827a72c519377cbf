"""The sessions of a log, and their reports."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING

from tangy_profiles.errors import ProfileError

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.monitoring.games import Game
    from tangy_tui.monitoring.session import Session


def read_sessions(workspace: Workspace) -> list[list[Game]]:
    """Read the games of each session, the last session first."""
    from tangy_tui.monitoring.games import read_games

    return sessions_of(read_games(workspace.store))


def sessions_of(games: Sequence[Game]) -> list[list[Game]]:
    """Return the games of each session, the last session first; see `last_session`."""
    from tangy_tui.monitoring.house import last_session

    sessions: list[list[Game]] = []
    left = list(games)
    while left:
        sessions.append(last_session(left))
        del left[-len(sessions[-1]) :]
    return sessions


def read_report(workspace: Workspace, games: Sequence[Game], names: Mapping[str, str]) -> Session:
    """Read what the log tells of the games of a session; `names` are those of people, by id.

    Raises:
        TangyError: the log cannot be read.
    """
    from tangy_tui.monitoring.session import read_session

    known = {**played_activities(games), workspace.activity.name: workspace.activity}
    return read_session(workspace.store, games, known, names)


def played_activities(games: Sequence[Game]) -> dict[str, Activity]:
    """Load the activities of games, by their names, unless their files moved or have mistakes."""
    from tangy_profiles.activity import known_activities, load_activity

    wanted = {game.activity for game in games}
    known = {name: load_activity(name) for name in sorted(wanted & known_activities().keys())}
    for path in dict.fromkeys(game.file for game in games if game.file):
        with suppress(ProfileError):
            played_from = load_activity(path)
            known[played_from.name] = played_from
    return known
