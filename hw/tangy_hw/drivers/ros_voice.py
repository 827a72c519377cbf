"""A voice through ROS: one std_msgs/String topic takes text, another reports spoken text."""

from __future__ import annotations

import asyncio
import json
import logging
from contextlib import suppress
from itertools import count
from pathlib import Path

from tangy_hw.device_protocols import DeviceError
from tangy_hw.drivers.latest_value import awaited
from tangy_hw.drivers.ros_messages import Message
from tangy_hw.drivers.ros_status import RosDiagnostics, state_told
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_profiles.health import ERROR, STALE, DeviceState, Reading
from tangy_profiles.reading import plain
from tangy_profiles.wav_length import wav_seconds

_LOG = logging.getLogger(__name__)

PATIENCE_SECONDS = 5.0  # beyond the expected duration, until the voice counts as dead
CHARACTER_SECONDS = 0.15  # per character: twice that of slow speech


class RosVoice:
    """The robot's own voice; it acknowledges each text that it has spoken.

    It acknowledges by the text itself. With `with_id`, texts are sent as JSON, {"id": 7, "text":
    ...}, and acknowledged by the id, alone or in JSON: for robots that normalise text. A topic for
    sounds takes the path of a WAV file, and acknowledges it in the same way.
    """

    def __init__(
        self,
        bridge: Rosbridge,
        *,
        say: str = "/voice/say",
        said: str = "/voice/said",
        hush: str = "/voice/hush",
        play: str = "",
        with_id: bool = False,
        diagnostics: RosDiagnostics | None = None,
    ) -> None:
        """Set its topics.

        Args:
            bridge: the link to the robot.
            say: topic for text to speak.
            said: topic that reports the end of each text.
            hush: topic for std_msgs/Empty, which silences the voice.
            play: topic for the path of a WAV file to play; "": it plays none.
            with_id: whether texts are sent with an id.
            diagnostics: diagnostics of the robot, if it publishes any.
        """
        self.name = "voice"
        self._bridge, self._diagnostics = bridge, diagnostics
        self._say, self._said, self._hush, self._play = say, said, hush, play
        self._with_id = with_id
        self._numbers = count(1)
        self._waiting: dict[asyncio.Future[None], tuple[str, float]] = {}
        self._dead = self._begun = False

    async def start(self) -> None:
        """Subscribe to spoken texts; a voice that counts as dead is tried again."""
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
        """Silence the voice, and unsubscribe."""
        await self.hush()
        self._begun = False
        self._bridge.unsubscribe(self._said, self._hear)

    def reading(self) -> Reading:
        """Return its state: ERROR from an unacknowledged text until the next acknowledged one.

        A voice reports its own state only through diagnostics: its age is that of its status there,
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
        """Speak, and wait until the voice has spoken, or until `hush`.

        Raises:
            DeviceError: there is no link, or no acknowledgement.
        """
        text = " ".join(text.split())
        if text:
            _LOG.info("says %d characters on %s", len(text), self._say)
            await self._acknowledged(self._say, text, CHARACTER_SECONDS * len(text))

    async def play(self, sound: Path) -> None:
        """Play a WAV file, and wait until it has ended, or until `hush`.

        Raises:
            DeviceError: there is no link, no topic for sounds, or no acknowledgement.
        """
        if not self._play:
            raise DeviceError(f"{self.name} plays no sounds: name its topic in 'play'.")
        _LOG.info("plays a sound on %s", self._play)
        await self._acknowledged(self._play, str(sound), wav_seconds(sound))

    async def _acknowledged(self, topic: str, text: str, seconds: float) -> None:
        """Send a text with an expected duration in s, and wait for its acknowledgement."""
        key = str(next(self._numbers)) if self._with_id else text
        data = json.dumps({"id": int(key), "text": text}) if self._with_id else text
        self._bridge.publish(topic, {"data": data})
        over: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        takes = PATIENCE_SECONDS + seconds + sum(before for _, before in self._waiting.values())
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
        """Silence the voice now; the current text counts as spoken."""
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
