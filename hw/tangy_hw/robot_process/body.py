"""The devices of one robot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tangy_hw.device_protocols import (
    AnswersCalls,
    Arms,
    Base,
    ChestScreen,
    Device,
    Laser,
    StopButton,
    Voice,
)
from tangy_hw.robot_process.driver_checks import restart_device


@dataclass(frozen=True)
class Body:
    """The devices of a robot; missing ones are None."""

    base: Base
    laser: Laser
    stop_button: StopButton | None = None
    arms: Arms | None = None
    voice: Voice | None = None
    screen: ChestScreen | None = None
    others: tuple[Device, ...] = ()
    """Other things to open and close: shared links."""

    @property
    def all(self) -> tuple[Device, ...]:
        """All devices; those on which others depend come first."""
        own = (self.base, self.laser, self.stop_button, self.arms, self.voice, self.screen)
        return (*self.others, *(device for device in own if device is not None))

    async def restart(self, device: str) -> None:
        """Switch a device off and on again.

        Raises:
            TangyError: its driver fails, or takes too long.
        """
        for one in self.all:
            if one.name == device:
                await restart_device(one)

    async def relax(self) -> None:
        """Switch the torque of the arms off."""
        if self.arms is not None:
            await self.arms.relax()

    @property
    def at_hand(self) -> dict[str, str]:
        """Address of the chest screen and its code, for staff; "" if it has no page."""
        return {"screen": getattr(self.screen, "url", ""), "code": getattr(self.screen, "code", "")}

    @property
    def calls_answered(self) -> tuple[str, ...]:
        """Keys of the open calls that were answered at the chest screen."""
        return self.screen.answered if isinstance(self.screen, AnswersCalls) else ()

    def offer_calls(self, calls: Mapping[str, str]) -> None:
        """Show a button for each open call, if the screen can: the called person's name by key."""
        if isinstance(self.screen, AnswersCalls):
            self.screen.offer(calls)
