"""What happened in a game before it was interrupted, read from the log for staff who resume it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from datetime import datetime
from typing import TYPE_CHECKING

from tangy_profiles.game_world import SIMULATED
from tangy_tui.monitoring.games import read_games
from tangy_tui.monitoring.replay import Moment, read_replays

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_profiles.past_game import PastGame
    from tangy_profiles.store import Store
    from tangy_tui.monitoring.fault import Fault


@dataclass(frozen=True, slots=True)
class EarlierPart:
    """The part of a game before an interruption, with the earlier games of the same session."""

    at: datetime
    """When its last event was logged (UTC)."""
    moments: tuple[Moment, ...] = ()
    """The events of all these games, the oldest first."""
    faults: tuple[Fault, ...] = ()
    """The faults of the interrupted game, as they were when it was interrupted."""
    joined: bool = False
    """Whether it was only interrupted for a new person, and the same program goes on."""


def read_earlier(
    store: Store,
    past: PastGame,
    activity: Activity,
    names: Mapping[str, str],
    *,
    joined: bool = False,
) -> EarlierPart:
    """Read what happened before a game was interrupted.

    Args:
        store: the log.
        past: the game.
        activity: the activity of the game.
        names: people's names by id.
        joined: whether it was only interrupted for a new person.
    """
    own = past.beginning.game
    ids = {own, *(beginning.game for beginning in past.run)}
    games = [game for game in read_games(store) if game.id in ids]
    replays = read_replays(store, games, {activity.name: activity}, names)
    real = past.world != SIMULATED
    moments = tuple(moment for replay in replays for moment in replay.moments)
    return EarlierPart(
        max((datetime.fromisoformat(moment.at) for moment in moments[-1:]), default=past.at),
        moments,
        tuple(
            replace(fault, real_time=real)
            for replay in replays
            if replay.game.id == own
            for fault in replay.faults
        ),
        joined,
    )
