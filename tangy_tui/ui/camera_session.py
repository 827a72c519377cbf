"""The cameras of the robot as the program has them: made when they are needed, ended with it."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tangy_hw.perception.camera_hub import CameraHub
    from tangy_profiles.health import Health
    from tangy_tui.app.workspace import Workspace

FIRST_SECONDS = 5.0
"""For which a game waits at most for the first pictures of its cameras."""


class CameraSession:
    """A robot's cameras, and whether they count in simulated games."""

    def __init__(
        self, workspace: Workspace, sensors: CameraHub | None = None, *, live: bool = False
    ) -> None:
        """Prepare them.

        Args:
            workspace: whose robot it is.
            sensors: its cameras (default: those of the robot's profile).
            live: what is wrong with them is a fault in a simulated game.
        """
        self.live = live
        self._workspace = workspace
        self._sensors = sensors

    def sensors(self) -> CameraHub:
        """Return the cameras; the caller opens them.

        Raises:
            TangyError: the robot's profile names a source that is none.
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
        """Keep them open for a game; give what they report there, None where they do not count."""
        if not self.live:
            yield None
            return
        async with self.sensors() as sensors:
            await sensors.settled(FIRST_SECONDS)
            yield sensors.health

    async def close(self) -> None:
        """Close all of them, also while they are in use."""
        if self._sensors is not None:
            await self._sensors.close()
