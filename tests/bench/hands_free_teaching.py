"""A whole guided game of Bingo, taught by voice alone, without a key or a typed line.

Run by hand: `python -m tests.bench.hands_free_teaching` (needs flite). A synthetic teacher says
the activity's next expected command, half of them in unlisted wordings, sometimes the
wrong thing, which it denies when Tangy asks, or takes back after it said yes. A sentence that
was not understood is repeated in the listed words. The sound goes through the real decoder,
hands-free. The minutes are those of the sound, with a second of quiet after each sentence, and
of waiting for Tangy. The paper's teachers took 9.6 minutes for a demonstration.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import random
import subprocess
import tempfile
import threading
import time
from collections import Counter
from contextlib import closing
from pathlib import Path

import numpy as np

from tangy_hw.audio.wav import RATE, read_wav
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.teaching import TeachingLines
from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import Asked, Offered, Say
from tangy_tui.speech.input import SpeechInput
from tests.bench.sentences import WORDINGS

PAPER_MINUTES = 9.6
VOICES = ("slt", "rms", "awb")
IN_OTHER_WORDS = 0.5
ERRS = 0.08
YES = ("yes", "yes please", "yeah that's right", "correct", "go ahead")
NO = ("no", "no that's wrong", "nope", "no thank you")
UNDO = ("take that back", "undo that", "undo")
QUIET = 1.0  # s after a sentence
PATIENCE = 20.0  # s until a sentence counts as without effect
MOST = 400  # sentences


class Teacher:
    """Says the next expected command aloud, in a synthetic voice."""

    def __init__(self, teaching: TeachingSession, seed: int) -> None:
        self._teaching = teaching
        self._expected = ScriptedTeacher(teaching)
        self._chance = random.Random(seed)
        self._plain = False
        self.errs = False
        """Whether the teacher is to take back the last step."""
        self._meant = ""
        self.counts = Counter[str]()

    def says(self) -> str:
        """Return the next sentence."""
        question = self._teaching.question
        if isinstance(question, Asked):
            return self._answer(question)
        if isinstance(question, Offered):
            return self._choice(question)
        if self.errs:
            return self._chance.choice(UNDO)
        return self._command()

    def _command(self) -> str:
        said = self._expected.command()
        assert isinstance(said, Say)
        command = self._teaching.phrasebook.understand(said.text)
        assert command is not None
        self._meant = command.behaviour
        if not self._plain and self._chance.random() < ERRS:
            self.counts["slips"] += 1
            wrong = [b for b in self._teaching.activity.behaviours.values()
                     if b.name != self._meant and not b.attends]  # fmt: skip
            return self._chance.choice(wrong).phrases[0]
        others = [text for text, meant in list(WORDINGS.items())[1::2] if meant == self._meant]
        if others and not self._plain and self._chance.random() < IN_OTHER_WORDS:
            self.counts["other words"] += 1
            return self._chance.choice(others)
        return said.text

    def _answer(self, question: Asked) -> str:
        if question.behaviour == self._meant or self._chance.random() < ERRS:
            return self._chance.choice(YES)
        return self._chance.choice(NO)

    def _choice(self, question: Offered) -> str:
        if self._meant in question.alternatives:
            return f"number {('one', 'two', 'three')[question.alternatives.index(self._meant)]}"
        return self._chance.choice(NO)

    def sees(self, before: object, steps: int) -> None:
        """Take note of the effect of the last sentence: the question `before`, and the `steps`."""
        question, shown = self._teaching.question, self._teaching.demonstration.steps
        if isinstance(before, Asked) and len(shown) > steps:
            self.errs = before.behaviour != self._meant
            self.counts["mistakes to take back"] += self.errs
            self._plain = False
            return
        if self.errs and len(shown) < steps:
            self.errs = False
            self.counts["taken back"] += 1
            return
        if question is before:
            self.counts["said again"] += 1
        if question is None:
            self._plain = True


def voiced(text: str, voice: str, folder: Path) -> bytes:
    """Have a voice say a sentence; return 16 kHz mono s16le."""
    path = folder / f"{voice}-{text}.wav"
    if not path.exists():
        subprocess.run(["flite", "-voice", voice, "-t", text, "-o", str(path)], check=True)  # noqa: S603, S607
    return read_wav(path)


async def teach(folder: Path, voice: str, seed: int, *, show: bool) -> None:
    """Teach one game, and print the effort."""
    sound_from, sound_to = os.pipe()
    over = threading.Event()
    with closing(Workspace(folder / f"data-{voice}-{seed}")) as workspace:
        teaching = workspace.teaching("synthetic", seed, guided=True)
        ears = SpeechInput(
            "-", teaching.phrasebook, hands_free=True, answers=True, stdin=sound_from
        )
        told: list[str] = []

        def read() -> None:
            over.wait()  # nobody types

        lines = TeachingLines(teaching, read, told.append, ears)
        running = asyncio.create_task(lines.run(resume=False))
        teacher, said, waited, spoken = Teacher(teaching, seed), 0, 0.0, 0.0
        chance = np.random.default_rng(seed)
        await until(lambda: ears.state == "listening", 4 * PATIENCE)  # the game has begun, too
        while (
            (teacher.errs or not teaching.demonstration.finished)
            and said < MOST
            and not running.done()
        ):
            await until(lambda: ears.state == "listening")
            text, seen = teacher.says(), len(told)
            before, steps = teaching.question, len(teaching.demonstration.steps)
            pcm = voiced(text, voice, folder)
            noise = chance.normal(0, 8, round(QUIET * RATE)).astype("<i2").tobytes()
            said, spoken = said + 1, spoken + len(pcm + noise) / 2 / RATE
            begun = time.monotonic()
            await asyncio.to_thread(_write, sound_to, noise[:8000] + pcm + noise)
            heard = await until(lambda seen=seen: len(told) > seen)
            waited += time.monotonic() - begun
            teacher.counts["nothing came"] += not heard
            if show:
                print(f"  {text!r}: {told[seen:]}")
            teacher.sees(before, steps)
        over.set()
        os.close(sound_to)
        await running
        complete = teaching.demonstration.finished
        print(
            f"{voice:4} game {seed}: {'complete' if complete else 'NOT complete'}, "
            f"{len(teaching.demonstration.steps)} steps, {said} sentences, "
            f"{(spoken + waited) / 60:.1f} min ({waited / 60:.1f} of them waiting; paper "
            f"{PAPER_MINUTES}), {dict(teacher.counts)}",
            flush=True,
        )


def _write(pipe: int, pcm: bytes) -> None:
    while pcm:
        pcm = pcm[os.write(pipe, pcm) :]


async def until(true: object, seconds: float = PATIENCE) -> bool:
    """Wait until a condition is true; return whether it became true in time."""
    assert callable(true)
    end = time.monotonic() + seconds
    while not true():
        if time.monotonic() > end:
            return False
        await asyncio.sleep(0.02)  # a bench, not a test: it waits for another process
    return True


def main() -> None:
    """Teach the games."""
    options = argparse.ArgumentParser(description="Teach a guided game by voice alone.")
    options.add_argument("--games", type=int, default=1, help="with each voice")
    options.add_argument("--voices", nargs="*", default=VOICES)
    options.add_argument("--show", action="store_true", help="show each sentence")
    chosen = options.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        for voice in chosen.voices:
            for seed in range(1, chosen.games + 1):
                asyncio.run(teach(Path(temporary), voice, seed, show=chosen.show))


if __name__ == "__main__":
    main()
