"""Sound on standard input: raw samples or a WAV, from a pipe, a file or a remote laptop."""

from __future__ import annotations

import asyncio
import contextlib
import os
import stat
from collections.abc import Callable

from tangy_hw.audio.source import Chunks, Recording, Source, WholeSamples
from tangy_hw.audio.wav import LARGEST_WAV, Format, SoundError, decode_wav, read_header

ENOUGH_TO_GUESS = 2_000  # bytes, 60 ms


def open_standard_input(name: str, descriptor: int, *, convert: bool = True) -> Source:
    """Open the sound on a file descriptor; a file is read at once, a pipe as it arrives.

    Args:
        name: name of the source in errors.
        descriptor: the file descriptor, which stays open.
        convert: also accept a WAV of another format from a pipe, once it is complete.

    Raises:
        SoundError: it is a terminal, closed, a folder, or a file without sound.
    """
    try:
        kind = os.fstat(descriptor).st_mode
    except OSError:
        raise SoundError(f"{name}: standard input is closed; pipe sound into it.") from None
    if os.isatty(descriptor):
        raise SoundError(f"{name}: standard input is a terminal; pipe sound into it.")
    if stat.S_ISDIR(kind):
        raise SoundError(f"{name}: standard input is a folder; pipe sound into it.")
    if not stat.S_ISREG(kind):
        return PipedSource(name, descriptor, convert=convert)
    with os.fdopen(os.dup(descriptor), "rb") as file:
        content = file.read(LARGEST_WAV + 1)
    if len(content) > LARGEST_WAV:
        raise SoundError(f"{name}: is larger than {LARGEST_WAV:,} bytes.")
    if content.startswith(b"RIFF"):
        return Recording(name, decode_wav(content, name))
    _refuse_odd(content, name)
    return Recording(name, content[: len(content) // 2 * 2])


class PipedSource(Source):
    """Sound from a pipe, as it arrives."""

    def __init__(self, name: str, descriptor: int, *, convert: bool = True) -> None:
        super().__init__(name, live=True)
        self._descriptor = descriptor
        self._convert = convert

    async def _sound(self) -> Chunks:
        whole = WholeSamples()
        chunks = _read_pipe(self._descriptor)
        async with contextlib.aclosing(chunks):
            head = await self._head(chunks)
            yield whole.of(head)
            async for chunk in chunks:
                yield whole.of(chunk)

    async def _head(self, chunks: Chunks) -> bytes:
        """Read until the format is known; return the first samples (all samples of a WAV)."""
        head, other = b"", False
        async for chunk in chunks:
            head += chunk
            if not head.startswith(b"RIFF"):
                if len(head) >= ENOUGH_TO_GUESS:
                    break
                continue
            found = read_header(head, self.name)
            if found is not None and found[0].native:
                return head[found[1] :]
            if found is not None and not other:
                other = True
                self._told_of_other(found[0])
            if len(head) > LARGEST_WAV:
                raise SoundError(f"{self.name}: is larger than {LARGEST_WAV:,} bytes.")
        if head.startswith(b"RIFF"):
            return decode_wav(head, self.name)
        _refuse_odd(head, self.name)
        return head

    def _told_of_other(self, form: Format) -> None:
        """Report that a WAV of another format is only heard when it is complete."""
        found = f"{form.rate:,} samples a second, {form.channels} channels, {form.bits} bits"
        needed = "for a microphone record 16,000, 1 channel, 16 bits"
        if not self._convert:
            raise SoundError(f"{self.name}: the sound has {found}; {needed}.")
        self.tell(f"The sound has {found}: it is heard when it is complete; {needed}.")


def _refuse_odd(head: bytes, name: str) -> None:
    odd = odd_kind(head)
    if odd:
        raise SoundError(f"{name}: {odd}")


async def _read_pipe(descriptor: int) -> Chunks:
    kind = os.fstat(descriptor).st_mode
    if not (stat.S_ISFIFO(kind) or stat.S_ISSOCK(kind)):
        while chunk := await asyncio.to_thread(os.read, descriptor, 1 << 16):
            yield chunk
        return
    reader = asyncio.StreamReader()
    make: Callable[[], asyncio.StreamReaderProtocol] = lambda: asyncio.StreamReaderProtocol(reader)  # noqa: E731
    pipe = os.fdopen(os.dup(descriptor), "rb", buffering=0)
    transport, _ = await asyncio.get_running_loop().connect_read_pipe(make, pipe)
    try:
        while chunk := await reader.read(1 << 16):
            yield chunk
    finally:
        transport.close()


HOW = "send raw 16-bit samples, 16,000 a second, one channel"
KINDS = {
    b"fLaC": "FLAC", b"OggS": "Ogg", b"ID3": "MP3", b"FORM": "AIFF", b".snd": "AU",
    b"caff": "CAF", b"RF64": "RF64", b"\x1aE\xdf\xa3": "WebM or Matroska",
}  # fmt: skip
AT_LEAST = 200  # bytes; fewer do not tell

TEXT = frozenset((9, 10, 13, 27, *range(32, 127)))
MIDDLE = frozenset(range(0x40, 0xC0))  # 8-bit silence is 0x80
SMALL = frozenset((0x00, 0x80, *range(0x20, 0x40), *range(0xA0, 0xC0)))  # floats from -1 to 1


def odd_kind(head: bytes) -> str:
    """Return a sentence about the format of a stream's head, "" if it may be raw samples.

    Real 16-bit sound crosses zero within a few hundred samples, so its high bytes include 0x00 and
    0xFF; its low bytes take every value.
    """
    for magic, kind in KINDS.items():
        if head.startswith(magic):
            return f"this is {kind}, not raw sound; {HOW}."
    if len(head) < AT_LEAST:
        return "this is text, not sound." if head.strip() and set(head) <= TEXT else ""
    if set(head) <= TEXT:
        return f"this is text, not sound; {HOW}."
    if set(head) <= MIDDLE:
        return f"this is 8-bit sound; {HOW}."
    high = head[3 : len(head) // 4 * 4 : 4]
    full = sum(byte not in (0x00, 0x80) for byte in high)
    if set(high) <= SMALL and full > len(high) / 2 and len(set(head[1 : 4 * len(high) : 4])) > 32:
        return f"this is floating-point sound; {HOW}."
    return ""
