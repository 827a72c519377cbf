"""Cameras over ROS: pictures of a rosbridge server, whatever else comes over the link."""

from __future__ import annotations

import asyncio
import base64
import json
from collections.abc import Mapping
from typing import Any

import cv2
import numpy as np
import pytest

from tangy_hw.drivers.camera_grabber import NoFrame, make_grabber
from tangy_hw.drivers.camera_ros import RosPictures, decoded
from tangy_hw.drivers.camera_source import CameraError, find_camera
from tangy_sim.servers.rosbridge_server import RosbridgeServer
from tests.hw.ros_links import soon

TOPIC = "/camera/image_raw/compressed"


def picture(brightness: int, *, listed: bool = False) -> dict[str, Any]:
    """Return a grey picture of 64 x 48 as sensor_msgs/CompressedImage."""
    _, jpeg = cv2.imencode(".jpg", np.full((48, 64, 3), brightness, np.uint8))
    data: Any = list(jpeg.tobytes()) if listed else base64.b64encode(jpeg.tobytes()).decode()
    return {"header": {"frame_id": "eye"}, "format": "bgr8; jpeg compressed bgr8", "data": data}


def published(message: Mapping[str, Any], topic: str = TOPIC) -> str:
    return json.dumps({"op": "publish", "topic": topic, "msg": message})


class TestPictures:
    @pytest.mark.parametrize("scheme", ["ros", "ros2"])
    async def test_the_camera_returns_the_newest_picture_of_its_topic(self, scheme: str) -> None:
        server = RosbridgeServer()
        await server.start()
        grabber = make_grabber(find_camera(f"{scheme}://{server.host}:{server.port}{TOPIC}"))
        await asyncio.to_thread(grabber.open)
        await soon(server.subscribed(TOPIC))
        for brightness in (40, 200):
            server.publish(TOPIC, "sensor_msgs/CompressedImage", picture(brightness))
            image = await soon(asyncio.to_thread(grabber.read))
            assert image.shape == (48, 64, 3) and abs(int(image.mean()) - brightness) < 4
            await asyncio.sleep(0.07)  # pictures are requested no more often
        await server.close()
        with pytest.raises(NoFrame):
            await asyncio.to_thread(grabber.read)
        grabber.close()

    def test_a_camera_without_a_server_raises_no_frame(self) -> None:
        grabber = RosPictures(find_camera(f"ros://127.0.0.1:1{TOPIC}"))
        with pytest.raises(NoFrame):
            grabber.open()

    def test_bytes_come_as_base64_or_as_numbers(self) -> None:
        for listed in (False, True):
            image = decoded(published(picture(90, listed=listed)), TOPIC)
            assert image is not None and image.shape == (48, 64, 3)

    @pytest.mark.parametrize(
        "text",
        [
            "",
            "[]",
            "[" * 5000,
            published(picture(9), "/other"),
            published({}),
            published({"data": "no base64!"}),
            published({"data": [300, -1]}),
            published({"data": ""}),
            published({"data": base64.b64encode(b"no picture").decode()}),
            b"\xff\x00",
        ],
    )
    def test_messages_that_hold_no_picture_are_ignored(self, text: str | bytes) -> None:
        assert decoded(text, TOPIC) is None

    @pytest.mark.parametrize("name", ["ros://robot:9090", "ros2://robot:9090/", "ros:///topic"])
    def test_a_source_without_a_topic_or_a_host_is_refused(self, name: str) -> None:
        with pytest.raises(CameraError, match="no address"):
            find_camera(name)
