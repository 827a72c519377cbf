"""Whether wheels and laser agree about how the robot moved."""

from __future__ import annotations

from tangy_hw.devices import Pose, Scan
from tangy_hw.navigation.poses import HERE


class Disagreement:
    """Compares the wheels with matched scans over the last stretch of the way."""

    def __init__(self, laser: Pose = HERE) -> None:
        self._laser = laser

    def update(self, odometry: Pose, scan: Scan) -> float:
        """Take in wheels and laser at one moment; return by how many metres they disagree."""
        return 0.0

    def reset(self) -> None:
        """Begin anew."""
