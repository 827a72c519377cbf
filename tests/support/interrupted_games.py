"""Games that are broken off after some steps, for tests of what is resumed."""

from __future__ import annotations

from tangy_tui.app.game_controller import GameController
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy


def broken_off(workspace: Workspace, policy: Policy, steps: int) -> GameController:
    """Play some steps of a game, and return its controller; the log has no end of the game."""
    supervision = workspace.supervision(policy, 5)
    control = scripted_controller(supervision)
    control.begin()
    while supervision.steps < steps:
        go_on_by_script(control, expert=False)
    return control
