"""Frames of a ROS robot: sensor_msgs/CompressedImage through a rosbridge server.

A source is ros://HOST:PORT/TOPIC, or ros2://HOST:PORT/TOPIC for ROS 2. It runs in the camera's
process with a connection of its own, so that images do not delay driving.
"""

from __future__ import annotations

import base64
import binascii
import json
import os
import time
from collections.abc import Mapping
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

from websockets.exceptions import WebSocketException
from websockets.sync.client import ClientConnection, connect

from tangy_hw.drivers.camera_grabber import MOST_PIXELS, OPEN_SECONDS, READ_SECONDS, NoFrame
from tangy_hw.drivers.camera_source import CameraSource

if TYPE_CHECKING:
    from tangy_hw.drivers.camera_look import Image

TYPES = {
    "ros": "sensor_msgs/CompressedImage",
    "ros2": "sensor_msgs/msg/CompressedImage",
}
PORT = 9090
LARGEST = 16 << 20  # bytes of a message
BETWEEN_MS = 60  # minimum between two frames


class RosPictures:
    """The newest frames of a topic."""

    rate = 0.0

    def __init__(self, source: CameraSource) -> None:
        """Prepare a source."""
        parts = urlsplit(source.target)
        self._type = TYPES[parts.scheme.lower()]
        host = f"[{parts.hostname}]" if ":" in str(parts.hostname) else parts.hostname
        self._server = f"ws://{host}:{parts.port or PORT}"
        self._topic = parts.path
        self._link: ClientConnection | None = None
        self._opened = ExitStack()

    def open(self) -> None:
        """Connect, and subscribe to the topic.

        Raises:
            NoFrame: the server does not answer.
        """
        self.close()
        asks = {
            "op": "subscribe", "topic": self._topic, "type": self._type,
            "throttle_rate": BETWEEN_MS, "queue_length": 1,
        }  # fmt: skip
        try:
            link = connect(self._server, open_timeout=OPEN_SECONDS, max_size=LARGEST)
            self._link = self._opened.enter_context(link)
            self._link.send(json.dumps(asks))
        except (OSError, WebSocketException):
            self.close()
            raise NoFrame("nobody answers there") from None

    def read(self) -> Image:
        """Return the newest frame (BGR) as soon as there is one.

        Raises:
            NoFrame: no picture of the topic came in time, or the connection broke.
        """
        until = time.monotonic() + READ_SECONDS
        while (text := self._newest(until - time.monotonic())) is not None:
            image = decoded(text, self._topic)
            if image is not None:
                return image
        raise NoFrame("it sends no pictures")

    def _newest(self, seconds: float) -> str | bytes | None:
        """Return the newest message; None after a timeout in s."""
        if self._link is None:
            raise NoFrame("it is not open")
        newest: str | bytes | None = None
        try:
            newest = self._link.recv(timeout=max(seconds, 0.0))
            while True:
                newest = self._link.recv(timeout=0)
        except TimeoutError:
            return newest
        except (OSError, WebSocketException):
            raise NoFrame("it stopped sending") from None

    def close(self) -> None:
        """Close the connection."""
        self._link = None
        self._opened.close()


def decoded(text: str | bytes, topic: str) -> Image | None:
    """Return the image (BGR) in a rosbridge message; None if it has none of that topic."""
    import cv2
    import numpy as np

    try:
        said: Any = json.loads(text)
        if said.get("op") != "publish" or said.get("topic") != topic:
            return None
        content = np.frombuffer(_bytes(said["msg"]), np.uint8)
        os.environ.setdefault("OPENCV_IO_MAX_IMAGE_PIXELS", str(MOST_PIXELS))
        return cv2.imdecode(content, cv2.IMREAD_COLOR)  # type: ignore[return-value]
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError, cv2.error):
        return None


def _bytes(message: Mapping[str, Any]) -> bytes:
    """Return the image data: base64, or a list of numbers if the bridge does not encode it."""
    data = message["data"]
    if isinstance(data, str):
        try:
            return base64.b64decode(data, validate=True)
        except binascii.Error as error:
            raise ValueError(str(error)) from None
    return bytes(data)
