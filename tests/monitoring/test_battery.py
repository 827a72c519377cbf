"""A battery that runs down in a game: first it is low, then nearly flat."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_profiles.health import Health, Reading
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tests.support.games import codes, until


def test_a_low_battery_that_gets_nearly_flat_halts_the_robot(
    data_folder: Path, learnt: Policy, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened = Workspace(data_folder, robot="turtlebot4")
    game = opened.supervision(learnt, 3)
    told, charge = game.world.health, [0.8]

    def health() -> Health:
        mine = Reading("battery", facts={"charge": charge[0], "charging": False})
        return tuple(mine if one.device == "battery" else one for one in told())

    monkeypatch.setattr(game.world, "health", health)
    game.begin()
    charge[0] = 0.15
    assert codes(game.look()) == ["battery-low"]
    until(game, lambda now: not now.waiting)  # it goes on
    assert game.halted is None
    charge[0] = 0.05
    assert codes(game.look()) == ["battery-flat"]
    assert game.halted is not None
    opened.close()
