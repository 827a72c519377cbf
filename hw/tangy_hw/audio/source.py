"""The interface of a sound source.

Sound is 16-bit little-endian samples, 16,000 a second, one channel: what the acoustic model of
III-A-1 was trained on.
"""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncGenerator, AsyncIterator, Callable

Chunks = AsyncGenerator[bytes, None]

BYTES_PER_SECOND = 2 * 16_000
SPOKEN_PIECE = BYTES_PER_SECOND // 20  # bytes; 50 ms, as a microphone hands them on


def _nobody(sentence: str) -> None:
    """Tell nobody."""


class Source:
    """Chunks of sound, of any even size: `async for chunk in source`. Close it in the end.

    It listens from the first chunk that is asked for until it is closed. A recording comes in one
    chunk; live sound arrives as it is spoken, and is buffered for the consumer.
    """

    def __init__(self, name: str, *, live: bool) -> None:
        self.name = name
        """As it was given: FILE.wav, -, arecord, socket."""
        self.live = live
        """Whether somebody is speaking now, rather than on a recording."""
        self.recorded = not live
        """Whether it was spoken at another time."""
        self.tell: Callable[[str], None] = _nobody
        """Is called with a sentence when something must be said about the source."""
        self._taken: asyncio.Queue[bytes] = asyncio.Queue(1)
        self._task: asyncio.Task[None] | None = None
        self._error: BaseException | None = None
        self._closed = False

    def __aiter__(self) -> AsyncIterator[bytes]:
        return self

    async def __anext__(self) -> bytes:
        """Return the next chunk.

        Raises:
            SoundError: once, when it cannot go on.
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
        """Stop listening for good, and end the recorder; a waiting consumer gets no chunk."""
        self._closed = True
        if self._task is not None:
            self._task.cancel()
            await asyncio.wait({self._task})
        self._release()

    def begin(self) -> None:
        """Begin to speak, where that is waited for: nowhere but with a recording."""

    def _sound(self) -> Chunks:
        """Give the sound; each kind of source does it in its own way."""
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
    """Sound that is there already, as a whole."""

    def __init__(self, name: str, pcm: bytes) -> None:
        super().__init__(name, live=False)
        self._pcm = pcm

    def spoken(self) -> SpokenRecording:
        """Return it as somebody would say it now."""
        return SpokenRecording(self.name, self._pcm)

    async def _sound(self) -> Chunks:
        yield self._pcm


class SpokenRecording(Source):
    """A recording that comes as fast as it was spoken, once it is begun."""

    def __init__(self, name: str, pcm: bytes) -> None:
        super().__init__(name, live=True)
        self.recorded = True
        self._pcm = pcm
        self._begun = asyncio.Event()

    def begin(self) -> None:
        """Begin to speak."""
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
    """Joins what arrives in pieces of any size to pieces of whole samples."""

    def __init__(self) -> None:
        self._rest = b""

    def of(self, chunk: bytes) -> bytes:
        """Return the samples that this piece completes."""
        if not self._rest and len(chunk) % 2 == 0:
            return chunk
        chunk = self._rest + chunk
        whole = len(chunk) // 2 * 2
        self._rest = chunk[whole:]
        return chunk[:whole]
