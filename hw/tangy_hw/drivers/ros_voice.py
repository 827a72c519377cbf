"""A voice behind ROS: text to say on one std_msgs/String, spoken text on another."""

from __future__ import annotations

import asyncio
import json
import logging
from contextlib import suppress
from itertools import count
from pathlib import Path

from tangy_hw.device_protocols import DeviceError
from tangy_hw.drivers.ros_messages import Message
from tangy_hw.drivers.ros_newest import awaited
from tangy_hw.drivers.ros_status import RosDiagnostics, state_told
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_profiles.health import ERROR, STALE, DeviceState, Reading
from tangy_profiles.reading import plain
from tangy_profiles.wav_length import wav_seconds

_LOG = logging.getLogger(__name__)

PATIENCE_SECONDS = 5.0  # beyond what a sentence takes, until the voice is taken to be dead
CHARACTER_SECONDS = 0.15  # twice what slow speech takes


class RosVoice:
    """The robot's own voice; each sentence is acknowledged when it was said.

    It is acknowledged by its own text. With `with_id` it is sent as JSON, {"id": 7, "text": ...},
    and acknowledged by the id, alone or as JSON: for robots that normalise what they are told.
    With a topic for sounds it takes the path of a WAV file, and acknowledges that in the same way.
    """

    def __init__(
        self,
        bridge: Rosbridge,
        *,
        name: str = "voice",
        say: str = "/voice/say",
        said: str = "/voice/said",
        hush: str = "/voice/hush",
        play: str = "",
        with_id: bool = False,
        patience: float = PATIENCE_SECONDS,
        diagnostics: RosDiagnostics | None = None,
    ) -> None:
        """Name its topics.

        Args:
            bridge: the link to the robot.
            name: of the device, as in the profile of the robot.
            say: the topic that takes the text to speak.
            said: the topic that reports the end of each text.
            hush: takes std_msgs/Empty, upon which it is quiet.
            play: the topic that takes the path of a WAV file to play ("": it plays none).
            with_id: whether sentences are sent with an id.
            patience: s beyond what a sentence takes, until the voice is taken to be dead.
            diagnostics: what its server says of its devices, if it does.
        """
        self.name = name
        self._bridge, self._diagnostics = bridge, diagnostics
        self._say, self._said, self._hush, self._play = say, said, hush, play
        self._with_id, self._patience = with_id, patience
        self._numbers = count(1)
        self._waiting: dict[asyncio.Future[None], tuple[str, float]] = {}
        self._dead = self._begun = False

    async def start(self) -> None:
        """Subscribe to spoken texts; a voice considered dead is tried again."""
        await self._bridge.start()
        self._dead = False
        if not self._begun:
            self._begun = True
            self._bridge.advertise(self._say, "std_msgs/String")
            self._bridge.advertise(self._hush, "std_msgs/Empty")
            if self._play:
                self._bridge.advertise(self._play, "std_msgs/String")
            self._bridge.subscribe(self._said, "std_msgs/String", self._hear)

    async def close(self) -> None:
        """Be quiet, and end."""
        await self.hush()
        self._begun = False
        self._bridge.unsubscribe(self._said, self._hear)

    def reading(self) -> Reading:
        """Return its state: an error from a sentence that was not said until one that is.

        A voice says nothing of itself unless its diagnosis comes: its age is that of the diagnosis,
        or else that of the link.
        """
        link = self._bridge.reading()
        age = None if self._diagnostics is None else self._diagnostics.age(self.name)
        state: DeviceState
        if self._dead:
            state = ERROR
        else:
            state = STALE if link.state == STALE else state_told(self._diagnostics, self.name)
        return Reading(self.name, link.age if age is None else age, state)

    async def say(self, text: str) -> None:
        """Say something, and wait until it was said, or until `hush`.

        Raises:
            DeviceError: there is no link, or nobody says it.
        """
        text = " ".join(text.split())
        if text:
            _LOG.info("says %d characters on %s", len(text), self._say)
            await self._acknowledged(self._say, text, CHARACTER_SECONDS * len(text))

    async def play(self, sound: Path) -> None:
        """Play a WAV file, and wait until it was played, or until `hush`.

        Raises:
            DeviceError: there is no link, it plays no sounds, or nobody plays it.
        """
        if not self._play:
            raise DeviceError(f"{self.name} plays no sounds: name its topic in 'play'.")
        _LOG.info("plays a sound on %s", self._play)
        await self._acknowledged(self._play, str(sound), wav_seconds(sound))

    async def _acknowledged(self, topic: str, text: str, seconds: float) -> None:
        """Send a text, and wait for its end, which may take so many s."""
        key = str(next(self._numbers)) if self._with_id else text
        data = json.dumps({"id": int(key), "text": text}) if self._with_id else text
        self._bridge.publish(topic, {"data": data})
        over: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        takes = self._patience + seconds + sum(before for _, before in self._waiting.values())
        self._waiting[over] = key, seconds
        clock = self._bridge.clock
        try:
            said = await awaited(over, clock() + takes, clock, lambda: self._bridge.connected)
        finally:
            self._waiting.pop(over, None)
        if not said:
            self._dead = self._bridge.connected
            raise DeviceError(plain(f"{self.name} did not say {text[:60]!r}."))

    async def hush(self) -> None:
        """Be quiet now; the current text counts as spoken."""
        for over in list(self._waiting):
            if not over.done():
                over.set_result(None)
        with suppress(DeviceError):
            self._bridge.publish(self._hush, {}, urgent=True)

    def _hear(self, message: Message) -> None:
        data = message["data"]
        said = {" ".join(str(data).split())}
        with suppress(ValueError, RecursionError):
            body = json.loads(data)
            if isinstance(body, dict):
                said |= {str(body[key]) for key in ("id", "text") if key in body}
        for over, (key, _) in self._waiting.items():
            if key in said and not over.done():
                self._dead = False
                over.set_result(None)
                return
