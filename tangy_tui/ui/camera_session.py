"""The robot's cameras in the application: opened when needed, closed at the end."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tangy_hw.perception.camera_hub import CameraHub
    from tangy_profiles.health import Health
    from tangy_tui.app.workspace import Workspace

FIRST_SECONDS = 5.0
"""The longest wait of a game for the first pictures of its cameras."""


class CameraSession:
    """A robot's cameras, and whether their faults count in simulated games."""

    def __init__(
        self, workspace: Workspace, sensors: CameraHub | None = None, *, live: bool = False
    ) -> None:
        """Prepare the cameras.

        Args:
            workspace: the workspace with the robot.
            sensors: the cameras (default: those of the robot's profile).
            live: whether their faults count as faults in a simulated game.
        """
        self.live = live
        self._workspace = workspace
        self._sensors = sensors

    def sensors(self) -> CameraHub:
        """Return the cameras; the caller opens them.

        Raises:
            TangyError: the robot's profile names an invalid source.
        """
        if self._sensors is None:
            from tangy_hw.perception.camera_hub import sensors_of

            workspace = self._workspace
            self._sensors = sensors_of(
                workspace.robot, workspace.activity.deck, workspace.store.folder
            )
        return self._sensors

    @asynccontextmanager
    async def watching(self) -> AsyncIterator[Callable[[], Health] | None]:
        """Keep the cameras open for a game; yield their readings, None if these do not count."""
        if not self.live:
            yield None
            return
        async with self.sensors() as sensors:
            await sensors.settled(FIRST_SECONDS)
            yield sensors.health

    async def close(self) -> None:
        """Close all cameras, even while in use."""
        if self._sensors is not None:
            await self._sensors.close()
