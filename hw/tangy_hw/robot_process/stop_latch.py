"""Latch of stops: who has stopped the robot, and whether its own control has failed."""

from __future__ import annotations

from tangy_hw.device_protocols import DeviceError

ALONE = "the program says nothing"
"""Why the robot stops if the program falls silent; it goes on once the program is back."""

STAFF, FAULT = "staff", "fault"
"""Sources of a stop: a person at a screen, or a diagnosed fault."""


class Preempted(DeviceError):
    """A task was aborted, because the robot has to stop."""


class StopLatch:
    """Active stops, one for each source; the robot is released when all are."""

    def __init__(self) -> None:
        self.failed = ""
        """Permanent failure, which only a new robot process fixes."""
        self._by: dict[str, str] = {}

    @property
    def why(self) -> str:
        """Why the robot is stopped, "" if it is not."""
        return self.failed or next(iter(self._by.values()), "")

    def hold(self, why: str, by: str) -> None:
        """Stop for a source, until it releases the stop."""
        self._by.setdefault(by, why)

    def release(self, by: str = "") -> None:
        """Release the stop of one source, or of all."""
        if by:
            self._by.pop(by, None)
        else:
            self._by.clear()
