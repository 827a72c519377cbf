"""Small pictures and sounds for tests."""

from __future__ import annotations

import shutil
import wave
from pathlib import Path

import cv2
import numpy as np

RATE = 8_000


def make_sound(path: Path, seconds: float = 2.0) -> Path:
    """Write a WAV file with this many s of silence."""
    with wave.open(str(path), "wb") as file:
        file.setparams((1, 2, RATE, 0, "NONE", ""))
        file.writeframes(bytes(2 * round(RATE * seconds)))
    return path


def make_picture(path: Path, high: int = 60, wide: int = 40) -> Path:
    """Write a picture in one strong colour (red), its size in px."""
    cv2.imwrite(str(path), np.full((high, wide, 3), (0, 0, 220), np.uint8))
    return path


def guess_the_sound(folder: Path) -> Path:
    """Write an activity with pictures and sounds into a folder; return its file."""
    own = Path(__file__).parent / "activities" / "guess-the-sound.toml"
    for file in (own, own.with_suffix(".csv")):
        shutil.copy(file, folder)
    for line in own.with_suffix(".csv").read_text(encoding="utf-8").splitlines()[1:]:
        clip, *_, photo = line.split(",")
        make_sound(folder / clip)
        if photo:
            make_picture(folder / photo)
    return folder / own.name
