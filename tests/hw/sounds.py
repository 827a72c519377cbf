"""Sounds that the tests make: tones, pauses, and WAV files of every kind."""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import NDArray

from tangy_hw.audio.wav import RATE

Samples = NDArray[np.float64]


def tone(seconds: float, rate: int = RATE, hertz: float = 440.0, loud: float = 0.5) -> Samples:
    return loud * np.sin(2 * np.pi * hertz * np.arange(round(seconds * rate)) / rate)


def pcm(samples: Samples) -> bytes:
    return np.rint(samples * 32_767).astype("<i2").tobytes()


def written(samples: Samples, bits: int, *, floating: bool = False) -> bytes:
    if floating:
        return samples.astype(f"<f{bits // 8}").tobytes()
    if bits == 8:
        return np.rint(samples * 127 + 128).astype(np.uint8).tobytes()
    whole = np.rint(samples * (2.0 ** (bits - 1) - 1)).astype("<i4")
    return whole.view(np.uint8).reshape(-1, 4)[:, : bits // 8].tobytes()


def wav(
    sound: bytes,
    *,
    codec: int = 1,
    channels: int = 1,
    rate: int = RATE,
    bits: int = 16,
    extensible: bool = False,
    before: bytes = b"",
    size: int | None = None,
) -> bytes:
    width = bits // 8 * channels
    form = struct.pack(
        "<HHIIHH", 0xFFFE if extensible else codec, channels, rate, rate * width, width, bits
    )
    if extensible:
        form += struct.pack("<HHIH", 22, bits, 0, codec) + bytes(14)
    chunks = b"fmt " + struct.pack("<I", len(form)) + form + before + b"data"
    chunks += struct.pack("<I", len(sound) if size is None else size) + sound
    return b"RIFF" + struct.pack("<I", 4 + len(chunks)) + b"WAVE" + chunks


def bursts(*lengths: float, pause: float = 0.8, noise: float = 0.0) -> bytes:
    """Tones of some lengths in s, with a pause before, between and after them."""
    quiet = np.zeros(round(pause * RATE))
    parts = [quiet]
    for length in lengths:
        parts += [tone(length), quiet]
    sound = np.concatenate(parts)
    return pcm(sound + np.random.default_rng(1).normal(0, noise, len(sound)))
