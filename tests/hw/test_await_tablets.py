"""Waiting for tablets, which connect again after a restart of the robot."""

from __future__ import annotations

from itertools import count
from typing import cast

import pytest

from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_client.commands import RETURN_SECONDS, Commands
from tangy_hw.robot_client.robot_state import RobotState
from tangy_profiles.health import Health
from tests.hw.links import FakeLink


class Restarted(FakeLink):
    """A robot that counts its heartbeats."""

    beats = 0

    def beat(self) -> RobotState:
        self.beats += 1
        return super().beat()


@pytest.fixture
def link() -> Restarted:
    return Restarted(("user1",))


def commands(link: Restarted, *found: dict[str, bool]) -> Commands:
    """Diagnose these faults before the first heartbeat, the second one, and so on."""
    made = Commands(cast("RobotLink", link))

    def diagnosed(_: Health) -> dict[str, bool]:
        return found[min(link.beats, len(found) - 1)]

    made.diagnosed = diagnosed
    return made


def test_a_game_waits_until_the_tablet_is_back(link: Restarted) -> None:
    commands(link, {"screen-dead": False}, {"screen-dead": False}, {}).await_tablets()
    assert link.beats == 2


def test_a_critical_fault_is_told_at_once(link: Restarted) -> None:
    commands(link, {"screen-dead": False, "camera-dead": True}).await_tablets()
    assert not link.beats


def test_a_game_does_not_wait_for_ever(link: Restarted, monkeypatch: pytest.MonkeyPatch) -> None:
    seconds = count()
    monkeypatch.setattr("time.monotonic", lambda: float(next(seconds)))
    commands(link, {"screen-dead": False}).await_tablets()
    assert link.beats == RETURN_SECONDS - 1
