"""Speech identification (III-A-1): from sound to words, and from words to a behaviour.

The decoder runs in a process of its own (see speech_worker, which also documents how it is spoken
to); here it is started, asked, watched, and started again when it has died.
"""

from __future__ import annotations

import asyncio
import base64
import contextlib
import json
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import IO, Any

from tangy_profiles.errors import TangyError
from tangy_tui.learning.commands import Command, Phrasebook
from tangy_tui.learning.microphone import split
from tangy_tui.learning.wav import read_wav

WORKER = (sys.executable, "-P", "-m", "tangy_tui.learning.speech_worker")
START_SECONDS = 30.0  # for the worker to load its models: 0.4 s when nothing else runs
DECODE_SECONDS = 30.0  # for an utterance: 0.1 s when nothing else runs
END_SECONDS = 2.0
UNDERSTOOD = 0.35
"""The confidence below which what was heard is not taken for a command.

On the voices it was chosen on (tests/bench/speech.py), 97 % of the phrases lie above it, and less
than 1 % of other speech.
"""


class SpeechUnavailable(TangyError):
    """Nothing can be decoded now; one sentence that says why."""


@dataclass(frozen=True)
class Heard:
    """What was said: the words, how sure they are (0 to 1), and the length of the sound in s."""

    text: str
    confidence: float
    seconds: float


class Recogniser:
    """The speech decoder for the phrases of one phrasebook.

    `left_out` lists the words that cannot be heard, because the pronouncing dictionary does not
    have them; the phrases with them are understood only when they are typed.
    """

    def __init__(
        self, *, log: Path | None = None, notify: Callable[[str], None] | None = None
    ) -> None:
        """Prepare a recogniser; `start` starts it.

        Args:
            log: where the worker's messages go; nowhere if not given.
            notify: is called with one sentence when the worker dies.
        """
        self.left_out: tuple[str, ...] = ()
        self._log = log
        self._notify = notify
        self._phrases: tuple[str, ...] = ()
        self._process: asyncio.subprocess.Process | None = None
        self._watch: asyncio.Task[None] | None = None
        self._turn = asyncio.Lock()
        self._asked = 0

    @property
    def pid(self) -> int | None:
        """The process that decodes, if one runs."""
        alive = self._process is not None and self._process.returncode is None
        return self._process.pid if alive and self._process else None

    async def start(self, phrases: Sequence[str]) -> None:
        """Start the worker and have it build its language model of the phrases.

        Raises:
            SpeechUnavailable: the worker cannot run here, or no phrase can be pronounced.
        """
        async with self._turn:
            await self._end()
            self._phrases = tuple(phrases)
            await self._begin()

    async def decode(self, pcm: bytes) -> Heard:
        """Decode one utterance (16 kHz mono s16le); a worker that has died is started again.

        Raises:
            SpeechUnavailable: the worker died over it, or cannot be started again.
        """
        async with self._turn:
            if self.pid is None:
                if not self._phrases:
                    raise SpeechUnavailable("Speech was not started yet.")
                await self._begin()
            answer = await self._ask({"pcm": base64.b64encode(pcm).decode()}, DECODE_SECONDS)
            return Heard(str(answer["text"]), float(answer["confidence"]), float(answer["seconds"]))

    async def close(self) -> None:
        """End the worker, whatever it is doing."""
        self._phrases = ()
        if self._watch is not None:
            self._watch.cancel()
        if self._turn.locked() and self._process is not None:
            _kill(self._process)
        async with self._turn:
            await self._end()

    async def _begin(self) -> None:
        log: int | IO[bytes] = asyncio.subprocess.DEVNULL
        try:
            if self._log is not None:
                log = self._log.open("ab")
            self._process = await asyncio.create_subprocess_exec(
                *WORKER,
                stdin=asyncio.subprocess.PIPE,
                stdout=asyncio.subprocess.PIPE,
                stderr=log,
                start_new_session=True,  # ctrl+c in the terminal is not meant for it
            )
        except OSError as error:
            raise SpeechUnavailable(
                f"The speech worker cannot be started ({error.strerror})."
            ) from None
        finally:
            if not isinstance(log, int):
                log.close()
        self._watch = asyncio.create_task(self._see_it_end(self._process))
        try:
            answer = await self._ask({"phrases": list(self._phrases)}, START_SECONDS)
        except SpeechUnavailable:
            await self._end()
            raise
        self.left_out = tuple(answer["left_out"])

    async def _see_it_end(self, process: asyncio.subprocess.Process) -> None:
        await process.wait()
        if self._notify is not None:
            self._notify(_epitaph(process))

    async def _end(self) -> None:
        process, self._process = self._process, None
        if self._watch is not None:
            self._watch.cancel()
        if process is None or process.returncode is not None:
            return
        if process.stdin is not None:
            process.stdin.close()
        await _let_end(process)

    async def _ask(self, request: dict[str, Any], seconds: float) -> dict[str, Any]:
        """Send a request and return its answer, passing over answers nobody waits for any more."""
        process = self._process
        if process is None or process.stdin is None or process.stdout is None:
            raise SpeechUnavailable("The speech worker does not run.")
        self._asked += 1
        line = json.dumps({"id": self._asked, **request}).encode() + b"\n"
        try:
            async with asyncio.timeout(seconds):
                process.stdin.write(line)
                await process.stdin.drain()
                answer = await self._answer(process.stdout, self._asked)
        except TimeoutError:
            _kill(process)
            await self._end()
            raise SpeechUnavailable(
                f"The speech worker did not answer in {seconds:g} s and was ended; "
                "it is started again at the next use."
            ) from None
        except (OSError, ValueError):
            answer = None
        if answer is None:
            await _let_end(process)
            raise SpeechUnavailable(_epitaph(process))
        if "error" in answer:
            raise SpeechUnavailable(str(answer["error"]))
        return answer

    async def _answer(self, answers: asyncio.StreamReader, id: int) -> dict[str, Any] | None:
        while line := await answers.readline():
            answer: dict[str, Any] = json.loads(line)
            if answer.get("id") == id:
                return answer
        return None


async def _let_end(process: asyncio.subprocess.Process) -> None:
    """Wait for a process that is about to end; kill it if it does not.

    Not before: killing a process that has just ended takes its status away from asyncio, which
    then complains about it on the terminal.
    """
    try:
        await asyncio.wait_for(process.wait(), END_SECONDS)
    except TimeoutError:
        _kill(process)
        await process.wait()


def _kill(process: asyncio.subprocess.Process) -> None:
    with contextlib.suppress(ProcessLookupError):
        process.kill()


def _epitaph(process: asyncio.subprocess.Process) -> str:
    code = process.returncode or 0
    how = f"signal {-code}" if code < 0 else f"status {code}"
    return f"The speech worker ended unasked ({how}); it is started again at the next use."


def understand(heard: Heard, phrasebook: Phrasebook) -> Command | None:
    """Match decoded words to a behaviour; the confidence is that of the sound and of the match.

    None where the two together are less than `UNDERSTOOD`.
    """
    command = phrasebook.understand(heard.text)
    if command is None:
        return None
    confidence = round(command.confidence * heard.confidence, 3)
    return replace(command, confidence=confidence) if confidence >= UNDERSTOOD else None


def listen(files: Sequence[Path], phrasebook: Phrasebook) -> list[dict[str, Any]]:
    """Decode WAV files: one row for each utterance in them, in order.

    A row has file, heard, behaviour (None if nothing was understood), arguments, confidence. A
    file without any speech gives one row, with nothing heard.

    Raises:
        SoundError: a file is missing or cannot be read as sound; it is named.
        SpeechUnavailable: the worker cannot run here.
    """
    utterances = [(file, pcm) for file in files for pcm in split(read_wav(file)) or [b""]]
    return asyncio.run(_listen(utterances, phrasebook)) if utterances else []


async def _listen(
    utterances: Sequence[tuple[Path, bytes]], phrasebook: Phrasebook
) -> list[dict[str, Any]]:
    recogniser = Recogniser()
    try:
        await recogniser.start(phrasebook.spoken())
        return [_row(file, await recogniser.decode(pcm), phrasebook) for file, pcm in utterances]
    finally:
        await recogniser.close()


def _row(file: Path, heard: Heard, phrasebook: Phrasebook) -> dict[str, Any]:
    command = understand(heard, phrasebook)
    return {
        "file": os.fspath(file),
        "heard": heard.text,
        "behaviour": command.behaviour if command else None,
        "arguments": dict(command.arguments) if command else {},
        "confidence": command.confidence if command else heard.confidence,
    }
