"""The local microphone, through ALSA's recorder."""

from __future__ import annotations

import asyncio
import contextlib
import shutil

from tangy_hw.sound.source import Chunks, Source, WholeSamples
from tangy_hw.sound.wav import RATE, SoundError
from tangy_profiles.reading import plain

RECORD = ("arecord", "-q", "-t", "raw", "-f", "S16_LE", "-r", str(RATE), "-c", "1")
PIECE = 2 * RATE // 20  # bytes, 50 ms
AGAIN_SECONDS = 1.5  # between two tries to record from a microphone that has gone
END_SECONDS = 2.0  # for arecord to end by itself when it has closed its output


class LocalMicrophone(Source):
    """What arecord hears; one that is unplugged is waited for."""

    def __init__(self, name: str, device: str = "", *, again: float = AGAIN_SECONDS) -> None:
        """Find the recorder.

        Args:
            name: as it was given.
            device: ALSA's name of the microphone, as `arecord -L` lists them; empty: the default.
            again: seconds until a microphone that has gone is tried again.

        Raises:
            SoundError: arecord is not installed.
        """
        super().__init__(name, live=True)
        self._command = (*RECORD, "-D", device) if device else RECORD
        self._again = again
        self._why = ""
        if shutil.which(RECORD[0]) is None:
            raise SoundError(
                "arecord cannot be started: install alsa-utils, or give a WAV file or - instead."
            )

    async def _sound(self) -> Chunks:
        told = ""
        while True:
            async with contextlib.aclosing(self._recorded()) as chunks:
                async for chunk in chunks:
                    if told:
                        self.tell("The microphone is back.")
                        told = ""
                    yield chunk
            if self._why != told:
                told = self._why
                self.tell(f"The microphone stopped: {told}. It is tried again until it is back.")
            await asyncio.sleep(self._again)

    async def _recorded(self) -> Chunks:
        """Record until the recorder ends, and keep why it did."""
        try:
            process = await asyncio.create_subprocess_exec(
                *self._command,
                stdin=asyncio.subprocess.DEVNULL,
                stdout=asyncio.subprocess.PIPE,
                stderr=asyncio.subprocess.PIPE,
                start_new_session=True,
            )
        except OSError as error:
            self._why = f"arecord cannot be started ({error.strerror})"
            return
        sound, messages = process.stdout, process.stderr
        assert sound is not None and messages is not None  # noqa: S101 - they were asked for
        whole = WholeSamples()
        try:
            while chunk := await sound.read(PIECE):
                yield whole.of(chunk)
            said = plain((await messages.read(2_000)).decode(errors="replace").strip())
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(process.communicate(), END_SECONDS)
            said = said.replace("\N{REPLACEMENT CHARACTER}", " ").strip().rstrip(".")
            self._why = said[-120:] or "arecord ended"
        finally:
            if process.returncode is None:
                with contextlib.suppress(ProcessLookupError):
                    process.kill()
            await process.communicate()  # wait() alone would wait for what nobody reads any more
