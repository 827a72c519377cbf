"""Camera states reported for single pictures, and during ten minutes of live video.

Run by hand: `python -m tests.bench.cameras [--tune] [--minutes N]`. Rooms are drawn (see
`tests.hw.pictures`), the two photographs ship with scikit-learn; each is seen in good and bad
light, noisy, compressed, moved, blurred, dark and covered. The limits of `camera_state` were set
with `--tune`; quoted figures use rooms of other seeds and the other photograph. The video is
measured picture by picture on its own clock: slow pans, a still room, lights that are dimmed
and come back; any state but OK is a false alarm.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from collections.abc import Iterator

import cv2
import numpy as np
from sklearn.datasets import load_sample_images

from tangy_hw.drivers.camera_look import measure
from tangy_hw.drivers.camera_state import CameraWatch, Sight
from tests.hw.pictures import Image, room, seen

TUNED, QUOTED = range(20), range(5_000, 5_040)
PHOTOS = {"tuned": 0, "quoted": 1}
RATE = 10  # pictures per second

WELL: dict[str, dict[str, float]] = {
    "good light": {},
    "noisy": {"noise": 8},
    "JPEG 50": {"quality": 50},
    "dim": {"light": 0.4, "noise": 5},
    "a little soft": {"blur": 1.0},
}
ILL: dict[str, tuple[str, dict[str, float]]] = {
    "out of focus, 4 px": ("BLURRED", {"blur": 4}),
    "out of focus, 8 px": ("BLURRED", {"blur": 8, "noise": 6}),
    "greasy, dim, 12 px": ("BLURRED", {"blur": 12, "light": 0.5, "noise": 6}),
    "light nearly out": ("DARK", {"light": 0.12, "noise": 2}),
    "scarf": ("COVERED", {"light": 0.03, "blur": 30, "noise": 4}),
    "hand": ("COVERED", {"light": 0.2, "blur": 90, "noise": 4}),
    "napkin": ("COVERED", {"light": 1.1, "blur": 500, "noise": 3}),
}


def judged(image: Image) -> Sight:
    """Return the state of one picture by itself."""
    watch = CameraWatch(0.0, each=True)
    watch.saw(measure(image, 0, 0.0))
    return watch.at(0.0)


def moved(image: Image, pixels: int) -> Image:
    """Return a picture smeared by movement during the exposure."""
    kernel = np.full((1, pixels), 1 / pixels, np.float32)
    return np.asarray(cv2.filter2D(image, -1, kernel), np.uint8)


def table(pictures: list[Image]) -> None:
    """Print how many pictures of each kind get each state."""
    print(f"{'':22}{'is':>9}{'named so':>10}   sharpness        brightness   contrast")
    kinds = [(name, "OK", how) for name, how in WELL.items()]
    kinds += [(name, state, how) for name, (state, how) in ILL.items()]
    for name, state, how in [*kinds, ("moved, 15 px", "OK", {"moved": 15.0})]:
        rng = np.random.default_rng(7)
        told: Counter[str] = Counter()
        found = []
        for image in pictures:
            smeared = moved(image, int(how["moved"])) if "moved" in how else image
            quality = int(how["quality"]) if "quality" in how else None
            rest = {key: value for key, value in how.items() if key in ("light", "blur", "noise")}
            sight = judged(seen(smeared, rng, quality=quality, **rest))
            told[sight.state] += 1
            found.append((sight.sharpness or 0.0, sight.brightness or 0.0, sight.contrast or 0.0))
        low, high = np.min(found, axis=0), np.max(found, axis=0)
        wrong = {key: count for key, count in told.items() if key != state}
        ranges = "  ".join(f"{a:.3f}-{b:.3f}" for a, b in zip(low, high, strict=True))
        print(f"{name:22}{state:>9}{told[state] / len(pictures):>10.0%}   {ranges}  {wrong or ''}")


def video(minutes: float, seed: int, size: tuple[int, int] = (640, 360)) -> Iterator[Image]:
    """Film rooms, a minute each: a slow pan, a still room, lights dimmed to 30% and back."""
    width, height = size
    rng = np.random.default_rng(seed)
    for number in range(int(minutes * 60 * RATE)):
        at, minute = number % (60 * RATE), number // (60 * RATE)
        if at == 0:
            wide = np.hstack([room(seed + 2 * minute + k, width, height) for k in (0, 1)])
        share = at / (60 * RATE)
        kind = ("pan", "still", "dimmed")[minute % 3]
        left = int((0.5 - 0.5 * np.cos(4 * np.pi * share)) * width) if kind == "pan" else 0
        light = 0.65 + 0.35 * np.cos(4 * np.pi * share) if kind == "dimmed" else 1.0
        part = np.ascontiguousarray(wide[:, left : left + width])
        yield seen(moved(part, 5) if kind == "pan" else part, rng, light=float(light), noise=2.0)


def alarms(frames: Iterator[Image]) -> tuple[Counter[str], int]:
    """Count the changes to any state but OK over a video, and its pictures."""
    watch, told, was, count = CameraWatch(0.0), Counter[str](), "OK", 0
    for count, image in enumerate(frames, 1):
        now = count / RATE
        watch.saw(measure(image, count, now))
        state = watch.at(now + 0.05).state
        if state != was and state != "OK":
            told[state] += 1
        was = state
    return told, count


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tune", action="store_true", help="the pictures that limits are set on")
    parser.add_argument("--minutes", type=float, default=10.0, help="of video")
    asked = parser.parse_args()
    cv2.setNumThreads(1)
    which = "tuned" if asked.tune else "quoted"
    photo = cv2.cvtColor(load_sample_images().images[PHOTOS[which]], cv2.COLOR_RGB2BGR)
    photo = cv2.resize(photo[:360], (1280, 720))
    seeds = TUNED if asked.tune else QUOTED
    pictures = [np.asarray(photo, np.uint8), *(room(seed) for seed in seeds)]
    began = time.process_time()
    for image in pictures:
        measure(image, 0, 0.0)
    spent = (time.process_time() - began) / len(pictures) * 1000
    print(f"{which}: {len(pictures)} pictures, {spent:.1f} ms of CPU to measure one\n")
    table(pictures)
    told, count = alarms(video(asked.minutes, seeds[0]))
    print(f"\n{asked.minutes:g} min of video, {count} pictures: false alarms {dict(told) or 0}")


if __name__ == "__main__":
    main()
