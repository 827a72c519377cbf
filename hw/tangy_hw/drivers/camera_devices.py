"""Lists this machine's cameras from Linux's sysfs, without opening them."""

from __future__ import annotations

import os
import re
from pathlib import Path

from tangy_profiles.reading import plain

LISTED = Path("/sys/class/video4linux")
DEVICES = Path("/dev")


def list_cameras(listed: Path = LISTED, devices: Path = DEVICES) -> list[tuple[str, str, bool]]:
    """Return the device path and title of each camera, and whether this user may open it.

    A camera may have several devices; only the first delivers frames.

    Args:
        listed: folder in which the system lists video devices.
        devices: folder of the device files.
    """
    found = []
    for folder in listed.glob("video*"):
        number = re.fullmatch(r"video([0-9]+)", folder.name)
        if number is None or _text(folder / "index", "0") != "0":
            continue
        device = devices / folder.name
        if device.exists():
            may = os.access(device, os.R_OK | os.W_OK)
            title = plain(_text(folder / "name", "camera"))
            found.append((int(number[1]), str(device), title, may))
    return [(device, title, may) for _, device, title, may in sorted(found)]


def _text(path: Path, otherwise: str) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace").strip() or otherwise
    except OSError:
        return otherwise
