"""The recogniser, the program's side of the speech worker (III-A-1): sound in, evidence out.

The decoder runs in a worker process (see `worker` for the protocol). The recogniser starts it,
sends requests, monitors it, and restarts it with the sound so far if it has died.
"""

from __future__ import annotations

import asyncio
import base64
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from tangy_hw.worker_process import WorkerError, WorkerProcess, cpu_seconds
from tangy_profiles.codec import decode, encode
from tangy_profiles.errors import TangyError
from tangy_tui.speech.evidence import LONGEST, RATE, AcousticEvidence, DecoderVocabulary, Expecting

WORKER = (sys.executable, "-P", "-m", "tangy_tui.speech.worker")
START_SECONDS = 30.0  # timeout for loading the models: 0.8 s on an idle machine
VOICE_SECONDS = 120.0  # timeout of a voice: 4 s on an idle machine
DECODE_SECONDS = 30.0  # timeout of an utterance: 0.2 s on an idle machine
STALLED_SECONDS = 2.0  # without CPU time, after which a decoding worker counts as hung
LOOK_SECONDS = 0.1
END_SECONDS = 2.0
BEHIND = 5.0  # s of sound in transit to the worker at most
ATTEMPTS = 2  # at one utterance
LONGEST_ANSWER = 1 << 20  # bytes; a recording may have thousands of utterances


class SpeechUnavailable(TangyError):
    """Nothing can be decoded now; one sentence that says why."""


class _WorkerDied(Exception):
    """The worker ended before it answered; its text says how, in a few words."""

    def __init__(self, how: str) -> None:
        super().__init__(f"unasked ({how})")


class Recogniser:
    """The decoder with its vocabulary, for one utterance at a time.

    `left_out` lists the words that cannot be recognised, because they have no pronunciation;
    phrases with them can only be typed.
    """

    def __init__(
        self, *, log: Path | None = None, notify: Callable[[str], None] | None = None
    ) -> None:
        """Prepare a recogniser; call `start` to start it.

        Args:
            log: the file for the worker's messages; None for nowhere.
            notify: called with one sentence when the worker dies.
        """
        self.left_out: tuple[str, ...] = ()
        self.partial: Callable[[str], None] = lambda words: None
        """Called with the partial words of the current utterance."""
        self.speaking: Callable[[], None] = lambda: None
        """Called when the beginning of an utterance was detected."""
        self._log = log
        self._notify = notify
        self._wanted: DecoderVocabulary | None = None
        self._worker: WorkerProcess | None = None
        self._hearing = 0  # the id of the current utterance
        self._turn = asyncio.Lock()
        self._closing = False
        self.said = b""
        """The sound of the last utterance."""
        self.left = b""
        """The sound received after its detected end."""

    @property
    def pid(self) -> int | None:
        """The id of the worker process, or None."""
        return None if self._worker is None else self._worker.pid

    async def start(self, wanted: DecoderVocabulary) -> None:
        """Start the worker, or change its vocabulary.

        Raises:
            SpeechUnavailable: the worker cannot run here, or no phrase has a pronunciation.
        """
        async with self._turn:
            self._wanted, self._closing = wanted, False
            try:
                if self.pid is None:
                    await self._begin()
                else:
                    await self._tell_what()
            except _WorkerDied as how:
                raise SpeechUnavailable(f"The speech worker ended {how}.") from None

    async def decode(self, pcm: bytes, expecting: Expecting = "commands") -> AcousticEvidence:
        """Decode one whole utterance (16 kHz mono s16le, at most 15 s).

        Raises:
            SpeechUnavailable: the worker died twice, or cannot be restarted.
        """
        whole: asyncio.Queue[bytes] = asyncio.Queue()
        for chunk in (pcm[: 2 * RATE * LONGEST], b""):
            whole.put_nowait(chunk)
        return await self.hear(whole, expecting)

    async def hear(
        self,
        sound: asyncio.Queue[bytes],
        expecting: Expecting = "commands",
        *,
        endpoint: bool = False,
    ) -> AcousticEvidence:
        """Recognise one utterance as it is spoken; an empty chunk ends it.

        If the worker dies, a new one gets all sound so far, and continues. Only the first 15 s are
        decoded.

        Args:
            sound: chunks of 16 kHz mono s16le.
            expecting: commands or answers.
            endpoint: detect its beginning and end; the sound after it is in `left`.

        Raises:
            SpeechUnavailable: the worker died twice, or cannot be restarted.
        """
        async with self._turn:
            said: list[bytes] = []
            for attempt in range(1, ATTEMPTS + 1):
                try:
                    return await self._hear(sound, said, expecting, endpoint)
                except _WorkerDied as how:
                    if attempt == ATTEMPTS:
                        raise SpeechUnavailable(
                            f"The speech worker ended twice over one utterance, {how}."
                        ) from None
            raise AssertionError("not reached")

    async def pieces(self, pcm: bytes) -> list[bytes]:
        """Return the utterances in a recording, split at the pauses.

        Raises:
            SpeechUnavailable: as for `hear`.
        """
        async with self._turn:
            try:
                await self._ready()
                whole = {"pieces": base64.b64encode(pcm).decode()}
                answer = await self._ask(whole, DECODE_SECONDS)
            except _WorkerDied as how:
                raise SpeechUnavailable(f"The speech worker ended {how}.") from None
        return [
            pcm[2 * round(begin * RATE) : 2 * round(end * RATE)] for begin, end in answer["found"]
        ]

    async def voice(self, said: Sequence[tuple[bytes, str]]) -> str:
        """Return the voice of a person who read sentences (see `voice_adaptation.voice_of`).

        Args:
            said: their sound, and their words in the decoder's spelling.

        Raises:
            SpeechUnavailable: as for `hear`.
        """
        read = [(base64.b64encode(pcm).decode(), text) for pcm, text in said]
        async with self._turn:
            try:
                await self._ready()
                answer = await self._ask({"said": read}, VOICE_SECONDS)
            except _WorkerDied as how:
                raise SpeechUnavailable(f"The speech worker ended {how}.") from None
        return str(answer["voice"])

    async def close(self) -> None:
        """End the worker, even if it is busy."""
        self._closing, self._wanted = True, None
        if self._turn.locked() and self._worker is not None:
            self._worker.kill()
        async with self._turn:
            await self._end()

    async def _hear(
        self, sound: asyncio.Queue[bytes], said: list[bytes], expecting: Expecting, endpoint: bool
    ) -> AcousticEvidence:
        """Send the worker the sound so far, and the rest as it comes."""
        await self._ready()
        id, answer = self._expect()
        self._hearing = id
        try:
            await self._send({"id": id, "begin": expecting, "endpoint": endpoint})
            for before in said:
                await self._send({"pcm": base64.b64encode(before).decode()})
            sent = sum(map(len, said))
            while not answer.done() and (not said or said[-1]):
                chunk = await self._next(sound, answer)
                if chunk is None:
                    break
                if not endpoint and chunk:
                    chunk = chunk[: max(0, 2 * RATE * LONGEST - sent)]
                    if not chunk:
                        continue
                said.append(chunk)
                if endpoint:
                    _forget(said)
                if chunk:
                    sent += len(chunk)
                    await self._send({"pcm": base64.b64encode(chunk).decode()})
            if not answer.done():
                await self._send({"id": id, "end": True})
            got = await self._decoded(answer)
            evidence = decode(AcousticEvidence, got["heard"])
            self.said, self.left = b"".join(said), b""
            if endpoint:
                end = len(self.said) - max(0, sent - got["used"])
                self.said, self.left = self.said[:end], self.said[end:]
                # sound before the utterance is private
                self.said = self.said[max(0, end - 2 * round(evidence.seconds * RATE)) :]
            return evidence
        finally:
            self._hearing = 0
            answer.cancel()

    async def _next(
        self, sound: asyncio.Queue[bytes], answer: asyncio.Future[dict[str, Any]]
    ) -> bytes | None:
        """Wait for the next chunk; None if the answer comes first."""
        coming = asyncio.ensure_future(sound.get())
        either: set[asyncio.Future[Any]] = {coming, answer}
        try:
            await asyncio.wait(either, return_when=asyncio.FIRST_COMPLETED)
        finally:
            if not coming.done():
                coming.cancel()
        return coming.result() if coming.done() and not coming.cancelled() else None

    async def _ready(self) -> None:
        if self.pid is None:
            if self._worker is not None:
                await self._worker.stopped(END_SECONDS)  # so that its end has been reported
            await self._begin()

    async def _begin(self) -> None:
        """Start a worker, after cleaning up an ended one."""
        await self._end()
        if self._wanted is None:
            raise SpeechUnavailable("Speech was not started yet.")
        try:
            self._worker = WorkerProcess(
                WORKER,
                hear=self._hear_of,
                ended=self._tell_end,
                read=_answer,
                lost=_WorkerDied,
                log=self._log,
                longest=LONGEST_ANSWER,
                loop=asyncio.get_running_loop(),
            )
        except WorkerError as error:
            raise SpeechUnavailable(f"The speech worker cannot be started ({error}).") from None
        try:
            await self._tell_what()
        except SpeechUnavailable:
            await self._end()
            raise

    async def _tell_what(self) -> None:
        if self._wanted is None:
            raise SpeechUnavailable("Speech was not started yet.")
        answer = await self._ask({"wanted": encode(self._wanted)}, START_SECONDS)
        self.left_out = tuple(answer["left_out"])

    async def _ask(self, request: dict[str, Any], seconds: float) -> dict[str, Any]:
        id, answer = self._expect()
        try:
            await self._send({"id": id, **request})
            return await self._wait(answer, seconds)
        finally:
            answer.cancel()

    def _expect(self) -> tuple[int, asyncio.Future[dict[str, Any]]]:
        if self._worker is None:
            raise _WorkerDied("closed")
        id, answer = self._worker.expect()
        return id, asyncio.wrap_future(answer)

    async def _send(self, request: dict[str, Any]) -> None:
        worker = self._worker
        if worker is None:
            raise _WorkerDied("closed")
        written = worker.tell(request)
        if written is not None:
            _, late = await asyncio.wait({asyncio.wrap_future(written)}, timeout=DECODE_SECONDS)
            if late:
                worker.kill()  # it hangs

    async def _wait(self, coming: asyncio.Future[dict[str, Any]], seconds: float) -> dict[str, Any]:
        try:
            return await asyncio.wait_for(coming, seconds)
        except TimeoutError:
            await self._end(0)
            raise SpeechUnavailable(
                f"The speech worker did not answer in {seconds:g} s and was ended; "
                "it is started again at the next use."
            ) from None

    async def _decoded(self, answer: asyncio.Future[dict[str, Any]]) -> dict[str, Any]:
        """Wait for a decoded utterance; kill a worker without progress.

        Raises:
            _WorkerDied: it was killed; another worker can decode the utterance.
        """
        loop = asyncio.get_running_loop()
        begun = moved = loop.time()
        before = cpu_seconds(self.pid)
        while not (await asyncio.wait({answer}, timeout=LOOK_SECONDS))[0]:
            now, used = loop.time(), cpu_seconds(self.pid)
            if used != before or used is None:
                before, moved = used, now
            if now - moved > STALLED_SECONDS or now - begun > DECODE_SECONDS:
                if self._worker is not None:
                    self._worker.kill()
                break
        return await answer

    def _hear_of(self, said: dict[str, Any], _: bytes) -> bool:
        """Handle a partial result; return False if the line is an answer."""
        if "partial" not in said and "speaking" not in said:
            return False
        if said.get("id") == self._hearing:  # else it belongs to an abandoned utterance
            if "partial" in said:
                self.partial(str(said["partial"]))
            else:
                self.speaking()
        return True

    def _tell_end(self, how: str) -> None:
        if self._worker is not None and self._notify is not None and not self._closing:
            self._notify(how)

    async def _end(self, patience: float | None = None) -> None:
        worker, self._worker = self._worker, None
        if worker is not None:
            await worker.stopped(END_SECONDS if patience is None else patience)


def _answer(said: dict[str, Any]) -> dict[str, Any]:
    """Return an answer.

    Raises:
        SpeechUnavailable: it is an error.
    """
    if "error" in said:
        raise SpeechUnavailable(str(said["error"]))
    return said


def _forget(said: list[bytes]) -> None:
    """Drop sound that is older than the longest utterance plus the worker's delay."""
    while sum(map(len, said)) > 2 * RATE * (LONGEST + BEHIND):
        said.pop(0)
