"""A real camera in a simulated game: its faults and their ends are noticed."""

from __future__ import annotations

import pytest

from tangy_hw.drivers.camera_state import Sight
from tangy_profiles.health import Health
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tests.support.games import codes, moves, until

WELL = Sight("OK", "", 8.0, 0.05, 0.0, 0.5, 0.2, 0.6)
COVERED = Sight("COVERED", "Nothing can be seen.", 1.0, 0.05, 0.0, 0.01, 0.005, None)
GONE = Sight("DISCONNECTED", "No picture has come.", 1.0, 2.0, 0.0, 0.5, 0.2, 0.6)
FROZEN = Sight("FROZEN", "The very same picture.", 1.0, 0.05, 3.0, 0.5, 0.2, 0.6)


class Camera:
    """A head camera in a given state."""

    def __init__(self) -> None:
        self.sight = WELL
        self.asked = 0

    def health(self) -> Health:
        self.asked += 1
        return (self.sight.reading("camera"),)


@pytest.fixture
def camera(monkeypatch: pytest.MonkeyPatch) -> Camera:
    monkeypatch.setattr("tangy_tui.app.partly_live_world.OLDEST", -1.0)
    return Camera()


@pytest.mark.parametrize(
    ("sight", "code", "halts"),
    [
        (COVERED, "camera-occluded", False),
        (GONE, "camera-disconnected", True),
        (FROZEN, "camera-frozen", True),
    ],
)
def test_a_fault_of_a_real_camera_is_diagnosed_until_it_ends(
    sight: Sight, code: str, halts: bool, workspace: Workspace, learnt: Policy, camera: Camera
) -> None:
    game = workspace.supervision(learnt, 3, live=camera.health)
    game.begin()
    until(game, lambda now: now.game.steps > 3)
    assert not game.faults
    camera.sight = sight
    assert codes(game.look()) == [code]
    assert (game.halted is not None) == halts
    camera.sight = WELL
    if halts:
        game.acknowledge("Ada")
        assert "cleared" in moves(game.clear("Ada"))
    else:
        until(game, lambda now: not now.waiting)
    assert game.halted is None and game.status == ("OK", "")


def test_devices_that_are_not_real_stay_simulated(
    workspace: Workspace, learnt: Policy, camera: Camera
) -> None:
    game = workspace.supervision(learnt, 3, live=camera.health)
    simulated = workspace.supervision(learnt, 3)
    game.begin()
    simulated.begin()
    assert [r.device for r in game.world.health()] == [r.device for r in simulated.world.health()]
    assert {r.device for r in game.world.health() if r not in simulated.world.health()} == {
        "camera"
    }


def test_a_camera_is_not_queried_more_often_than_its_readings_change(
    workspace: Workspace, learnt: Policy, camera: Camera, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tangy_tui.app.partly_live_world.OLDEST", 60.0)
    game = workspace.supervision(learnt, 3, live=camera.health)
    game.begin()
    first = game.world.health()
    assert all(game.world.health() is first for _ in range(50))
    assert camera.asked == 1


def test_a_fault_of_another_device_can_still_be_injected(
    workspace: Workspace, learnt: Policy, camera: Camera
) -> None:
    game = workspace.supervision(learnt, 3, live=camera.health, injections=["base-failed"])
    game.begin()
    until(game, lambda now: now.halted)
    assert [fault.code for fault in game.faults] == ["base-failed"]
