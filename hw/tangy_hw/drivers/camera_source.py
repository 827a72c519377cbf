"""Finds camera sources by name.

0, /dev/video2         a camera of this machine (V4L2)
http://..., rtsp://... a stream: MJPEG over HTTP, or a network camera's
ros://HOST:9090/TOPIC  a topic of a rosbridge server, sensor_msgs/CompressedImage; ros2:// for ROS 2
FILE.avi               a recorded video, at its own frame rate
DIR, FILE.png          a folder of images in the order of their names, or one image
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Literal
from urllib.parse import urlsplit

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain

Kind = Literal["device", "stream", "file", "folder"]

SCHEMES = ("http", "https", "rtsp", "rtsps", "ros", "ros2")
PICTURES = (".png", ".jpg", ".jpeg", ".bmp", ".webp", ".tif", ".tiff", ".pgm", ".ppm")
FOLDER_RATE = 5.0
"""Default frame rate of a folder of images, per second."""

WIDTH, HEIGHT = 1280, 720
"""Requested resolution; the card reader needs it."""


class CameraError(TangyError):
    """A camera without usable frames; one sentence that names it."""


@dataclass(frozen=True, slots=True)
class CameraSource:
    """A camera, stream, file or folder.

    `rate` is the frame rate per second, 0 for the source's own; `loop` restarts it at its end. With
    `each` no frame is skipped, and the next one is read once the last one was taken; otherwise
    frames come at their own rate, taken or not.
    """

    name: str
    kind: Kind
    target: str
    rate: float = 0.0
    loop: bool = False
    each: bool = False
    width: int = WIDTH
    height: int = HEIGHT

    @property
    def live(self) -> bool:
        """Whether it is live, so that a lost source is opened again."""
        return self.kind in ("device", "stream")


def find_camera(name: str, *, loop: bool = False, each: bool = False) -> CameraSource:
    """Find a source by its name, without opening it.

    Args:
        name: one of those above.
        loop: restart a file or folder at its end.
        each: deliver every frame of a file or folder, as fast as they are taken.

    Raises:
        CameraError: there is no such source; one sentence that says why.
    """
    shown = plain(name)
    if re.fullmatch(r"\d{1,3}", name):
        return CameraSource(shown, "device", f"/dev/video{int(name)}")
    if "://" in name:
        return CameraSource(_without_password(name), "stream", _stream(name))
    path = Path(name)
    if re.match(r"/dev/(?!shm/)", name):  # /dev/shm holds files
        return CameraSource(shown, "device", name)
    try:
        is_folder, is_file, there = path.is_dir(), path.is_file(), path.exists()
    except (OSError, ValueError):
        raise CameraError(f"{shown}: cannot be read (the name is not valid).") from None
    if not there:
        raise CameraError(
            f"{shown}: there is no such file; a camera is 0, /dev/video0, http://... or rtsp://..."
        )
    if is_folder:
        if not pictures_in(path):
            raise CameraError(f"{shown}: there are no pictures in this folder.")
        return CameraSource(shown, "folder", name, FOLDER_RATE, loop, each)
    if not is_file:
        raise CameraError(f"{shown}: is neither a file nor a folder.")
    if path.suffix.lower() in PICTURES:
        return CameraSource(shown, "folder", name, FOLDER_RATE, loop, each)
    return CameraSource(shown, "file", name, loop=loop, each=each)


def pictures_in(path: Path) -> list[Path]:
    """Return the images of a folder in natural order of their names, or the one image.

    Raises:
        CameraError: the folder cannot be read.
    """
    if not path.is_dir():
        return [path]
    try:
        found = [one for one in path.iterdir() if one.suffix.lower() in PICTURES and one.is_file()]
    except OSError as error:
        raise CameraError(plain(f"{path}: cannot be read ({error.strerror}).")) from None
    return sorted(found, key=lambda one: _natural(one.name))


def _natural(name: str) -> list[tuple[int, int, str]]:
    pieces = re.findall(r"[0-9]+|[^0-9]+", name)
    return [(0, int(one), "") if one.isdecimal() else (1, 0, one.lower()) for one in pieces]


def _stream(url: str) -> str:
    try:
        parts = urlsplit(url)
        sound = parts.scheme.lower() in SCHEMES and bool(parts.hostname) and (parts.port or 1) > 0
        sound &= not parts.scheme.lower().startswith("ros") or len(parts.path) > 1
    except ValueError:
        sound = False
    if not sound or any(ord(sign) <= 32 or ord(sign) == 127 for sign in url):
        raise CameraError(
            f"{_without_password(url)}: is no address of a stream; "
            f"give http://HOST/..., https://, rtsp://, rtsps:// or ros://HOST:9090/TOPIC."
        )
    return url


def _without_password(url: str) -> str:
    return plain(re.sub(r"(?<=://)[^/@]*@", "", url))
