"""The robot's voice on a loudspeaker of this machine: espeak-ng and a player."""

from __future__ import annotations

import asyncio
import logging
import shutil
from collections.abc import Callable
from pathlib import Path

from tangy_hw.audio.player import PlayerError, SoundPlayer, examine_output, open_player
from tangy_hw.audio.synthesis import USUAL, Synthesiser
from tangy_hw.audio.voice import SpeechVoice
from tangy_hw.device_protocols import DeviceError
from tangy_profiles.cards import Deck
from tangy_profiles.health import ERROR, OK, WARN, Reading
from tangy_profiles.voice import VoicePreference

_LOG = logging.getLogger(__name__)


class SpokenVoice:
    """Speaks one text after the other; text that cannot be heard raises an error for the caller.

    A voice that has failed stays so until it is closed and started again: a player that lost its
    sound card is not retried.
    """

    def __init__(
        self,
        *,
        name: str = "voice",
        sink: str = "auto",
        preference: VoicePreference = USUAL,
        deck: Deck | None = None,
        folder: Path | None = None,
        player: SoundPlayer | None = None,
        which: Callable[[str], str | None] = shutil.which,
        on_begin: Callable[[], None] | None = None,
        on_end: Callable[[], None] | None = None,
    ) -> None:
        """Prepare a voice; `start` looks for the programs.

        Args:
            name: its name in the robot's profile.
            sink: player, as `open_player` takes it: `auto`, a program, or `null`.
            preference: speed and voice.
            deck: deck whose calls are pronounced as a caller says them.
            folder: cache for synthesised speech; None: the user's cache folder.
            player: player to use instead of a sink.
            which: finds a program on the path.
            on_begin: called before sound starts (a microphone is muted).
            on_end: called after sound has ended (a microphone is opened).
        """
        self.name = name
        self._sink, self._preference, self._deck = sink, preference, deck
        self._folder, self._player, self._which = folder, player, which
        self._on_begin, self._on_end = on_begin, on_end
        self._voice: SpeechVoice | None = None
        self._trying: asyncio.Task[tuple[str, str]] | None = None
        self._dead = f"{name} was not started."
        self._failed = ""
        self._hushes = 0

    @property
    def why(self) -> str:
        """Its problem, in one sentence; "" if none is known."""
        trying = f"{self.name} is being tried." if self._trying is not None else ""
        return self._dead or self._failed or trying

    async def start(self) -> None:
        """Find a synthesiser and a player, and test them by playing a moment of silence.

        It returns at once; the reading shows the result of the test.
        """
        if self._voice is not None:
            return
        self._dead = self._failed = ""
        synthesiser = Synthesiser(self._folder, which=self._which)
        player = self._player
        try:
            player = player or open_player(self._sink, self._which)
        except PlayerError as error:
            self._dead = f"{self.name}: {error}"
        if synthesiser.reason:
            self._dead = f"{self.name}: {synthesiser.reason}"
        self._voice = SpeechVoice(
            synthesiser,
            player,
            deck=self._deck,
            usual=self._preference,
            on_begin=self._on_begin,
            on_end=self._on_end,
            tell=self._hear,
        )
        if self._player is None and self._sink == "auto" and not self._dead:
            self._trying = asyncio.create_task(asyncio.to_thread(examine_output, self._which))
            self._trying.add_done_callback(self._tried)

    async def close(self) -> None:
        """Cut the current speech, and stay silent until the next start."""
        voice, self._voice = self._voice, None
        self._dead = f"{self.name} does not run."
        self._hushes += 1
        if self._trying is not None:
            self._trying.remove_done_callback(self._tried)
            self._trying.cancel()
            self._trying = None
        if voice is not None:
            await voice.close()

    async def say(self, text: str) -> None:
        """Speak, and wait until the speech has ended or `hush` has cut it.

        Cancelling the wait cuts the speech.

        Raises:
            DeviceError: it cannot be heard.
        """
        _LOG.info("says %d characters by espeak-ng", len(text))
        await self._heard(lambda voice: voice.say(text))

    async def play(self, sound: Path) -> None:
        """Play a WAV file, and wait until it has ended or `hush` has cut it.

        Cancelling the wait cuts the sound.

        Raises:
            DeviceError: it cannot be heard.
        """
        _LOG.info("plays a sound")
        await self._heard(lambda voice: voice.play(sound))

    async def _heard(self, begin: Callable[[SpeechVoice], asyncio.Future[bool]]) -> None:
        voice, hushes = self._voice, self._hushes
        if voice is None or self._dead:
            raise DeviceError(self._dead)
        self._failed = ""
        try:
            heard = await begin(voice)
        except asyncio.CancelledError:
            await self.hush()
            raise
        if heard or self._hushes > hushes:
            return
        self._failed = self._failed or f"{self.name}: it was not heard."
        if voice.silent:
            self._dead = self._failed
        raise DeviceError(self._failed)

    async def hush(self) -> None:
        """Stop speaking now."""
        self._hushes += 1
        if self._voice is not None:
            self._voice.hush()

    def reading(self) -> Reading:
        """Return its state: ERROR if nothing can be heard, WARN if the last text was not.

        It is also WARN during the test.
        """
        return Reading(self.name, 0.0, ERROR if self._dead else WARN if self.why else OK)

    def _hear(self, sentence: str) -> None:
        self._failed = f"{self.name}: {sentence}"

    def _tried(self, trying: asyncio.Task[tuple[str, str]]) -> None:
        self._trying = None
        if not trying.cancelled() and trying.exception() is None and trying.result()[1]:
            self._dead = f"{self.name}: {trying.result()[1]}."
