"""How long a WAV file is."""

from __future__ import annotations

import wave
from pathlib import Path


def wav_seconds(path: Path) -> float:
    """Return how long a WAV file is, in s; 0 if it is none that can be played."""
    try:
        with wave.open(str(path)) as file:
            return float(file.getnframes() / file.getframerate())
    except (OSError, EOFError, wave.Error, ZeroDivisionError):
        return 0.0
