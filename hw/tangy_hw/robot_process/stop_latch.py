"""Why a robot stands still: who has stopped it, and whether its own control has failed."""

from __future__ import annotations

from tangy_hw.device_protocols import DeviceError

STAFF, FAULT = "staff", "fault"
"""Who stops a robot: somebody at the screen, or what was diagnosed."""


class Preempted(DeviceError):
    """Something was not done to its end, because the robot has to stand still."""


class StopLatch:
    """The stops that hold, one for each who asked for one; it is let go when all have."""

    def __init__(self) -> None:
        self.failed = ""
        """Why nothing can let it move again but another robot process."""
        self._by: dict[str, str] = {}

    @property
    def why(self) -> str:
        """Why it is stopped, "" if nobody holds it."""
        return self.failed or next(iter(self._by.values()), "")

    def hold(self, why: str, by: str) -> None:
        """Hold it for somebody, until they release it."""
        self._by.setdefault(by, why)

    def release(self, by: str = "") -> None:
        """Take back what somebody said, or all that anybody did."""
        if by:
            self._by.pop(by, None)
        else:
            self._by.clear()
