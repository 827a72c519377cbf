"""The duration of a WAV file."""

from __future__ import annotations

import wave
from pathlib import Path


def wav_seconds(path: Path) -> float:
    """Return the duration of a WAV file, in s; 0 if it is invalid."""
    try:
        with wave.open(str(path)) as file:
            return float(file.getnframes() / file.getframerate())
    except (OSError, EOFError, RuntimeError, wave.Error, ZeroDivisionError):
        return 0.0
