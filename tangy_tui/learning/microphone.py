"""Where a teacher's voice comes from: WAV files, standard input, or the local microphone.

Every source gives utterances: pieces of sound between pauses, as 16-bit little-endian samples,
16,000 a second, one channel (what the acoustic model of III-A-1 was trained on). A source is:

    FILE.wav    the utterances in a file
    -           standard input, raw samples as above or a WAV. From afar:
                arecord -q -t raw -f S16_LE -r 16000 -c 1 | ssh robot tangy teach --mic -
    arecord     the local microphone, through ALSA's recorder

With `-` the keys must come from elsewhere: the program gives this room a duplicate of its standard
input, and opens /dev/tty in its place, before the first screen is painted.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import stat
import time
from collections import deque
from collections.abc import AsyncGenerator, AsyncIterator
from pathlib import Path

from tangy_profiles.reading import plain
from tangy_tui.learning.wav import LARGEST_WAV, RATE, SoundError, decode_wav, read_header, read_wav

FRAME = 320  # samples, 20 ms: the pieces that are called loud or quiet
LONGEST = 6.0  # s; a longer utterance is cut here, because babble never pauses
PAUSE = 0.5  # s of quiet that end an utterance
MARGIN = 0.2  # s of sound that are kept before and after it
SHORTEST = 0.12  # s of loud frames; less is a click
AFTER_SPEAKING = 0.3  # s for which a microphone stays shut after it is opened: the room rings on

QUIETEST = 40.0  # of 32,768 (-58 dB); what is below is silence everywhere
LOUDER = 2.5  # a loud frame is 8 dB above the floor
FLOOR_SECONDS = 3.0  # the floor is the tenth percentile of that time

END_SECONDS = 2.0  # for arecord to end by itself when it has closed its output
RECORD = ("arecord", "-q", "-t", "raw", "-f", "S16_LE", "-r", str(RATE), "-c", "1")

Chunks = AsyncGenerator[bytes, None]


def split(pcm: bytes) -> list[bytes]:
    """Split a recording into its utterances; one that is all quiet has none."""
    splitter = Splitter(_floor_of(pcm))
    return splitter.feed(pcm) + splitter.finish()


class Splitter:
    """Cuts a stream of samples into utterances at its pauses, by how loud it is.

    The floor is followed, so a steady hum is quiet. It starts at `floor` (root mean square of
    16-bit samples), until as much has been heard as it is taken from.
    """

    def __init__(self, floor: float = QUIETEST / LOUDER) -> None:
        self._levels: deque[float] = deque(maxlen=round(FLOOR_SECONDS * RATE / FRAME))
        self._levels.extend([floor] * (self._levels.maxlen or 1))
        self.level = 0.0
        self._rest = b""
        self._begin()

    def feed(self, pcm: bytes) -> list[bytes]:
        """Take samples and return the utterances that have ended in them."""
        pcm = self._rest + pcm
        whole = len(pcm) // (2 * FRAME) * (2 * FRAME)
        self._rest = pcm[whole:]
        ended: list[bytes] = []
        for place, level in enumerate(_levels(pcm[:whole])):
            frame = pcm[2 * FRAME * place : 2 * FRAME * (place + 1)]
            utterance = self._hear(frame, level)
            if utterance:
                ended.append(utterance)
        return ended

    def finish(self) -> list[bytes]:
        """Return the utterance that the end of the stream cuts off, if there is one."""
        utterance = self._end(max(0, self._quiet - round(MARGIN * RATE / FRAME)))
        self._rest = b""
        return [utterance] if utterance else []

    def forget(self) -> None:
        """Drop what has been heard of an utterance."""
        self._rest = b""
        self._begin()

    def _begin(self) -> None:
        self._before: deque[tuple[bytes, bool]] = deque(maxlen=round(MARGIN * RATE / FRAME) + 5)
        self._frames: list[bytes] = []
        self._loud = 0
        self._quiet = 0

    def _hear(self, frame: bytes, level: float) -> bytes:
        self.level = level
        self._levels.append(level)
        floor = sorted(self._levels)[len(self._levels) // 10]
        loud = level > max(QUIETEST, LOUDER * floor)
        if not self._frames:
            self._before.append((frame, loud))
            recent = [was for _, was in self._before][-5:]
            if sum(recent) >= 3:
                self._frames = [kept for kept, _ in self._before]
                self._loud, self._quiet = sum(recent), 0
            return b""
        self._frames.append(frame)
        self._loud += loud
        self._quiet = 0 if loud else self._quiet + 1
        if self._quiet * FRAME >= PAUSE * RATE:
            return self._end(self._quiet - round(MARGIN * RATE / FRAME))
        return self._end(0) if len(self._frames) * FRAME >= LONGEST * RATE else b""

    def _end(self, drop: int) -> bytes:
        """Close the utterance, without its last `drop` frames of quiet."""
        frames = self._frames[: len(self._frames) - drop]
        enough = self._loud * FRAME >= SHORTEST * RATE
        self._begin()
        return b"".join(frames) if enough else b""


class Microphone:
    """A source of utterances that is listened to in the background: `async for pcm in mic`.

    While it is shut (the robot speaks), what is heard is dropped. `level` (0 to 1) and
    `silent_seconds` (since the source last sent anything) are for a meter on a screen.
    """

    def __init__(self, chunks: Chunks, *, live: bool, floor: float = 0.0) -> None:
        self._chunks = chunks
        self._live = live
        self._splitter = Splitter(floor) if floor else Splitter()
        self._utterances: asyncio.Queue[bytes | None] = asyncio.Queue()
        self._task: asyncio.Task[None] | None = None
        self._shut = False
        self._deaf = 0
        self._last = time.monotonic()

    @property
    def level(self) -> float:
        """How loud it is now: 0 for silence, 1 for as loud as can be."""
        return min(1.0, self._splitter.level / 32_768)

    @property
    def silent_seconds(self) -> float:
        """Seconds since the source last sent anything; above 2 it is worth a word."""
        return time.monotonic() - self._last

    def shut(self) -> None:
        """Stop listening while the robot speaks. A recording has no robot in it, and goes on."""
        if self._live:
            self._shut = True
            self._splitter.forget()
            while not self._utterances.empty() and self._task and not self._task.done():
                self._utterances.get_nowait()

    def open(self) -> None:
        """Listen again, a moment from now: the room still rings."""
        if self._shut:
            self._shut = False
            self._deaf = round(AFTER_SPEAKING * RATE) * 2

    def __aiter__(self) -> AsyncIterator[bytes]:
        return self

    async def __anext__(self) -> bytes:
        if self._task is None:
            self._last = time.monotonic()
            self._task = asyncio.create_task(self._listen())
        elif self._task.done() and self._utterances.empty():
            raise StopAsyncIteration
        utterance = await self._utterances.get()
        if utterance is not None:
            return utterance
        await asyncio.wait({self._task})
        if not self._task.cancelled():
            self._task.result()
        raise StopAsyncIteration

    async def close(self) -> None:
        """Stop listening for good, and end what records."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.wait({self._task})

    async def _listen(self) -> None:
        try:
            async with contextlib.aclosing(self._chunks) as chunks:
                async for chunk in chunks:
                    self._take(chunk)
            for utterance in self._splitter.finish():
                self._utterances.put_nowait(utterance)
        finally:
            self._utterances.put_nowait(None)

    def _take(self, chunk: bytes) -> None:
        self._last = time.monotonic()
        if self._shut:
            return
        dropped = min(self._deaf, len(chunk))
        self._deaf -= dropped
        for utterance in self._splitter.feed(chunk[dropped:]):
            self._utterances.put_nowait(utterance)


def open_microphone(source: str, *, stdin: int = 0) -> Microphone:
    """Open a source by its name: FILE.wav, `-` (the file descriptor `stdin`), or `arecord`.

    Raises:
        SoundError: the file cannot be used, or standard input is a terminal.
    """
    if source == "arecord":
        return Microphone(_recorded(), live=True)
    if source == "-":
        if os.isatty(stdin):
            raise SoundError("--mic -: standard input is a terminal; pipe sound into it.")
        return Microphone(_piped(stdin), live=True)
    pcm = read_wav(Path(source))
    return Microphone(_at_once(pcm), live=False, floor=_floor_of(pcm))


async def _at_once(pcm: bytes) -> Chunks:
    yield pcm


async def _recorded() -> Chunks:
    """Record from the local microphone."""
    try:
        process = await asyncio.create_subprocess_exec(
            *RECORD,
            stdin=asyncio.subprocess.DEVNULL,
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.PIPE,
            start_new_session=True,
        )
    except OSError:
        raise SoundError(
            "arecord cannot be started: install alsa-utils, or give a WAV file or - instead."
        ) from None
    if process.stdout is None or process.stderr is None:
        raise SoundError("arecord gives no sound.")
    try:
        while chunk := await process.stdout.read(2 * RATE // 10):
            yield chunk
        said = plain((await process.stderr.read(2000)).decode(errors="replace").strip())
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(process.communicate(), END_SECONDS)
        last = said.replace("\N{REPLACEMENT CHARACTER}", " ").strip()[-120:]
        raise SoundError(f"The microphone stopped: {last or 'arecord ended'}.")
    finally:
        if process.returncode is None:
            with contextlib.suppress(ProcessLookupError):
                process.kill()
        await process.communicate()  # wait() alone would wait for what nobody reads any more


async def _piped(descriptor: int) -> Chunks:
    """Read samples, raw or in a WAV, from an open file descriptor."""
    chunks = _read_pipe(descriptor)
    head = b""
    async with contextlib.aclosing(chunks):
        async for chunk in chunks:
            head += chunk
            if len(head) >= 4 and not head.startswith(b"RIFF"):
                yield head
                break
            found = read_header(head, "--mic -")
            if found is not None and found[0].native:
                yield head[found[1] :]
                break
            if len(head) > LARGEST_WAV:
                raise SoundError(f"--mic -: is larger than {LARGEST_WAV:,} bytes.")
        else:
            if head:
                yield decode_wav(head, "--mic -") if head.startswith(b"RIFF") else head
            return
        async for chunk in chunks:
            yield chunk


async def _read_pipe(descriptor: int) -> Chunks:
    kind = os.fstat(descriptor).st_mode
    if not (stat.S_ISFIFO(kind) or stat.S_ISSOCK(kind)):
        while chunk := await asyncio.to_thread(os.read, descriptor, 1 << 16):
            yield chunk
        return
    reader = asyncio.StreamReader()
    pipe = os.fdopen(os.dup(descriptor), "rb", buffering=0)
    transport, _ = await asyncio.get_running_loop().connect_read_pipe(
        lambda: asyncio.StreamReaderProtocol(reader), pipe
    )
    try:
        while chunk := await reader.read(1 << 14):
            yield chunk
    finally:
        transport.close()


def _levels(pcm: bytes) -> list[float]:
    """Return the root mean square of every frame, its mean (a bias of the device) taken out."""
    import numpy as np

    frames = np.frombuffer(pcm, "<i2").reshape(-1, FRAME).astype(np.float64)
    levels: list[float] = frames.std(axis=1).tolist()
    return levels


def _floor_of(pcm: bytes) -> float:
    """Guess how loud the pauses of a recording are: its quietest tenth, but far below its loudest.

    A recording without any loud and quiet in it is all hum: no voice is as even as that.
    """
    levels = sorted(_levels(pcm[: len(pcm) // (2 * FRAME) * (2 * FRAME)])) or [0.0]
    quiet, loudest = levels[len(levels) // 10], levels[-1]
    return max(1.0, quiet if quiet > loudest / 3 else min(quiet, loudest / 10))
