"""Interface of a sound source.

Sound is 16-bit little-endian samples, 16,000 a second, one channel, as in the training data of the
acoustic model (III-A-1).
"""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncGenerator, AsyncIterator, Callable

Chunks = AsyncGenerator[bytes, None]

BYTES_PER_SECOND = 2 * 16_000
SPOKEN_PIECE = BYTES_PER_SECOND // 20  # bytes; 50 ms, as from a microphone


def _nobody(sentence: str) -> None:
    """Ignore the sentence."""


class Source:
    """Chunks of sound, of any even size: `async for chunk in source`; close it at the end.

    It records from the first requested chunk until it is closed. A recording is one chunk; live
    sound arrives as it is spoken, and waits for the consumer.
    """

    def __init__(self, name: str, *, live: bool) -> None:
        self.name = name
        """As given: FILE.wav, -, arecord, socket."""
        self.live = live
        """Whether chunks arrive at the speed of speech, rather than all at once."""
        self.recorded = not live
        """Whether the sound was recorded earlier."""
        self.tell: Callable[[str], None] = _nobody
        """Called with a sentence about each change of the source."""
        self._taken: asyncio.Queue[bytes] = asyncio.Queue(1)
        self._task: asyncio.Task[None] | None = None
        self._error: BaseException | None = None
        self._closed = False

    def __aiter__(self) -> AsyncIterator[bytes]:
        return self

    async def __anext__(self) -> bytes:
        """Return the next chunk.

        Raises:
            SoundError: once, if the source cannot go on.
        """
        if self._task is None and not self._closed:
            self._task = asyncio.create_task(self._listen())
            self._task.add_done_callback(self._over)
        while not self._closed and self._task is not None:
            if self._task.done() and self._taken.empty():
                break
            chunk = await self._taken.get()
            if chunk:
                return chunk
        error, self._error = self._error, None
        if error is not None:
            raise error
        raise StopAsyncIteration

    async def close(self) -> None:
        """Stop for good, and end the recorder; a waiting consumer gets no chunk."""
        self._closed = True
        if self._task is not None:
            self._task.cancel()
            await asyncio.wait({self._task})
        self._release()

    def begin(self) -> None:
        """Start to speak; only `SpokenRecording` waits for this."""

    def _sound(self) -> Chunks:
        """Yield the sound; implemented by each kind of source."""
        raise NotImplementedError

    def _release(self) -> None:
        """Release the resources of the open source."""

    async def _listen(self) -> None:
        async with contextlib.aclosing(self._sound()) as chunks:
            async for chunk in chunks:
                if chunk:
                    await self._taken.put(chunk)

    def _over(self, task: asyncio.Task[None]) -> None:
        self._error = None if task.cancelled() else task.exception()
        if self._taken.empty():
            self._taken.put_nowait(b"")  # wakes a waiting consumer


class Recording(Source):
    """A recording as a whole."""

    def __init__(self, name: str, pcm: bytes) -> None:
        super().__init__(name, live=False)
        self._pcm = pcm

    def spoken(self) -> SpokenRecording:
        """Return it as a source at the speed of speech."""
        return SpokenRecording(self.name, self._pcm)

    async def _sound(self) -> Chunks:
        yield self._pcm


class SpokenRecording(Source):
    """A recording at the speed of speech, from `begin` on."""

    def __init__(self, name: str, pcm: bytes) -> None:
        super().__init__(name, live=True)
        self.recorded = True
        self._pcm = pcm
        self._begun = asyncio.Event()

    def begin(self) -> None:
        """Start to speak."""
        self._begun.set()

    async def _sound(self) -> Chunks:
        await self._begun.wait()
        clock = asyncio.get_running_loop().time
        began = clock()
        for place in range(0, len(self._pcm), SPOKEN_PIECE):
            piece = self._pcm[place : place + SPOKEN_PIECE]
            await asyncio.sleep(began + (place + len(piece)) / BYTES_PER_SECOND - clock())
            yield piece


class WholeSamples:
    """Joins chunks of any size to chunks of whole samples."""

    def __init__(self) -> None:
        self._rest = b""

    def of(self, chunk: bytes) -> bytes:
        """Return the samples that this chunk completes."""
        if not self._rest and len(chunk) % 2 == 0:
            return chunk
        chunk = self._rest + chunk
        whole = len(chunk) // 2 * 2
        self._rest = chunk[whole:]
        return chunk[:whole]
