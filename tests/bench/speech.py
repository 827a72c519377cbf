"""What is understood of spoken commands, and what of other speech is taken for one.

Run by hand: `python tests/bench/speech.py` (needs flite). All phrases of the activity and 50 other
sentences are spoken by flite's voices and go through the real worker: as spoken, 15 % faster and
slower, and with noise 20 and 10 dB below the voice. `--fit` prints the weights of the confidence in
speech_worker instead, fitted to the voices of TUNED and every second of the other wordings and
sentences; without it, the voices of QUOTED and the rest of the sentences are counted. A synthetic
voice is not a person: take the differences seriously, not the last per cent.

A row counts the phrases that were understood right, wrong and not at all, then those below the
threshold (nothing is asked, what was heard is shown) by whether they would have been right, and the
other sentences that were taken for a command: near ones share words with the phrases.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tangy_profiles.activity import load_activity
from tangy_profiles.person import load_people
from tangy_tui.learning.commands import Phrasebook
from tangy_tui.learning.microphone import split
from tangy_tui.learning.speech import Heard, Recogniser, understand
from tangy_tui.learning.speech_worker import Decoder
from tangy_tui.learning.wav import RATE, read_wav

TUNED = ("rms", "awb")
QUOTED = ("slt", "kal16", "kal")  # kal has 8,000 samples a second, like a telephone
CONDITIONS = ("as spoken", "faster", "slower", "20 dB noise", "10 dB noise")
FITTED = CONDITIONS[:4]  # at 10 dB hardly anything is right that one could fit to

NEAR = (
    "what is the number of the bus", "my front door is open", "the winner takes it all",
    "she told me a long story about the game", "i want to play another game",
    "the player went home early", "everyone is having lunch now", "he said hello to his mother",
    "where did i put my card", "the card is on the table", "that was not funny at all",
    "can i have a marker please", "good morning everyone", "how many numbers do we need",
    "turn the music off", "the user manual is missing", "do you want to go to the park",
    "they moved closer to the city", "what a good idea", "please help me with my coat",
    "it was hard work", "the next train leaves at four", "bring me a glass of water",
    "we have a problem", "take your time",
)  # fmt: skip
FAR = (
    "the weather is lovely today", "i would like a cup of tea", "my sister lives in canada",
    "when is dinner served", "it will rain tomorrow morning", "have you seen my glasses",
    "the dog is barking outside", "i slept very badly last night", "what time is it",
    "my knee hurts again", "the soup was too salty", "who won the hockey match",
    "turn on the television", "i need to see the doctor", "there is a bird on the window",
    "thank you very much", "yes of course", "no not yet", "let me think about it",
    "i do not understand", "open the window please", "the coffee is getting cold",
    "how old are your grandchildren", "we watched a film about whales",
    "this chair is uncomfortable",
)  # fmt: skip
WORDINGS: Mapping[str, str] = {  # ways to ask that no list of phrases has
    "please call another number": "call number",
    "could you call the number now": "call number",
    "what is the next number": "call number",
    "let us hear a joke": "joke",
    "tell everyone a funny joke": "joke",
    "say hello to the players": "greeting",
    "welcome the group": "greeting",
    "drive back to the front": "navigate to front",
    "go back to front please": "navigate to front",
    "please move to the front": "navigate to front",
    "tell her to bring the card closer": "move card closer",
    "closer with the card please": "move card closer",
    "tell him to remove the markers": "remove markers",
    "ask her to mark the missing numbers": "mark numbers",
    "please mark the missed number": "mark numbers",
    "tell the player well done": "encourage",
    "good work": "encourage",
    "celebrate with the winner": "celebrate",
    "say goodbye to the group": "valediction",
    "end the game now": "valediction",
}


@dataclass
class Count:
    """What became of the phrases of one voice under one condition."""

    right: int = 0
    wrong: int = 0
    none: int = 0
    below_right: int = 0
    below_wrong: int = 0

    def add(self, heard: Heard, book: Phrasebook, wanted: tuple[str, dict[str, str]]) -> None:
        """Count one utterance."""
        command, raw = understand(heard, book), book.understand(heard.text)
        same = raw is not None and (raw.behaviour, dict(raw.arguments)) == wanted
        if command is not None:
            self.right += same
            self.wrong += not same
        else:
            self.none += 1
            self.below_right += same
            self.below_wrong += raw is not None and not same

    def __str__(self) -> str:
        total = self.right + self.wrong + self.none
        shares = " ".join(f"{100 * part / total:4.0f}" for part in (self.right, self.wrong))
        below = f"{self.below_right:3d}/{self.below_wrong:d}"
        return f"{shares} {100 * self.none / total:4.0f}   {below:>6}"


class Voices:
    """Speaks with flite, once for every sentence."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._spoken: dict[tuple[str, str], bytes] = {}

    def say(self, voice: str, text: str, condition: str) -> bytes:
        """Return a sentence as a microphone would give it: changed, then cut out of its quiet."""
        if (voice, text) not in self._spoken:
            path = self._folder / "said.wav"
            subprocess.run(  # noqa: S603 - a synthesiser and our own sentences
                ["flite", "-voice", voice, "-t", text, "-o", str(path)],  # noqa: S607
                check=True,
                stderr=subprocess.DEVNULL,
            )
            self._spoken[voice, text] = read_wav(path)
        return changed(self._spoken[voice, text], condition)


def changed(pcm: bytes, condition: str) -> bytes:
    """Put a voice into a room: with half a second of quiet around it, and a condition."""
    samples = np.frombuffer(pcm, "<i2").astype(np.float64)
    noise = np.random.default_rng(len(pcm))
    if condition in ("faster", "slower"):
        step = 1.15 if condition == "faster" else 1 / 1.15
        samples = np.interp(np.arange(0, len(samples) - 1, step), np.arange(len(samples)), samples)
    power = float(np.mean(samples**2))
    samples = np.pad(samples, RATE // 2)
    level = 8.0
    if condition.endswith("dB noise"):
        level = (power / 10 ** (float(condition.split()[0]) / 10)) ** 0.5
    hiss = np.convolve(noise.normal(size=len(samples)), np.ones(4) / 2, "same")
    mixed = np.clip(samples + level * hiss, -32_768, 32_767).astype("<i2").tobytes()
    return max(split(mixed), key=len, default=b"")


def wanted(book: Phrasebook, phrase: str) -> tuple[str, dict[str, str]]:
    """Return what a phrase means."""
    command = book.understand(phrase)
    assert command is not None
    return command.behaviour, dict(command.arguments)


def fit(book: Phrasebook, voices: Voices) -> None:
    """Print the weights of the confidence: a logistic regression on the figures of the path."""
    from sklearn.linear_model import LogisticRegression

    decoder = Decoder(book.spoken())
    meanings = {phrase: wanted(book, phrase) for phrase in book.spoken()}
    meanings |= {text: (meant, {}) for text, meant in list(WORDINGS.items())[::2]}
    rows: list[tuple[float, float]] = []
    right: list[bool] = []
    for condition in FITTED:
        for voice in TUNED:
            for text in (*meanings, *NEAR[::2], *FAR[::2]):
                heard, score, words = decoder.best_path(voices.say(voice, text, condition))
                command = book.understand(heard)
                if command is not None:
                    rows.append((score, words))
                    meant = (command.behaviour, dict(command.arguments))
                    right.append(meant == meanings.get(text))
    table = np.array(rows)
    middle, spread = table.mean(axis=0), table.std(axis=0)
    model = LogisticRegression(class_weight="balanced").fit((table - middle) / spread, right)
    weight = model.coef_[0] / spread
    print(f"SCORE_MIDDLE, SCORE_WEIGHT = {middle[0]:.2f}, {weight[0]:.2f}")
    print(f"WORDS_MIDDLE, WORDS_WEIGHT = {middle[1]:.1f}, {weight[1]:.3f}")
    print(f"OFFSET = {model.intercept_[0]:.2f}")


async def quote(book: Phrasebook, voices: Voices, names: Sequence[str]) -> None:
    """Print a row for every voice and condition."""
    print(f"{len(book.spoken())} phrases, {len(WORDINGS) // 2} other wordings, other sentences: ")
    print(f"{len(NEAR[1::2])} near and {len(FAR[1::2])} far; CPU seconds of the worker")
    print(" " * 21 + "known phrases %              other wordings %         taken for one")
    print(" " * 21 + "right wrong none below r/w   right wrong none below   near  far    CPU ms")
    recogniser = Recogniser()
    await recogniser.start(book.spoken())
    try:
        for voice, condition in ((v, c) for v in names for c in CONDITIONS):
            before, asked = cpu_seconds(recogniser.pid), 0
            known, other, taken = Count(), Count(), [0, 0]
            for text in book.spoken():
                heard = await recogniser.decode(voices.say(voice, text, condition))
                known.add(heard, book, wanted(book, text))
                asked += 1
            spent = (cpu_seconds(recogniser.pid) - before) / asked
            for text, meant in list(WORDINGS.items())[1::2]:
                heard = await recogniser.decode(voices.say(voice, text, condition))
                other.add(heard, book, (meant, {}))
            for place, sentences in enumerate((NEAR[1::2], FAR[1::2])):
                for text in sentences:
                    heard = await recogniser.decode(voices.say(voice, text, condition))
                    taken[place] += understand(heard, book) is not None
            counts = f"{taken[0]:3d}  {taken[1]:3d}"
            print(f"{voice:6} {condition:12} {known}    {other}    {counts}  {1000 * spent:8.0f}")
    finally:
        await recogniser.close()


def cpu_seconds(pid: int | None) -> float:
    """Return the CPU time that a process has used (Linux)."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main() -> None:
    """Print the table, or the weights."""
    options = argparse.ArgumentParser(description="Measure speech identification.")
    options.add_argument("--fit", action="store_true", help="print the weights of the confidence")
    options.add_argument("--voices", nargs="*", default=list(QUOTED), help="flite voices to count")
    chosen = options.parse_args()
    book = Phrasebook(load_activity("bingo"), load_people(4))
    with tempfile.TemporaryDirectory() as folder:
        voices = Voices(Path(folder))
        if chosen.fit:
            fit(book, voices)
        else:
            asyncio.run(quote(book, voices, chosen.voices))


if __name__ == "__main__":
    main()
