"""How many spoken sentences that stop the robot are obeyed, and how many others stop it.

Run by hand: `python -m tests.bench.spoken_stops` (needs flite, festival and espeak-ng). Figures are
quoted on the sentences of `stop_fresh.toml`, which had set no limit and trained no model then.
`stop_development.toml` may choose limits and texts; the first half of each of its lists was looked
at, the second only counted (`--half`). `--text` decodes nothing. `--set` can also be one of the
sets of `stop_sentences.toml`, with models trained on the others alone; the rules of `stop_sentence`
know all of them but `unseen`. Some of the voices say each sentence, in turn. White noise, or the
babble of other voices, is added to whole sentences. Other talk has no request, or another request,
and holds no word of stopping. Everything goes through the real decoder. A synthetic voice is not a
person; those of espeak are the hardest to hear.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import subprocess
import tempfile
import time
import tomllib
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tangy_hw.audio.wav import RATE, read_wav
from tangy_tui.language.intent_training import train
from tangy_tui.language.stop_likelihood import use_model
from tangy_tui.language.stop_phrases import other_stop_texts, stop_sets, stop_texts
from tangy_tui.language.stop_sentence import stops as is_stop
from tangy_tui.learning.verification import StopCommand
from tangy_tui.speech.decoder import make_decoder
from tangy_tui.speech.evidence import USUAL
from tangy_tui.speech.understanding import understand, wanted
from tests.bench.sentences import FAR, NEAR, WORDINGS
from tests.bench.speech import BOOK
from tests.bench.stop_training import stop_examples

HERE = Path(__file__).parent
FILES = {
    "fresh": "stop_fresh.toml",
    "held": "stop_held.toml",
    "held-second": "stop_held_second.toml",
    "development": "stop_development.toml",
}
FESTIVAL = {"kal_diphone": "kal_diphone", "slt_hts": "cmu_us_slt_arctic_hts"}
VOICES = (
    *("slt", "rms", "awb", "kal", *FESTIVAL, "en-gb", "en-gb+m3", "en-us+f2"),
    *("en-gb-scotland+m1", "en-gb-x-rp+f4", "en-us+m7 -p 35 -s 150", "en-us+f3 -s 145"),
    "en-gb+f1 -p 60 -s 160",
)
"""Voices of flite and festival; then of espeak-ng, with pitch and speed."""
HISS = 8.0  # of 32,768: the noise of a clean microphone
QUIET = round(0.25 * RATE)  # samples before and after a sentence
TALK = 60  # sentences of other talk
BABBLE = 5  # voices at once


class Said(NamedTuple):
    """A sentence of a kind (stops, others, talk) by a voice."""

    kind: str
    text: str
    voice: str


def sayings(read: Mapping[str, Sequence[str]], voices: int) -> Iterator[Said]:
    """Yield the utterances: each sentence of a set by several voices, other talk by one."""
    for kind in ("stops", "others"):
        for place, text in enumerate(read[kind]):
            for number in range(voices):
                yield Said(kind, text, VOICES[(place + 5 * number) % len(VOICES)])
    known = [text for texts in (FAR, NEAR, list(WORDINGS)) for text in texts]
    talk = read.get("talk") or known[:: max(1, len(known) // TALK)]
    for place, text in enumerate(talk):
        yield Said("talk", text, VOICES[place % len(VOICES)])


class Voices:
    """Synthesises each sentence once by each voice, in a folder."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def say(self, said: Sequence[Said]) -> None:
        """Synthesise everything."""
        for voice in FESTIVAL:
            script = [f"(voice_{FESTIVAL[voice]})"]
            for one in said:
                if one.voice == voice:
                    said_by = f'(utt.synth (Utterance Text "{one.text}"))'
                    script.append(f'(utt.save.wave {said_by} "{self._path(one)}" \'riff)')
            lines = self._folder / f"{voice}.scm"
            lines.write_text("\n".join(script))
            subprocess.run(["festival", "-b", str(lines)], check=True)  # noqa: S603, S607
        for one in said:
            if one.voice not in FESTIVAL:
                voice, *options = one.voice.split()
                program = (
                    ["espeak-ng", "-v", voice, *options, "-w", str(self._path(one)), one.text]
                    if "-" in voice
                    else ["flite", "-voice", voice, "-t", one.text, "-o", str(self._path(one))]
                )
                subprocess.run(program, check=True, capture_output=True)  # noqa: S603

    def samples(self, one: Said) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        """Return a sentence, 16 kHz."""
        return np.frombuffer(read_wav(self._path(one)), "<i2").astype(np.float64)

    def heard(self, one: Said, noise: str, others: Sequence[Said]) -> bytes:
        """Return a sentence as a microphone records it; `noise` is clean, dB, or b and dB."""
        sound = self.samples(one)
        chance = np.random.default_rng(len(sound))
        level = float(np.sqrt(np.mean(sound**2)))
        sound = np.pad(sound, QUIET)
        if noise == "clean":
            added = chance.normal(0, HISS, len(sound))
        elif noise.startswith("b"):
            picked = chance.choice(len(others), BABBLE, replace=False)
            added = sum(
                (np.resize(self.samples(others[n]), len(sound)) for n in picked),
                np.zeros(len(sound)),
            )
            added *= level * 10 ** (-float(noise[1:]) / 20) / np.sqrt(np.mean(added**2))
        else:
            added = chance.normal(0, level * 10 ** (-float(noise) / 20), len(sound))
        return np.clip(sound + added, -32768, 32767).astype("<i2").tobytes()

    def _path(self, one: Said) -> Path:
        name = hashlib.sha256(f"{one.voice} {one.text}".encode()).hexdigest()
        return self._folder / f"{name}.wav"


def count_texts(said: Sequence[Said], *, show: bool = False) -> None:
    """Print how many of these sentences stop the robot as text."""
    for one in said:
        if show and is_stop(one.text, BOOK.game) != (one.kind == "stops"):
            print(f"  text, {one.kind}: {one.text}")
    of = Counter(one.kind for one in said)
    stopped = Counter(one.kind for one in said if is_stop(one.text, BOOK.game))
    print("text:", *(f"{kind} {stopped[kind]} of {of[kind]}" for kind in sorted(of)))


def main() -> None:
    """Print the table."""
    options = argparse.ArgumentParser(description="Count spoken stops.")
    options.add_argument("--set", default="fresh", choices=(*FILES, *stop_sets()))
    options.add_argument("--half", type=int, choices=(0, 1), help="every second sentence")
    options.add_argument("--text", action="store_true", help="count the texts alone")
    options.add_argument("--voices", type=int, default=1, help="of each sentence")
    options.add_argument("--every", type=int, default=1, help="take every so many sentences alone")
    options.add_argument("--noises", nargs="*", default=("clean", "20", "10", "b10"))
    options.add_argument("--show", action="store_true", help="list what went wrong")
    chosen = options.parse_args()
    if chosen.set in FILES:
        read: Mapping[str, Any] = tomllib.loads((HERE / FILES[chosen.set]).read_text("utf-8"))
    else:
        read = stop_sets()[chosen.set]
        use_model(train(stop_examples(chosen.set)))
    if chosen.half is not None:
        read = {kind: texts[chosen.half :: 2] for kind, texts in read.items()}
    said = list(sayings(read, chosen.voices))[:: chosen.every]
    count_texts(said, show=chosen.show)
    if chosen.text:
        return
    listened = wanted(BOOK, USUAL)
    texts = stop_texts(chosen.set)
    other_texts = (*other_stop_texts(chosen.set), *listened.no_stops[len(other_stop_texts()) :])
    decoder = make_decoder(replace(listened, stops=texts, no_stops=other_texts))
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # the grammar's unfinished paths are printed there
    with tempfile.TemporaryDirectory() as folder:
        voices = Voices(Path(folder))
        voices.say(said)
        others = [one for one in said if one.kind == "talk"]
        for noise in chosen.noises:
            stopped, of, seconds = Counter[str](), Counter[str](), 0.0
            begun = time.process_time()
            for one in said:
                pcm = voices.heard(one, noise, others)
                evidence = decoder.decode(pcm, "commands")
                stops = isinstance(understand(evidence, BOOK, USUAL), StopCommand)
                family = "espeak" if "-" in one.voice else "flite, festival"
                for name in (one.kind, f"{one.kind} of {family}"):
                    of[name] += 1
                    stopped[name] += stops
                seconds += len(pcm) / 2 / RATE if one.kind == "talk" else 0.0
                if chosen.show and stops != (one.kind == "stops"):
                    print(f"  {one.kind} {one.voice}: {one.text!r} {evidence.words!r}")
            took = (time.process_time() - begun) / len(said)
            print(f"{noise}: {took:.2f} s CPU of one process, {seconds / 60:.1f} min of other talk")
            for name in sorted(of):
                print(f"  {name:28}{stopped[name]:4} of {of[name]}", flush=True)
    decoder.close()


if __name__ == "__main__":
    main()
