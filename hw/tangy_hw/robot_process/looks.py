"""Requests to the robot's cameras: a card, a face, a picture, their state."""

from __future__ import annotations

import base64
import time
from dataclasses import astuple
from typing import Any

from tangy_hw.device_protocols import DeviceError
from tangy_hw.perception.card_and_face_perception import (
    MOST_PICTURES,
    CardAndFacePerception,
    CardSeen,
)
from tangy_hw.robot_process.controller import LiveRobot
from tangy_hw.robot_process.heartbeat import aged
from tangy_hw.robot_process.protocol import number_of, wins_of
from tangy_profiles.worker_lines import Asked

LARGEST_PICTURE = 400  # columns or rows: terminals show no more, and heartbeats queue behind it


class CameraRequests:
    """Handles requests to the robot's cameras, and keeps the last card reading.

    Each raises DeviceError if the robot has no cameras.
    """

    def __init__(self, robot: LiveRobot) -> None:
        """Set the robot."""
        self._robot = robot
        self._looked: tuple[CardSeen, float] | None = None  # last reading of a card, and its time
        self._read: tuple[CardSeen, float] | None = None  # last reading that identified a card

    async def card(self, asked: Asked) -> dict[str, Any]:
        """Read the card of the person in front."""
        senses = self._senses
        await self._robot.look_at("card")
        if asked.get("after"):
            await self._robot.passing.sleep(number_of(asked, "after"))
        seen = await senses.read_card(
            set(asked["called"]),
            int(asked.get("pictures", MOST_PICTURES)),
            identify=bool(asked.get("identify")),
            wins=wins_of(asked),
        )
        self._looked = seen, time.monotonic()
        if seen.card is not None:
            self._read = self._looked
        return seen.to_json()

    async def face(self, _: Asked) -> dict[str, Any]:
        """Identify the person in front."""
        senses = self._senses
        await self._robot.look_at("face")
        vote = await senses.who()
        return {"person": vote.person, "votes": vote.votes, "frames": vote.frames}

    async def picture(self, asked: Asked) -> dict[str, Any]:
        """Return a camera's frame, scaled to fit; empty if no newer frame comes."""
        width, height = (min(LARGEST_PICTURE, max(1, int(one))) for one in asked["fit"])
        frame = await self._senses.sensors.picture(
            str(asked["device"]), (width, height), after=int(asked.get("after", -1))
        )
        if frame is None:
            return {}
        pixels = base64.b64encode(frame.pixels).decode()
        return {"seq": frame.seq, "size": [frame.width, frame.height], "pixels": pixels}

    async def sights(self, _: Asked) -> dict[str, Any]:
        """Return the state of the cameras, and the last card reading."""
        sensors = self._senses.sensors
        return {
            "sights": {
                name: [sensors.source(name), *astuple(sensors.sight(name))]
                for name in sensors.cameras
            },
            "looked": aged(self._looked),
            "read": aged(self._read),
        }

    @property
    def _senses(self) -> CardAndFacePerception:
        if self._robot.senses is None:
            raise DeviceError("The robot has no cameras.")
        return self._robot.senses
