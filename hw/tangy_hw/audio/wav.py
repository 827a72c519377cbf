"""Reads WAV files of common formats as the decoder's input: 16 kHz, one channel, s16le."""

from __future__ import annotations

import os
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tangy_profiles.errors import TangyError
from tangy_profiles.given_file import open_given, read_given
from tangy_profiles.reading import plain

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Samples = NDArray[np.float64]

RATE = 16_000  # samples a second
HEADER = 65_536  # bytes that contain the header, mostly 44
UNKNOWN_SIZE = 0x7FFF_0000  # bytes from which a length is a recorder's placeholder
LARGEST_WAV = 100_000_000  # bytes: 17 minutes of 48 kHz stereo
KERNEL = 16  # zero crossings of the resampling kernel on each side
HOW_TO_RECORD = "record one with: arecord -f S16_LE -r 16000 -c 1 FILE.wav"
A_LAW, MU_LAW = 6, 7  # telephone codecs, 8 bits a sample
CODECS = {2: "ADPCM", 0x11: "ADPCM", 0x31: "GSM", 0x55: "MP3"}


class SoundError(TangyError):
    """A source without usable sound; one sentence that names it."""


@dataclass(frozen=True, slots=True)
class Format:
    """Sample format of a WAV file."""

    codec: int  # 1 integers, 3 floating point, 6 A-law, 7 mu-law
    channels: int
    rate: int
    bits: int

    @property
    def native(self) -> bool:
        """Whether it is the decoder's format: 16 kHz, mono, 16 bits."""
        return (self.codec, self.channels, self.rate, self.bits) == (1, 1, RATE, 16)


def read_wav(path: Path) -> bytes:
    """Read a WAV file of a common format as 16 kHz mono samples (s16le).

    Raises:
        SoundError: the file is missing, too large, not a WAV, or of an unsupported format.
    """
    name = plain(str(path))
    return decode_wav(read_given(path, LARGEST_WAV, SoundError), name)


def decode_wav(content: bytes, name: str) -> bytes:
    """Convert the content of a WAV file to 16 kHz mono samples (s16le).

    Raises:
        SoundError: as for `read_wav`.
    """
    found = read_header(content, name)
    if found is None:
        raise SoundError(f"{name}: breaks off before its samples begin.")
    form, start, size = found
    sound = content[start : start + size]
    if form.native:
        sound = sound[: len(sound) // 2 * 2]
    else:
        sound = pcm_of(32_767 * _resampled(_mono(sound, form), form.rate))
    if not sound:
        raise SoundError(f"{name}: holds no samples.")
    return sound


def seconds_cut_off(path: Path) -> float:
    """Return the s of sound that a WAV file lacks compared with its header; 0 if complete.

    A file written during recording often has length 0, or the largest length; both count as
    complete, and so does a file that is not a WAV.
    """
    name = plain(str(path))
    try:
        with open_given(path, LARGEST_WAV, SoundError) as file:
            found = read_header(file.read(HEADER), name)
            size = file.seek(0, os.SEEK_END)
    except (OSError, ValueError, SoundError):
        return 0.0
    if found is None or found[2] >= UNKNOWN_SIZE:
        return 0.0
    form, start, promised = found
    missing = max(0, start + promised - size)
    return missing / (form.rate * form.channels * (form.bits // 8))


def read_header(content: bytes, name: str) -> tuple[Format, int, int] | None:
    """Return the format, and the offset and number of bytes of the samples.

    None if the content ends before the samples begin.

    Raises:
        SoundError: it is not a WAV file, or its samples cannot be read; one sentence.
    """
    if content[:4] != b"RIFF"[: len(content)] or content[8:12] not in (b"WAVE", b""):
        raise SoundError(f"{name}: is not a WAV file; {HOW_TO_RECORD}.")
    place, form = 12, None
    while place + 8 <= len(content):
        chunk, size = struct.unpack_from("<4sI", content, place)
        place += 8
        if chunk == b"data":
            if form is None:
                raise SoundError(f"{name}: does not say how its samples are written.")
            return form, place, size or UNKNOWN_SIZE  # 0 is also a placeholder
        if chunk == b"fmt ":
            if place + min(size, 40) > len(content):
                return None
            form = _format(content[place : place + min(size, 40)], name)
        place += size + size % 2
    return None


def _format(chunk: bytes, name: str) -> Format:
    if len(chunk) < 16:
        raise SoundError(f"{name}: does not say how its samples are written.")
    codec, channels, rate, _, _, bits = struct.unpack_from("<HHIIHH", chunk)
    if codec == 0xFFFE and len(chunk) >= 26:
        (codec,) = struct.unpack_from("<H", chunk, 24)
    form = Format(codec, channels, rate, bits)
    if (codec, bits) not in {
        (1, 8),
        (1, 16),
        (1, 24),
        (1, 32),
        (3, 32),
        (3, 64),
        (A_LAW, 8),
        (MU_LAW, 8),
    }:
        kind = CODECS.get(codec, f"{bits}-bit" if codec in (1, 3) else f"kind {codec}")
        raise SoundError(f"{name}: its samples are {kind}, which is not read; {HOW_TO_RECORD}.")
    if not 1 <= channels <= 8 or not 4_000 <= rate <= 192_000:
        raise SoundError(f"{name}: {channels} channels of {rate:,} samples a second are not read.")
    return form


def _mono(sound: bytes, form: Format) -> Samples:
    """Return the samples (n,) from -1 to 1, averaged over channels."""
    import numpy as np

    width = form.bits // 8
    sound = sound[: len(sound) // (width * form.channels) * width * form.channels]
    values: NDArray[Any]
    if form.codec == 3:
        values = np.nan_to_num(np.frombuffer(sound, f"<f{width}").astype(np.float64))
    elif form.codec in (A_LAW, MU_LAW):
        values = _expanded(np.frombuffer(sound, np.uint8), form.codec)
    elif width == 1:
        values = (np.frombuffer(sound, np.uint8) - 128.0) / 128
    elif width == 3:
        wide = np.zeros((len(sound) // 3, 4), np.uint8)
        wide[:, 1:] = np.frombuffer(sound, np.uint8).reshape(-1, 3)
        values = wide.view("<i4")[:, 0] / 2.0**31
    else:
        values = np.frombuffer(sound, f"<i{width}") / 2.0 ** (form.bits - 1)
    mono: Samples = np.clip(values, -1, 1).reshape(-1, form.channels).mean(axis=1)
    return mono


def _expanded(codes: NDArray[np.uint8], codec: int) -> Samples:
    """Return the samples (codes,) from -1 to 1 of telephone codes (G.711)."""
    import numpy as np

    turned = (codes ^ (0x55 if codec == A_LAW else 0xFF)).astype(np.int64)
    segment, step = (turned >> 4) & 7, turned & 15
    if codec == MU_LAW:
        size = (((step << 3) + 0x84) << segment) - 0x84
        positive = turned < 0x80
    else:
        size = np.where(
            segment > 0, ((step << 4) + 0x108) << np.maximum(segment - 1, 0), (step << 4) + 8
        )
        positive = turned >= 0x80
    return np.where(positive, size, -size) / 2.0**15


def _resampled(samples: Samples, rate: int) -> Samples:
    """Resample (n,) to 16 kHz with a windowed sinc, which removes higher frequencies."""
    import numpy as np

    if rate == RATE or not len(samples):
        return samples
    step = rate / RATE
    cut = 0.95 * min(1.0, 1 / step)
    reach = int(np.ceil(KERNEL / cut))
    offsets = np.arange(-reach, reach + 1)
    padded = np.pad(samples, reach + 1)
    made = np.empty(int(len(samples) / step))
    for first in range(0, len(made), RATE):  # one second at a time limits memory
        places = np.arange(first, min(first + RATE, len(made))) * step
        near = np.rint(places).astype(np.int64)
        distance = (offsets[None, :] + (near - places)[:, None]) * cut
        window = np.cos(np.pi / 2 * np.clip(distance / KERNEL, -1, 1)) ** 2
        taken = padded[near[:, None] + offsets[None, :] + reach + 1]
        made[first : first + len(places)] = (taken * np.sinc(distance) * window).sum(axis=1) * cut
    return made


def samples_of(pcm: bytes) -> Samples:
    """Return sound (s16le) as samples (n,), -32,768 to 32,767, without half a sample at the end."""
    import numpy as np

    return np.frombuffer(pcm[: len(pcm) // 2 * 2], "<i2").astype(np.float64)


def pcm_of(samples: Samples) -> bytes:
    """Return samples (n,) as sound (s16le), rounded and clipped."""
    import numpy as np

    return np.clip(np.rint(samples), -32_768, 32_767).astype("<i2").tobytes()
