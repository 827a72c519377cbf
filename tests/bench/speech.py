"""How well spoken commands are understood, and which other sounds are taken for one.

Run by hand: `python -m tests.bench.speech` (needs flite and festival). Voices of both say all
phrases of the activity, other wordings, and other speech (see `sentences`); coughs, claps,
knocks and tones are synthesised. White noise is added to whole utterances. Everything goes through
the real decoder, as whole utterances.

`--fit` prints the weights and shows the limits of `understanding`, from the voices of TUNED and
every second sentence. Without it, the voices of QUOTED (other speakers) and the other sentences are
counted. `--paper` counts the paper's mode instead, and `--answers` spoken answers: which answers
and which other sounds count as yes or no. A synthetic voice is not a person: take the
differences seriously, not the last per cent.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tangy_hw.audio.wav import RATE, read_wav
from tangy_profiles.activity import load_activity
from tangy_profiles.person import load_people
from tangy_profiles.room import load_room
from tangy_tui.language.answers import NO, YES, yes_or_no
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.stop_sentence import stops
from tangy_tui.learning.verification import Reply, Say
from tangy_tui.speech import understanding
from tangy_tui.speech.decoder import Decoder, make_decoder
from tangy_tui.speech.evidence import AcousticEvidence, EvidenceSettings, Expecting
from tangy_tui.speech.recogniser import Recogniser
from tangy_tui.speech.transcription import tier_of
from tests.bench.sentences import FAR, NEAR, WORDINGS

Samples: TypeAlias = NDArray[np.float64]
Job: TypeAlias = tuple[str, str, str, str]  # kind, voice, text, condition

FESTIVAL = {"ked": "ked_diphone", "kal": "kal_diphone", "slt_hts": "cmu_us_slt_arctic_hts"}
TUNED = ("rms", "awb", "ked")
QUOTED = ("slt", "slt_hts", "kal16", "kal")
CONDITIONS = ("clean", "20", "10")  # dB of white noise below the voice
FITTED = CONDITIONS[:2]  # at 10 dB there are many errors to which a fit would adapt
HISS = 8.0  # of 32,768: the noise of a clean microphone
NOISES = 100
SPEAKS = 0.25  # s of quiet before and after an utterance

BOOK = Phrasebook(load_activity("bingo"), load_room().placed(load_people(4)))


def meaning(kind: str, text: str) -> tuple[str, dict[str, str]] | None:
    """Return an utterance's command; of other wordings only the behaviour counts."""
    if kind == "wording":
        return WORDINGS[text], {}
    if kind != "phrase":
        return None
    if stops(text):
        return "stop", {}
    command = BOOK.understand(text)
    assert command is not None
    return command.behaviour, dict(command.arguments)


def right(kind: str, text: str, behaviour: str, arguments: dict[str, str]) -> bool:
    """Return whether an utterance was understood correctly."""
    wanted = meaning(kind, text)
    if wanted is None or wanted[0] != behaviour:
        return False
    return kind == "wording" or wanted[1] == arguments


# ----------------------------------------------------------------------------------- the sounds


def say(voice: str, texts: Iterable[str], folder: Path) -> None:
    """Have a voice say sentences; each goes to its own file."""
    new = [text for text in texts if not (folder / f"{voice}-{text}.wav").exists()]
    if voice in FESTIVAL:
        script = [f"(voice_{FESTIVAL[voice]})"]
        for text in new:
            path = folder / f"{voice}-{text}.wav"
            script.append(f'(utt.save.wave (utt.synth (Utterance Text "{text}")) "{path}" \'riff)')
        lines = folder / f"{voice}.scm"
        lines.write_text("\n".join(script))
        subprocess.run(["festival", "-b", str(lines)], check=True)  # noqa: S603, S607
        return
    for text in new:
        path = folder / f"{voice}-{text}.wav"
        subprocess.run(  # noqa: S603 - a synthesiser and our own sentences
            ["flite", "-voice", voice, "-t", text, "-o", str(path)],  # noqa: S607
            check=True,
            stderr=subprocess.DEVNULL,
        )


def heard(path: Path, condition: str) -> bytes:
    """Return an utterance as a microphone records it, with noise this many dB below the voice."""
    samples = np.frombuffer(read_wav(path), "<i2").astype(np.float64)
    chance = np.random.default_rng(len(samples))
    level = HISS
    if condition != "clean":
        level = float(np.mean(samples**2) / 10 ** (float(condition) / 10)) ** 0.5
    samples = np.pad(samples, round(SPEAKS * RATE))
    return _pcm(samples + level * chance.normal(size=len(samples)))


def noises(seed: int, count: int) -> list[bytes]:
    """Synthesise coughs, claps, knocks and tones."""
    chance = np.random.default_rng(seed)
    kinds = (_cough, _clap, _knock, _tone)
    return [kinds[number % len(kinds)](chance) for number in range(count)]


def _cough(chance: np.random.Generator) -> bytes:
    def one() -> Samples:
        length = round(RATE * chance.uniform(0.15, 0.4))
        t = np.arange(length) / RATE
        voiced = 0.5 * np.sign(np.sin(2 * np.pi * chance.uniform(90, 220) * t))
        hiss = _band(chance, length, 300, chance.uniform(2000, 6000))
        return (hiss + voiced) * _fall(length, 0.01, chance.uniform(0.05, 0.15)) * 6000

    return _placed(chance, [one() for _ in range(chance.integers(1, 4))], 0.25, 0.45)


def _clap(chance: np.random.Generator) -> bytes:
    def one() -> Samples:
        fall = _fall(1600, 0.001, chance.uniform(0.005, 0.02))
        return _band(chance, 1600, 800, 7000) * fall * chance.uniform(5000, 15000)

    return _placed(chance, [one() for _ in range(chance.integers(1, 6))], 0.15, 0.5)


def _knock(chance: np.random.Generator) -> bytes:
    def one() -> Samples:
        t = np.arange(2400) / RATE
        body = np.sin(2 * np.pi * chance.uniform(100, 400) * t) * _fall(2400, 0.001, 0.03) * 12000
        return body + _band(chance, 2400, 100, 1500) * _fall(2400, 0.001, 0.01) * 4000

    return _placed(chance, [one() for _ in range(chance.integers(1, 5))], 0.15, 0.4)


def _tone(chance: np.random.Generator) -> bytes:
    t = np.arange(round(RATE * chance.uniform(0.2, 2))) / RATE
    glide = chance.uniform(200, 3000) * (1 + chance.uniform(-0.2, 0.2) * t)
    return _placed(chance, [np.sin(2 * np.pi * glide * t) * chance.uniform(1000, 12000)], 0.3, 0.4)


def _fall(length: int, rise: float, fall: float) -> Samples:
    t = np.arange(length) / RATE
    shape: Samples = np.minimum(1, t / rise) * np.exp(-t / fall)
    return shape


def _band(chance: np.random.Generator, length: int, low: float, high: float) -> Samples:
    spectrum = np.fft.rfft(chance.normal(size=length))
    frequencies = np.fft.rfftfreq(length, 1 / RATE)
    spectrum[(frequencies < low) | (frequencies > high)] = 0
    made = np.fft.irfft(spectrum, length)
    return made / np.std(made)


def _placed(
    chance: np.random.Generator, sounds: Sequence[Samples], least: float, most: float
) -> bytes:
    """Place sounds in turn in a quiet room."""
    at, places = 0.3, []
    for sound in sounds:
        places.append((round(at * RATE), sound))
        at += max(chance.uniform(least, most), len(sound) / RATE * 0.5)
    length = max(place + len(sound) for place, sound in places) + round(0.5 * RATE)
    room = chance.normal(size=length) * HISS
    for place, sound in places:
        room[place : place + len(sound)] += sound
    return _pcm(room)


def _pcm(samples: Samples) -> bytes:
    return np.clip(samples, -32_768, 32_767).astype("<i2").tobytes()


# -------------------------------------------------------------------------------- the utterances

_decoder: Decoder | None = None
_settings = EvidenceSettings()


def _prepare(settings: EvidenceSettings) -> None:
    global _decoder, _settings
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # the grammar's unfinished paths are printed there
    _settings = settings
    _decoder = make_decoder(understanding.wanted(BOOK, settings))


def _decode(sound: tuple[str, str] | bytes, expecting: Expecting = "commands") -> AcousticEvidence:
    assert _decoder is not None
    pcm = sound if isinstance(sound, bytes) else heard(Path(sound[0]), sound[1])
    return _decoder.decode(pcm, expecting)


def texts(half: int) -> list[tuple[str, str]]:
    """Return kind and text of the utterances; of other sentences every second (half 0 or 1)."""
    return [
        *(("phrase", text) for text in (*BOOK.spoken(), "stop")),
        *(("wording", text) for text in list(WORDINGS)[half::2]),
        *(("near", text) for text in NEAR[half::2]),
        *(("far", text) for text in FAR[half::2]),
    ]


def gather(
    voices: Sequence[str],
    half: int,
    seed: int,
    folder: Path,
    settings: EvidenceSettings,
    expecting: Expecting = "commands",
) -> list[tuple[Job, AcousticEvidence]]:
    """Have everything said, and decode it."""
    said = texts(half)
    if expecting == "answers":
        said += [("answer", text) for text in (*YES, *NO)]
    for voice in voices:
        say(voice, [text for _, text in said], folder)
    jobs: list[Job] = [
        (kind, voice, text, condition)
        for condition in CONDITIONS
        for voice in voices
        for kind, text in said
    ]
    sounds: list[tuple[str, str] | bytes] = [
        (str(folder / f"{voice}-{text}.wav"), condition) for _, voice, text, condition in jobs
    ]
    for sound in noises(seed, NOISES):
        jobs.append(("noise", "", "", "clean"))
        sounds.append(sound)
    with ProcessPoolExecutor(initializer=_prepare, initargs=(settings,)) as pool:
        found = []
        for number, evidence in enumerate(
            pool.map(partial(_decode, expecting=expecting), sounds, chunksize=8), 1
        ):
            found.append(evidence)
            if sys.stderr.isatty():
                print(f"\r{number} of {len(sounds)}", end="", file=sys.stderr)
    return list(zip(jobs, found, strict=True))


def figures(job: Job, evidence: AcousticEvidence) -> tuple[list[float], bool] | None:
    """Return the features of an utterance's likelihood, and whether it was understood."""
    text, margin = understanding.best_words(evidence, BOOK)
    found = BOOK.choices(text)
    if not found or stops(text):
        return None
    known = min(BOOK.known(text), understanding.MOST_KNOWN)
    ok = right(job[0], job[2], found[0].behaviour, dict(found[0].arguments))
    margin = min(understanding.MOST_MARGIN, max(understanding.LEAST_MARGIN, margin))
    return [found[0].confidence, float(known), margin], ok


def fit(decoded: Sequence[tuple[Job, AcousticEvidence]]) -> None:
    """Print the weights of the likelihood: a logistic regression, right ones against others."""
    from sklearn.linear_model import LogisticRegression

    fitted = [(job, evidence) for job, evidence in decoded if job[3] in FITTED]
    rows = [row for job, evidence in fitted if (row := figures(job, evidence)) is not None]
    model = LogisticRegression(C=10, class_weight="balanced", max_iter=2000)
    model.fit([x for x, _ in rows], [ok for _, ok in rows])
    weights = [*model.coef_[0], model.intercept_[0]]
    names = ("CONFIDENCE_WEIGHT", "KNOWN_WEIGHT", "MARGIN_WEIGHT", "OFFSET")
    for name, weight in zip(names, weights, strict=True):
        setattr(understanding, name, weight)
    print(f"{', '.join(names)} = {', '.join(f'{weight:.2f}' for weight in weights)}")
    for sure, unsure in ((0.6, 0.4), (0.7, 0.4), (0.8, 0.4), (0.7, 0.3), (0.7, 0.5)):
        understanding.SURE, understanding.UNSURE = sure, unsure
        print(f"SURE, UNSURE = {sure}, {unsure}")
        table(decoded, EvidenceSettings())


def table(decoded: Sequence[tuple[Job, AcousticEvidence]], settings: EvidenceSettings) -> None:
    """Print the outcomes of each kind of utterance, by condition and by voice."""
    counts: dict[tuple[str, str, str], Counter[str]] = {}
    for (kind, voice, text, condition), evidence in decoded:
        outcome = judge(kind, text, evidence, settings)
        for whose in (voice, "all"):
            counts.setdefault((condition, kind, whose), Counter())[outcome] += 1
    print("per cent           voice     n    right  offered   wrong  wrong offer  nothing")
    for (condition, kind, voice), count in counts.items():
        if kind in ("phrase", "noise") or voice == "all":
            n = count.total()
            shares = [100 * count[o] / n for o in ("right", "offered", "wrong", "misled", "none")]
            name = condition if condition == "clean" else f"{condition} dB"
            print(
                f"{name:6} {kind:8}  {voice:8} {n:4d}   {shares[0]:5.1f}    {shares[1]:5.1f}"
                f"   {shares[2]:5.1f}        {shares[3]:5.1f}    {shares[4]:5.1f}"
            )


def judge(kind: str, text: str, evidence: AcousticEvidence, settings: EvidenceSettings) -> str:
    """Return the outcome of an utterance.

    right: Tangy asked about the meaning; offered: it is among the choices; wrong: Tangy asked about
    another one; misled: the meaning is not among the choices; none: no reaction.
    """
    said = understanding.understand(evidence, BOOK, settings)
    tier = tier_of(said)
    if tier == "stop":
        return "right" if right(kind, text, "stop", {}) else "wrong"
    if tier == "nothing":
        return "none"
    assert isinstance(said, Say)
    assert said.commands is not None
    meant = [right(kind, text, c.behaviour, dict(c.arguments)) for c in said.commands]
    if tier == "sure":
        return "right" if meant[0] else "wrong"
    return "offered" if any(meant) else "misled"


def answers(decoded: Sequence[tuple[Job, AcousticEvidence]], settings: EvidenceSettings) -> None:
    """Print how many answers are understood correctly, and which other sounds count as answers."""
    counts: dict[tuple[str, str], Counter[str]] = {}
    for (kind, _, text, condition), evidence in decoded:
        taken = understanding.answer(evidence, settings)
        outcome = "none"
        if isinstance(taken, Reply):
            meant = kind == "answer" and taken.yes == yes_or_no(text)
            outcome = "right" if meant else "yes" if taken.yes else "no"
        counts.setdefault((condition, kind), Counter())[outcome] += 1
    print("per cent             n    right   wrongly yes   wrongly no")
    for (condition, kind), count in counts.items():
        shares = [100 * count[outcome] / count.total() for outcome in ("right", "yes", "no")]
        name = condition if condition == "clean" else f"{condition} dB"
        print(
            f"{name:6} {kind:8} {count.total():6d}    {shares[0]:5.1f}         {shares[1]:5.1f}"
            f"        {shares[2]:5.1f}"
        )


async def latency(folder: Path, voices: Sequence[str], settings: EvidenceSettings) -> None:
    """Print the delay from the end of an utterance to its evidence.

    The sound arrives in pieces of 40 ms at the pace of the speech, as from a microphone.
    """
    recogniser = Recogniser()
    await recogniser.start(understanding.wanted(BOOK, settings))
    took, lengths = [], []
    for number, (_, text) in enumerate(texts(1)[::6]):
        pcm = heard(folder / f"{voices[number % len(voices)]}-{text}.wav", "clean")
        sound: asyncio.Queue[bytes] = asyncio.Queue()
        hearing = asyncio.create_task(recogniser.hear(sound))
        for place in range(0, len(pcm), 1280):
            sound.put_nowait(pcm[place : place + 1280])
            await asyncio.sleep(0.04)
        sound.put_nowait(b"")
        begun = time.perf_counter()
        await hearing
        took.append(1000 * (time.perf_counter() - begun))
        lengths.append(len(pcm) / 2 / RATE)
    await recogniser.close()
    print(
        f"end of utterance to evidence: median {np.median(took):.0f} ms, "
        f"p95 {np.percentile(took, 95):.0f} ms ({len(took)} utterances of "
        f"{np.mean(lengths):.1f} s, the longest {max(lengths):.1f} s)"
    )


def main() -> None:
    """Print the table, or the weights."""
    options = argparse.ArgumentParser(description="Measure speech identification.")
    options.add_argument("--fit", action="store_true", help="print weights, on the tuned voices")
    options.add_argument("--paper", action="store_true", help="the paper's n-gram and keywords")
    options.add_argument("--answers", action="store_true", help="spoken answers, not commands")
    options.add_argument("--voices", nargs="*", help="voices of flite or festival")
    options.add_argument("--keep", type=Path, help="a folder for the voices and what was decoded")
    chosen = options.parse_args()
    settings = EvidenceSettings(mode="paper" if chosen.paper else "tiers")
    voices = chosen.voices or (TUNED if chosen.fit else QUOTED)
    with tempfile.TemporaryDirectory() as temporary:
        folder = chosen.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        begun = time.process_time()
        half, seed = (0, 11) if chosen.fit else (1, 12)
        if chosen.answers:
            decoded = gather(voices, half, seed, folder, settings, "answers")
            for limit in (-0.6, -0.9, -1.2, -1.5) if chosen.fit else ():
                understanding.LEAST_ANSWER = limit
                print(f"LEAST_ANSWER = {limit}")
                answers(decoded, settings)
            if not chosen.fit:
                answers(decoded, settings)
            return
        decoded = gather(voices, half, seed, folder, settings)
        if chosen.keep:
            kept = [[*job, asdict(evidence)] for job, evidence in decoded]
            (folder / f"decoded-{'fit' if chosen.fit else 'quote'}.json").write_text(
                json.dumps(kept)
            )
        if chosen.fit:
            fit(decoded)
        else:
            table(decoded, settings)
            asyncio.run(latency(folder, voices, settings))
        print(f"({len(decoded)} utterances, {time.process_time() - begun:.0f} s here)")


if __name__ == "__main__":
    main()
