"""Live worlds of a workspace over a fake robot process."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_client.live_world import LiveWorld
from tests.hw.links import FakeLink

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace


def live_world(
    workspace: Workspace,
    link: FakeLink,
    kind: type[LiveWorld] = LiveWorld,
    *,
    seed: int = 1,
    **more: Any,
) -> LiveWorld:
    """Make the world of a robot with the people and the room of a workspace."""
    return kind(
        workspace.activity,
        tuple(workspace.names),
        cast(RobotLink, link),
        workspace.robot,
        workspace.room,
        seed=seed,
        names=workspace.names,
        **more,
    )
