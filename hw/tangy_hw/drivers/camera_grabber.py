"""Reads frames in the camera's process: with OpenCV's capture, or from image files."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from tangy_hw.drivers.camera_source import CameraError, CameraSource, pictures_in
from tangy_profiles.errors import TangyError
from tangy_profiles.given_file import read_given

if TYPE_CHECKING:
    from tangy_hw.drivers.camera_look import Image

OPEN_SECONDS = 1.5  # for a stream to answer
READ_SECONDS = 1.5  # for its next frame
FILE_RATE = 10.0  # frames a second of a video that does not say
MOST_PIXELS = 50_000_000  # of an image in a folder
LARGEST_FILE = 200_000_000  # bytes
LOWEST, ALIKE = 8, 12  # rows, and grey levels of 255: signs of the padding of an incomplete frame
ROS = ("ros://", "ros2://")
UNUSABLE = "it holds no pictures that can be read"


class NoFrame(Exception):
    """No frame could be read, with the reason in a few words. The source is opened again."""


class StreamEnded(Exception):
    """There are no more frames, with the reason in a few words; "" at a regular end."""


class Grabber(Protocol):
    """Delivers frames one by one; `rate` is the frame rate per second, or 0."""

    rate: float

    def open(self) -> None:
        """Open the source again.

        Raises:
            NoFrame: it cannot be opened now.
            StreamEnded: it can never be opened.
        """

    def read(self) -> Image:
        """Return the next frame (BGR) as soon as there is one.

        Raises:
            NoFrame: it delivers no more frames, and must be opened again.
            StreamEnded: that was the last frame.
        """

    def close(self) -> None:
        """Release the camera."""


def make_grabber(source: CameraSource) -> Grabber:
    """Return the grabber for a source, without opening it."""
    if source.target.lower().startswith(ROS):
        from tangy_hw.drivers.camera_ros import RosPictures

        return RosPictures(source)
    return Folder(source) if source.kind == "folder" else Capture(source)


class Capture:
    """Grabs frames from sources that OpenCV reads: cameras, streams and video files.

    A capture that has failed or timed out never recovers, although it claims to be open, so it is
    replaced. OpenCV returns the last frame of a broken stream as if it were complete, with a
    smeared lower part.
    """

    def __init__(self, source: CameraSource) -> None:
        self.rate = source.rate
        self._source = source
        self._capture: Any = None
        self._held: Image | None = None
        self._first = True

    def open(self) -> None:
        """Open the source.

        Raises:
            NoFrame: a camera or stream cannot be opened.
            StreamEnded: a file is no video.
        """
        import cv2

        self.close()
        source, self._first, self._held = self._source, True, None
        if source.kind == "stream":
            patience = [
                cv2.CAP_PROP_OPEN_TIMEOUT_MSEC, int(OPEN_SECONDS * 1000),
                cv2.CAP_PROP_READ_TIMEOUT_MSEC, int(READ_SECONDS * 1000),
            ]  # fmt: skip
            self._capture = cv2.VideoCapture(source.target, cv2.CAP_FFMPEG, patience)
        elif source.kind == "file":
            # A file may be a playlist of other files and addresses, which must not be opened.
            os.environ["OPENCV_FFMPEG_CAPTURE_OPTIONS"] = "protocol_whitelist;file"
            self._capture = cv2.VideoCapture(source.target, cv2.CAP_FFMPEG)
        else:
            self._open_device(cv2)
        if not self._capture.isOpened():
            self.close()
            if source.kind == "file":
                raise StreamEnded("it is no video that can be read")
            raise NoFrame(_why_not_open(source))
        if source.kind == "file" and not self.rate:
            said = float(self._capture.get(cv2.CAP_PROP_FPS))
            self.rate = said if 0.1 <= said <= 240 else FILE_RATE

    def _open_device(self, cv2: Any) -> None:
        source = self._source
        if not Path(source.target).exists():
            raise NoFrame("there is no such camera")
        if not os.access(source.target, os.R_OK | os.W_OK):
            raise NoFrame("this user may not use it; join the group video")
        self._capture = cv2.VideoCapture(source.target, cv2.CAP_V4L2)
        # Few cameras manage this size uncompressed; only the newest frame is of use.
        self._capture.set(cv2.CAP_PROP_FOURCC, cv2.VideoWriter.fourcc(*"MJPG"))
        self._capture.set(cv2.CAP_PROP_FRAME_WIDTH, source.width)
        self._capture.set(cv2.CAP_PROP_FRAME_HEIGHT, source.height)
        self._capture.set(cv2.CAP_PROP_BUFFERSIZE, 1)

    def read(self) -> Image:
        """Return the next frame (BGR).

        Raises:
            NoFrame: no frame came in time, or the camera is unplugged.
            StreamEnded: a file is at its end.
        """
        image = self._read() if self._held is None else self._held
        self._held = None
        if self._source.kind == "stream" and _perhaps_half(image):
            self._held = self._read()  # if the stream goes on, the frame is complete
        return image

    def _read(self) -> Image:
        source = self._source
        if source.kind == "device" and not Path(source.target).exists():
            raise NoFrame("it is unplugged")  # read() may go on returning the last frame
        began = time.monotonic()
        done, image = self._capture.read()
        late = source.kind == "stream" and time.monotonic() - began > 0.9 * READ_SECONDS
        if done and image is not None and image.size and not late:
            self._first = False
            return image  # type: ignore[no-any-return]
        if source.kind == "file":
            raise StreamEnded(UNUSABLE if self._first else "")
        raise NoFrame("it stopped in the middle" if late else "it stopped sending")

    def close(self) -> None:
        """Close the source."""
        if self._capture is not None:
            self._capture.release()
            self._capture = None


class Folder:
    """A folder of images, or a single one; unreadable images are skipped."""

    def __init__(self, source: CameraSource) -> None:
        self.rate = source.rate
        self._source = source
        self._left: list[Path] = []
        self._given = 0

    def open(self) -> None:
        """Open the source.

        Raises:
            StreamEnded: the folder cannot be read.
        """
        self._given = 0
        try:
            self._left = pictures_in(Path(self._source.target))[::-1]
        except CameraError:
            raise StreamEnded("the folder cannot be read any more") from None

    def read(self) -> Image:
        """Return the next image (BGR).

        Raises:
            StreamEnded: no image is left.
        """
        while self._left:
            image = _read_picture(self._left.pop())
            if image is not None:
                self._given += 1
                return image
        raise StreamEnded("" if self._given else UNUSABLE)

    def close(self) -> None:
        """Close the source."""
        self._left.clear()


def _read_picture(path: Path) -> Image | None:
    import cv2
    import numpy as np

    os.environ.setdefault("OPENCV_IO_MAX_IMAGE_PIXELS", str(MOST_PIXELS))
    try:
        content = np.frombuffer(read_given(path, LARGEST_FILE), np.uint8)
        return cv2.imdecode(content, cv2.IMREAD_COLOR)  # type: ignore[return-value]
    except (TangyError, cv2.error):
        return None


def _perhaps_half(image: Image) -> bool:
    """Return whether the lowest rows are uniform: padding, black bars, or an empty scene."""
    import numpy as np

    lowest = image[-LOWEST:].reshape(-1, image.shape[2])
    return bool(np.all(lowest.max(axis=0) - lowest.min(axis=0) <= ALIKE))


def _why_not_open(source: CameraSource) -> str:
    if source.kind == "device":
        return "it cannot be opened: does another program use it?"
    return "nobody sends a stream there"
