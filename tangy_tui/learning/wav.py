"""WAV files, by the name they had before they moved to the sound of the real world."""

from __future__ import annotations

from tangy_hw.sound.wav import LARGEST_WAV, RATE, SoundError, decode_wav, read_header, read_wav

__all__ = ["LARGEST_WAV", "RATE", "SoundError", "decode_wav", "read_header", "read_wav"]
