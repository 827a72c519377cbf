"""The local microphone, through ALSA's arecord."""

from __future__ import annotations

import asyncio
import contextlib
import os
import re
import shutil
import subprocess
from pathlib import Path

from tangy_hw.audio.source import Chunks, Source, WholeSamples
from tangy_hw.audio.wav import RATE, SoundError
from tangy_profiles.reading import plain

RECORD = ("arecord", "-q", "-t", "raw", "-f", "S16_LE", "-r", str(RATE), "-c", "1")
PIECE = 2 * RATE // 20  # bytes, 50 ms
AGAIN_SECONDS = 1.5  # between two attempts to record from a missing microphone
LIST_SECONDS = 5.0  # timeout of listing the devices
DEVICES = Path("/dev/snd")
REASONS = {"No such file or directory": "there is none", "No such device": "it is unplugged",
           "Device or resource busy": "another program uses it"}  # fmt: skip
END_SECONDS = 2.0  # for arecord to exit after closing its output


class LocalMicrophone(Source):
    """A microphone recorded by arecord; if it is unplugged, recording waits for it."""

    def __init__(self, name: str, device: str = "", *, again: float = AGAIN_SECONDS) -> None:
        """Find the recorder.

        Args:
            name: name of the source, as given.
            device: ALSA's name of the microphone, as in `arecord -L`; "": the default.
            again: seconds until a missing microphone is tried again.

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
        """Record until the recorder exits, and store the reason."""
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
        assert sound is not None and messages is not None  # noqa: S101 - both are pipes
        whole = WholeSamples()
        try:
            while chunk := await sound.read(PIECE):
                yield whole.of(chunk)
            said = (await messages.read(4_000)).decode(errors="replace")
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(process.communicate(), END_SECONDS)
            self._why = _reason(said)
        finally:
            if process.returncode is None:
                with contextlib.suppress(ProcessLookupError):
                    process.kill()
            await process.communicate()  # wait() alone would block on the unread pipes


def list_microphones(program: str, devices: Path = DEVICES) -> list[str]:
    """Return the names of the sound cards that can record.

    Args:
        program: path of arecord.
        devices: folder of the system's sound devices.

    Raises:
        SoundError: arecord does not work, or this user may not use the sound cards.
    """
    if any(not os.access(device, os.R_OK | os.W_OK) for device in devices.glob("control*")):
        raise SoundError("this user may not use the sound cards; join the group audio.")
    try:
        listed = subprocess.run(  # noqa: S603 - arecord, found on the path
            [program, "-l"],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=LIST_SECONDS,
            start_new_session=True,
            env={**os.environ, "LC_ALL": "C"},
        ).stdout.decode(errors="replace")
    except (OSError, subprocess.SubprocessError):
        raise SoundError(
            "arecord is there, but does not answer; install alsa-utils anew."
        ) from None
    named = re.findall(r"^card \d+: [^\[]*\[([^\]]+)\]", listed, re.MULTILINE)
    return [plain(name) for name in dict.fromkeys(named)]


def _reason(said: str) -> str:
    """Return why arecord exited, from the last line of its messages."""
    last = plain((said.strip().splitlines() or [""])[-1]).replace("\N{REPLACEMENT CHARACTER}", " ")
    last = re.sub(r"^arecord: \w+:\d+: ", "", last.strip().rstrip("."))
    known = (why for words, why in REASONS.items() if words in last)
    return next(known, last[-120:] or "arecord ended")
