"""Records frames for labelling: a PNG for each, with a JSON file beside it.

    000001.png
    000001.json   {"file": "000001.png", "source", "taken", "stamp", "seq", "state", "why",
                   "evidence": {"age", "unchanged", "brightness", "contrast", "sharpness"},
                   "seen": output of a reader, or null, "label": null}

A person fills in `label`. New frames are added to those already in a folder.
"""

from __future__ import annotations

import asyncio
import json
import re
import time
from collections.abc import AsyncIterator, Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tangy_hw.drivers.camera import Camera, Frame
from tangy_hw.drivers.camera_source import CameraError
from tangy_profiles.reading import plain

if TYPE_CHECKING:
    from tangy_hw.drivers.camera_look import Image

Reader = Callable[["Image"], Any]
"""Returns the contents of an image (BGR) as JSON."""


async def capture(
    camera: Camera,
    folder: Path,
    *,
    count: int | None = None,
    seconds: float | None = None,
    every: float = 0.0,
    reader: Reader | None = None,
) -> AsyncIterator[dict[str, Any]]:
    """Record frames of a started camera, and yield the metadata written for each.

    Args:
        camera: source of the frames.
        folder: destination; created if necessary.
        count: maximum number of frames; None: no limit.
        seconds: maximum duration; None: no limit.
        every: minimum time between two frames in s.
        reader: called with each frame for its `seen`.

    Raises:
        CameraError: the source cannot be read, or the folder cannot be written to.
    """
    number = await asyncio.to_thread(_prepare, folder)
    began = time.monotonic()
    last, kept = -every, 0
    while count is None or kept < count:
        left = None if seconds is None else began + seconds - time.monotonic()
        if left is not None and left <= 0:
            return
        frame = await camera.frame(wait=left)
        if frame is None:
            return
        if frame.stamp - last < every:
            continue
        last, kept = frame.stamp, kept + 1
        yield await asyncio.to_thread(_keep, frame, folder, number + kept, camera.name, reader)


def _prepare(folder: Path) -> int:
    """Create the folder for its owner alone; return the highest number used in it."""
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        names = [path.stem for path in folder.iterdir()]
    except OSError as error:
        reason = error.strerror or "it is not possible"
        raise CameraError(plain(f"{folder}: cannot be used ({reason}).")) from None
    return max((int(name) for name in names if re.fullmatch(r"[0-9]{6}", name)), default=0)


def _keep(
    frame: Frame, folder: Path, number: int, source: str, reader: Reader | None
) -> dict[str, Any]:
    import cv2

    image = frame.image()
    path = folder / f"{number:06}.png"
    taken = time.time() - (time.monotonic() - frame.stamp)
    known = {
        "file": path.name,
        "source": source,
        "taken": datetime.fromtimestamp(taken, UTC).isoformat(timespec="milliseconds"),
        "stamp": round(frame.stamp, 3),
        "seq": frame.seq,
        "state": frame.sight.state,
        "why": frame.sight.why,
        "evidence": frame.sight.evidence(),
        "seen": None if reader is None else reader(image),
        "label": None,
    }
    encoded = cv2.imencode(".png", image)[1].tobytes()
    try:
        for place, content in (
            (path, encoded),
            (path.with_suffix(".json"), json.dumps(known, indent=2).encode()),
        ):
            with place.open("xb") as file:
                place.chmod(0o600)
                file.write(content)
    except OSError as error:
        reason = error.strerror or "it is not possible"
        raise CameraError(plain(f"{path}: cannot be written ({reason}).")) from None
    return known
