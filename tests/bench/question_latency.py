"""Delay from the key to the understood command, which is when Tangy asks its question.

Run by hand: `python -m tests.bench.question_latency [--times N]` on an idle machine; needs
flite and festival. Each sentence arrives as it is spoken, in pieces of 40 ms; the key
that ends it is pressed with the last word, or some time after. The load is printed with the times.
"""

from __future__ import annotations

import argparse
import asyncio
import math
import os
import statistics
import tempfile
from itertools import product
from pathlib import Path
from time import perf_counter

import numpy as np

from tangy_hw.audio.wav import RATE
from tangy_profiles.activity import load_activity
from tangy_profiles.person import load_people
from tangy_profiles.room import load_room
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.intents import Intents
from tangy_tui.speech.evidence import USUAL
from tangy_tui.speech.recogniser import Recogniser
from tangy_tui.speech.understanding import understand, wanted
from tests.bench.spoken_stops import QUIET, Said, Voices

BOOK = Phrasebook(load_activity("bingo"), load_room().placed(load_people(4)), Intents().model)
SENTENCES = {
    "phrases": (
        *("call the next number", "greet everyone", "tell a joke", "go to user two"),
        "ask to move the card closer",
    ),
    "other sentences": (
        *("would you read out another number please", "make them laugh a little"),
        *("say something kind to berta", "i think he could use some help with his card"),
    ),
}
VOICES = ("slt", "rms", "awb", "kal_diphone")
AFTER = (0.0, 0.3, 0.6)  # s from the last word to the key
PIECE = 2 * round(0.04 * RATE)  # bytes


async def press(recogniser: Recogniser, pcm: bytes, after: float) -> float:
    """Feed a sentence, press the key some s after it; return the s until it is understood."""
    sound: asyncio.Queue[bytes] = asyncio.Queue()
    hearing = asyncio.create_task(recogniser.hear(sound))
    hiss = np.random.default_rng(0).normal(0, 8, round(after * RATE)).astype("<i2").tobytes()
    whole = pcm + hiss
    begun = perf_counter()
    for place in range(0, len(whole), PIECE):
        sound.put_nowait(whole[place : place + PIECE])
        due = begun + (place + PIECE) / 2 / RATE
        await asyncio.sleep(max(0.0, due - perf_counter()))
    pressed = perf_counter()
    sound.put_nowait(b"")
    understand(await hearing, BOOK, USUAL)
    return perf_counter() - pressed


async def measure(times: int) -> None:
    """Print median, 95th percentile and longest time, of phrases and of other sentences."""
    recogniser = Recogniser()
    await recogniser.start(wanted(BOOK, USUAL))
    said = {
        kind: [Said("", text, voice) for text in texts for voice in VOICES]
        for kind, texts in SENTENCES.items()
    }
    with tempfile.TemporaryDirectory() as folder:
        voices = Voices(Path(folder))
        voices.say([one for every in said.values() for one in every])
        sounds = {
            kind: [voices.heard(one, "clean", ())[: -2 * QUIET] for one in every]
            for kind, every in said.items()
        }
    for every in sounds.values():  # load the models
        await press(recogniser, every[0], 0.0)
    for after, kind in product(AFTER, sounds):
        found = sorted([await press(recogniser, pcm, after) for pcm in sounds[kind] * times])
        late = found[math.ceil(0.95 * len(found)) - 1]
        print(
            f"{kind}, {after:.1f} s after the last word, n {len(found)}: median "
            f"{1000 * statistics.median(found):.0f} ms, p95 {1000 * late:.0f} ms, longest "
            f"{1000 * found[-1]:.0f} ms; load {os.getloadavg()[0]:.1f}",
            flush=True,
        )
    await recogniser.close()


def main() -> None:
    """Measure."""
    options = argparse.ArgumentParser(description="Measure the time from the key to the question.")
    options.add_argument("--times", type=int, default=1)
    asyncio.run(measure(options.parse_args().times))


if __name__ == "__main__":
    main()
