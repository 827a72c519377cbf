"""Requests for help that go over from the last game into one that staff have set up anew."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import BENCH
from tangy_tui.monitoring.attention import open_at_end
from tangy_tui.monitoring.games import read_games
from tangy_tui.monitoring.house import last_session
from tangy_tui.monitoring.replay import Noted, read_replays

if TYPE_CHECKING:
    from tangy_hw.robot_client.live_world import LiveWorld
    from tangy_profiles.store import Store


def wait_on(store: Store, robot: LiveWorld) -> dict[str, float]:
    """Let people who asked in vain in the last game of this session wait on; return how long (s).

    If the robot sees signs, people who still ask have theirs up: only requests that staff made by
    word go over. Call it before the first game after the robot was switched on.
    """
    waits = dict[str, float]()
    with suppress(TangyError):  # the game does not depend on it
        waits = _waits(store, robot)
    robot.requests.wait_on(waits)
    return waits


def _waits(store: Store, robot: LiveWorld) -> dict[str, float]:
    games = last_session(read_games(store))
    between = games[-1].seconds_before(store.now(), robot.played_in) if games else None
    if between is None or games[-1].ended is None:
        return {}
    replays = read_replays(store, games, {robot.activity.name: robot.activity}, {})
    noted = (moment.what for replay in replays for moment in replay.moments)
    by_word = {one.person for one in noted if isinstance(one, Noted) and one.did == "asked for"}
    return {
        person: wait + between
        for person, wait in open_at_end(replays).items()
        if person in robot.people
        and (
            person in by_word
            or robot.played_in == BENCH
            or robot.requests.sign_of(person) == "no sensor"
        )
    }
