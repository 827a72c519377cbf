"""A fault during the recovery from another: each keeps its own result."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tangy_profiles.health import Health
from tangy_sim.worlds.faulty_world import FaultyWorld
from tests.monitoring.conftest import Supervise
from tests.support.games import codes, ended, play


@pytest.mark.parametrize(
    ("first", "second", "seed"),
    [
        # The place is unknown again because the link that reports it is lost.
        ("carried-off@4", "link-lost@recovery", 17),
        # A person who corrects a card while the camera is covered has not refused.
        ("card-out-of-sight@8", "camera-occluded@recovery", 0),
        # An expert repairs a lost link first: without it no other repair is visible.
        ("laser-disconnected@8", "link-lost@recovery", 0),
    ],
)
def test_two_overlapping_faults_are_each_reported_once(
    supervise: Supervise, first: str, second: str, seed: int
) -> None:
    events = play(supervise(first, second, seed=seed))
    assert codes(events) == [first.partition("@")[0], second.partition("@")[0]]
    assert ended(events).stopped is None


def test_a_fault_of_a_silent_device_is_not_taken_for_over(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A real scanner without its cable no longer reports that it is covered."""
    for seed in (14, 15):  # nobody uncovers it at once
        game = supervise("laser-occluded@7", "laser-disconnected@recovery", seed=seed)
        world = game.world
        assert isinstance(world, FaultyWorld)

        def health(world: FaultyWorld = world, told: Callable[[], Health] = world.health) -> Health:
            silent = "laser-disconnected" in world.present
            bare = {"laser"} if silent else set()
            return tuple(r._replace(facts={}) if r.device in bare else r for r in told())

        monkeypatch.setattr(world, "health", health)
        assert codes(play(game)) == ["laser-occluded", "laser-disconnected"]
