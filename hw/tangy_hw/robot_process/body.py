"""The devices of one robot together."""

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


@dataclass(frozen=True)
class Body:
    """The devices of a robot that are there; what it has not is None."""

    base: Base
    laser: Laser
    stop_button: StopButton | None = None
    arms: Arms | None = None
    voice: Voice | None = None
    screen: ChestScreen | None = None
    others: tuple[Device, ...] = ()
    """What else is opened and closed: a link that several of them share."""

    @property
    def all(self) -> tuple[Device, ...]:
        """All of them, those first through which others are reached."""
        own = (self.base, self.laser, self.stop_button, self.arms, self.voice, self.screen)
        return (*self.others, *(device for device in own if device is not None))

    async def restart(self, device: str) -> None:
        """Switch a device off and on again."""
        for one in self.all:
            if one.name == device:
                await one.close()
                await one.start()

    async def relax(self) -> None:
        """Let the arms hang without torque."""
        if self.arms is not None:
            await self.arms.relax()

    @property
    def at_hand(self) -> dict[str, str]:
        """What staff need once it is on: the address of the chest screen, and the code there.

        Both are "" where the chest screen is no page.
        """
        return {"screen": getattr(self.screen, "url", ""), "code": getattr(self.screen, "code", "")}

    @property
    def calls_answered(self) -> tuple[str, ...]:
        """The keys of the open calls that were answered at the chest screen."""
        return self.screen.answered if isinstance(self.screen, AnswersCalls) else ()

    def offer_calls(self, calls: Mapping[str, str]) -> None:
        """Show a button for each open call, if the chest screen can: who is called, by its key."""
        if isinstance(self.screen, AnswersCalls):
            self.screen.offer(calls)
