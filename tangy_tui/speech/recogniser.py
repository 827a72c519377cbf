"""Speech identification (III-A-1) as the program sees it: sound in, evidence of words out.

The decoder runs in a process of its own (see `worker`, which also documents how it is spoken to);
here it is started, asked, watched, and started again when it has died, with what it had heard.
"""

from __future__ import annotations

import asyncio
import base64
import contextlib
import json
import os
import signal
import sys
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import IO, Any

from tangy_profiles.errors import TangyError
from tangy_profiles.worker_log import open_log
from tangy_tui.speech.evidence import LONGEST, RATE, AcousticEvidence, Expecting, Wanted

WORKER = (sys.executable, "-P", "-m", "tangy_tui.speech.worker")
START_SECONDS = 30.0  # for the worker to load its models: 0.8 s when nothing else runs
DECODE_SECONDS = 30.0  # for an utterance: 0.2 s when nothing else runs
END_SECONDS = 2.0
BEHIND = 5.0  # s of sound that are on the way to the worker at most
ATTEMPTS = 2  # at one utterance, before it is given up
LONGEST_ANSWER = 1 << 20  # bytes; a recording may have thousands of utterances


class SpeechUnavailable(TangyError):
    """Nothing can be decoded now; one sentence that says why."""


class _WorkerDied(Exception):
    """The worker ended before it answered; its text says how, in a few words."""


class Recogniser:
    """The decoder for what is wanted of it. One utterance is heard at a time.

    `left_out` lists the words that cannot be heard, because nobody knows how they are pronounced;
    the phrases with them are understood only when they are typed.
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
        self.partial: Callable[[str], None] = lambda words: None
        """Is called with the words so far of the utterance that is being spoken."""
        self.speaking: Callable[[], None] = lambda: None
        """Is called where the beginning of an utterance was found in what comes."""
        self._log = log
        self._notify = notify
        self._wanted: Wanted | None = None
        self._process: asyncio.subprocess.Process | None = None
        self._reader: asyncio.Task[None] | None = None
        self._waiting: dict[int, asyncio.Future[dict[str, Any]]] = {}
        self._turn = asyncio.Lock()
        self._asked = 0
        self._closing = False
        self.said = b""
        """The sound of the last utterance that was heard."""
        self.left = b""
        """What was taken of the sound after it, where its end was found."""

    @property
    def pid(self) -> int | None:
        """The process that decodes, if one runs."""
        alive = self._process is not None and self._process.returncode is None
        return self._process.pid if alive and self._process else None

    async def start(self, wanted: Wanted) -> None:
        """Start the worker, or have it listen for something else.

        Raises:
            SpeechUnavailable: the worker cannot run here, or no phrase can be pronounced.
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
            SpeechUnavailable: the worker died over it twice, or cannot be started again.
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
        """Hear one utterance as it is spoken; an empty chunk ends it.

        If the worker dies over it, a new one is given all that was said so far, and it goes on.
        Of what is longer than 15 s the rest is not heard.

        Args:
            sound: chunks of 16 kHz mono s16le.
            expecting: what is listened for.
            endpoint: find where it begins and ends; what was taken after that is in `left`.

        Raises:
            SpeechUnavailable: the worker died over it twice, or cannot be started again.
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
        """Return the utterances in a recording, cut at the pauses.

        Raises:
            SpeechUnavailable: as for `hear`.
        """
        async with self._turn:
            try:
                await self._ready()
                answer = await self._ask({"pieces": base64.b64encode(pcm).decode()}, DECODE_SECONDS)
            except _WorkerDied as how:
                raise SpeechUnavailable(f"The speech worker ended {how}.") from None
        return [
            pcm[2 * round(begin * RATE) : 2 * round(end * RATE)] for begin, end in answer["found"]
        ]

    async def close(self) -> None:
        """End the worker, whatever it is doing."""
        self._closing, self._wanted = True, None
        if self._turn.locked() and self._process is not None:
            _kill(self._process)
        async with self._turn:
            await self._end()

    async def _hear(
        self, sound: asyncio.Queue[bytes], said: list[bytes], expecting: Expecting, endpoint: bool
    ) -> AcousticEvidence:
        """Let the worker hear what was said so far, and what comes."""
        await self._ready()
        id, answer = self._expect()
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
            got = await self._answer(answer, DECODE_SECONDS)
            evidence = AcousticEvidence(
                **{field.name: got["heard"][field.name] for field in fields(AcousticEvidence)}
            )
            self.said, self.left = b"".join(said), b""
            if endpoint:
                end = len(self.said) - max(0, sent - got["used"])
                self.said, self.left = self.said[:end], self.said[end:]
                # what came before it is nobody's business
                self.said = self.said[max(0, end - 2 * round(evidence.seconds * RATE)) :]
            return evidence
        finally:
            self._waiting.pop(id, None)

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
            if self._reader is not None:
                await asyncio.wait({self._reader})  # which says how it ended
            await self._begin()

    async def _begin(self) -> None:
        """Start a worker; one that has ended is cleared away."""
        await self._end()
        if self._wanted is None:
            raise SpeechUnavailable("Speech was not started yet.")
        log: int | IO[bytes] = asyncio.subprocess.DEVNULL
        try:
            if self._log is not None:
                log = open_log(self._log)
            self._process = await asyncio.create_subprocess_exec(
                *WORKER,
                stdin=asyncio.subprocess.PIPE,
                stdout=asyncio.subprocess.PIPE,
                stderr=log,
                start_new_session=True,  # ctrl+c in the terminal is not meant for it
                limit=LONGEST_ANSWER,
            )
        except OSError as error:
            raise SpeechUnavailable(
                f"The speech worker cannot be started ({error.strerror})."
            ) from None
        finally:
            if not isinstance(log, int):
                log.close()
        self._reader = asyncio.create_task(self._read(self._process))
        try:
            await self._tell_what()
        except SpeechUnavailable:
            await self._end()
            raise

    async def _tell_what(self) -> None:
        if self._wanted is None:
            raise SpeechUnavailable("Speech was not started yet.")
        answer = await self._ask({"wanted": self._wanted.to_json()}, START_SECONDS)
        self.left_out = tuple(answer["left_out"])

    async def _ask(self, request: dict[str, Any], seconds: float) -> dict[str, Any]:
        id, answer = self._expect()
        try:
            await self._send({"id": id, **request})
            return await self._answer(answer, seconds)
        finally:
            self._waiting.pop(id, None)

    def _expect(self) -> tuple[int, asyncio.Future[dict[str, Any]]]:
        self._asked += 1
        answer: asyncio.Future[dict[str, Any]] = asyncio.get_running_loop().create_future()
        self._waiting[self._asked] = answer
        return self._asked, answer

    async def _send(self, request: dict[str, Any]) -> None:
        process = self._process
        if process is None or process.stdin is None:
            raise _WorkerDied("unasked")
        try:
            process.stdin.write(json.dumps(request).encode() + b"\n")
            await asyncio.wait_for(process.stdin.drain(), DECODE_SECONDS)
        except TimeoutError:
            _kill(process)  # it hangs
        except OSError:
            pass  # its reader says how it ended

    async def _answer(
        self, coming: asyncio.Future[dict[str, Any]], seconds: float
    ) -> dict[str, Any]:
        try:
            answer = await asyncio.wait_for(coming, seconds)
        except TimeoutError:
            await self._end(kill=True)
            raise SpeechUnavailable(
                f"The speech worker did not answer in {seconds:g} s and was ended; "
                "it is started again at the next use."
            ) from None
        if "error" in answer:
            raise SpeechUnavailable(str(answer["error"]))
        return answer

    async def _read(self, process: asyncio.subprocess.Process) -> None:
        """Give each answer to whoever waits for it, until the worker ends."""
        stdout = process.stdout or asyncio.StreamReader()
        try:
            while line := await stdout.readline():
                self._took(json.loads(line))
        except (OSError, ValueError, TypeError):  # that is no answer: it cannot be relied on
            _kill(process)
            with contextlib.suppress(OSError):
                while await stdout.read(1 << 16):  # a full pipe would keep it from ending
                    pass
        await _let_end(process)
        if self._process is process:
            how = _epitaph(process)
            for waiting in self._waiting.values():
                if not waiting.done():
                    waiting.set_exception(_WorkerDied(how))
            if self._notify is not None and not self._closing:
                self._notify(f"The speech worker ended {how}; it is started again.")

    def _took(self, answer: Any) -> None:
        if not isinstance(answer, dict):
            raise TypeError("An answer is an object.")
        waiting = self._waiting.get(answer.get("id", 0))
        if waiting is None or waiting.done():
            return
        try:
            if "partial" in answer:
                self.partial(str(answer["partial"]))
            elif "speaking" in answer:
                self.speaking()
            else:
                waiting.set_result(answer)
        except Exception as error:  # whoever was told could not take it
            waiting.set_exception(error)

    async def _end(self, *, kill: bool = False) -> None:
        process, self._process = self._process, None
        reader, self._reader = self._reader, None
        if process is not None and process.returncode is None:
            if kill:
                _kill(process)
            elif process.stdin is not None:
                process.stdin.close()
            await _let_end(process)
        if reader is not None:
            await asyncio.wait({reader})


def _forget(said: list[bytes]) -> None:
    """Keep no more of a stream than an utterance can be long, and the worker can be behind."""
    while sum(map(len, said)) > 2 * RATE * (LONGEST + BEHIND):
        said.pop(0)


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
    """Kill a process, and leave its status to asyncio (`process.kill()` may take it away)."""
    if process.returncode is None:
        with contextlib.suppress(ProcessLookupError):
            os.kill(process.pid, signal.SIGKILL)


def _epitaph(process: asyncio.subprocess.Process) -> str:
    code = process.returncode or 0
    how = f"signal {-code}" if code < 0 else f"status {code}"
    return f"unasked ({how})"
