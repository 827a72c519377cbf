"""Records scans with odometry poses while driving, as a log that `scan_log` reads.

Each line is a ROBOTLASER1 message of CARMEN's log format. Both of its poses are the laser pose by
wheel odometry, without correction.
"""

from __future__ import annotations

import logging
from io import TextIOWrapper
from math import hypot, isfinite
from pathlib import Path

from tangy_hw.device_protocols import DeviceError, Pose, Scan
from tangy_hw.navigation.poses import relative_pose

_LOG = logging.getLogger(__name__)

MOVED, TURNED = 0.05, 0.05
"""m and rad between recorded scans: matching needs no more than one in 10 cm."""


class ScanRecorder:
    """Appends a scan to a log whenever the laser has moved."""

    def __init__(self, path: Path) -> None:
        """Create the log file.

        Args:
            path: the log file, which must not exist yet.

        Raises:
            DeviceError: the file exists, or cannot be written.
        """
        try:
            self._file: TextIOWrapper = path.open("x", encoding="ascii", buffering=1)
        except OSError as error:
            raise DeviceError(f"{path}: cannot be written ({error.strerror}).") from None
        self._last: Pose | None = None
        self.failed = False
        """Whether the log could not be written (a full disk); nothing is recorded after that."""

    def note(self, scan: Scan, pose: Pose, stamp: float) -> None:
        """Record a scan if the laser has moved since the last one; `stamp` is in s."""
        if self._last is not None:
            step = relative_pose(self._last, pose)
            if hypot(step.x, step.y) < MOVED and abs(step.heading) < TURNED:
                return
        if self.failed:
            return
        self._last = pose
        try:
            self._file.write(robot_laser_line(scan, pose, stamp))
        except OSError as error:  # the robot must still be driven and stopped
            self.failed = True
            _LOG.error("the scans cannot be recorded: %s", error.strerror)

    def close(self) -> None:
        """Close the log."""
        self._file.close()


def robot_laser_line(scan: Scan, pose: Pose, stamp: float) -> str:
    """Return a scan as a ROBOTLASER1 line; `pose` is the laser's, `stamp` is in s."""
    ranges = (value if isfinite(value) else scan.farthest for value in scan.ranges.tolist())
    at = f"{pose.x:.4f} {pose.y:.4f} {pose.heading:.5f}"
    return (
        f"ROBOTLASER1 0 {scan.first:.7f} {scan.step * len(scan.ranges):.7f} {scan.step:.9f} "
        f"{scan.farthest:.3f} 0 0 {len(scan.ranges)} {' '.join(f'{one:.3f}' for one in ranges)} "
        f"0 {at} {at} 0 0 0 0 0 {stamp:.3f} tangy {stamp:.3f}\n"
    )
