"""Synthetic voices and noises for the tests of speech, made once in a test run."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from tangy_hw.audio.wav import RATE, read_wav

FESTIVAL = "kal_diphone"
NOISES = {  # made by sox without an input
    "a tone": "synth 2 sine 440 vol 0.4",
    "a hum": "synth 2 sine 100 sine 200 sine 300 vol 0.5",
    "claps": "synth 0.06 whitenoise fade l 0 0.06 0.05 vol 0.7 pad 0.3 0.3 repeat 3",
    "knocks": "synth 0.08 sine 120 fade l 0 0.08 0.07 vol 0.9 pad 0.2 0.2 repeat 4",
    "hiss": "synth 3 whitenoise vol 0.05",
    "a siren": "synth 2 sine 300-1500 vol 0.4",
}


class Voices:
    """Speaks as flite's or festival's voices; each sound is made once."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def file(self, text: str, voice: str = "slt") -> Path:
        """Return a WAV file of a sentence."""
        path = self.folder / f"{text.replace(' ', '-')}.{voice}.wav"
        if not path.exists():
            if voice == FESTIVAL:
                command = ["text2wave", "-eval", f"(voice_{voice})", "-o", str(path)]
                program = "text2wave"
            else:
                command = ["flite", "-voice", voice, "-t", text, "-o", str(path)]
                program = "flite"
            if shutil.which(program) is None:
                pytest.skip(f"{program} is not installed: nobody to speak the commands")
            subprocess.run(command, input=text.encode(), check=True, capture_output=True)  # noqa: S603
        return path

    def say(self, text: str, voice: str = "slt", *, noise: float = 60.0) -> bytes:
        """Return 16 kHz mono s16le, with the noise of a room this many dB below it."""
        return room(read_wav(self.file(text, voice)), noise)

    def noise(self, name: str) -> bytes:
        """Return one of NOISES."""
        path = self.folder / f"{name.replace(' ', '-')}.wav"
        if not path.exists():
            if shutil.which("sox") is None:
                pytest.skip("sox is not installed: nothing to make noises with")
            form = ["-n", "-R", "-r", str(RATE), "-b", "16", "-c", "1"]
            command = ["sox", *form, str(path), *NOISES[name].split()]
            subprocess.run(command, check=True, capture_output=True)  # noqa: S603
        sound: bytes = read_wav(path)
        return sound


def room(pcm: bytes, below: float) -> bytes:
    """Put a sound into a room: half a second around it, and white noise this many dB below it."""
    said = np.frombuffer(pcm, "<i2").astype(np.float64)
    quiet = np.zeros(RATE // 2)
    samples = np.concatenate([quiet, said, quiet])
    level = np.sqrt((said**2).mean()) * 10 ** (-below / 20)
    samples += np.random.default_rng(len(pcm)).normal(0, level, len(samples))
    made: bytes = np.clip(np.rint(samples), -32_768, 32_767).astype("<i2").tobytes()
    return made
