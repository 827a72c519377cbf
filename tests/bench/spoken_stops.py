"""How many spoken stop sentences stop the robot, and how many others do.

Run by hand: `python -m tests.bench.spoken_stops` (needs flite and espeak-ng). The sentences were
written before what is listened for was chosen: those of DEVELOPED were looked at for the phrases of
`stop_sentence.STOPS`, those of QUOTED and LATER only counted. White noise is added to whole
sentences. Everything goes through the real decoder. Synthetic voices are worse to hear than people.

Clean, QUOTED had 79 of 150 heard and 8 of 144 false with the shipped phrases before; with those of
today 96 and 5. A rule that also took what was heard half right for a stop was tried, on sentences
that nobody had seen: 7 more of 120, but 10 more of 96 that were none. So there is none.
"""

from __future__ import annotations

import asyncio
import subprocess
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np

from tangy_hw.audio.wav import read_wav
from tangy_profiles.activity import load_activity
from tangy_profiles.person import load_people
from tangy_profiles.room import load_room
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.stop_sentence import stops
from tangy_tui.speech.evidence import USUAL
from tangy_tui.speech.lexicon import Lexicon
from tangy_tui.speech.recogniser import Recogniser
from tangy_tui.speech.understanding import wanted

VOICES = ("slt", "rms", "awb", "kal", "en-gb", "en-gb+m1", "en-us+f2", "en-us+f3", "en-scotland+m3")
NOISES = (60, 20, 10)  # dB by which white noise is more quiet than the sentence
DEVELOPED = (
    (
        *("please stop the robot", "could you stop that machine now", "stop it right there"),
        *("hey tangy stop moving", "stop stop stop it is going to hit her"),
        *("make the robot stop", "somebody stop that thing", "I want the game to stop"),
        *("stop the game please we are tired", "tangy please stand still"),
        *("no no stop right now", "stop where you are", "can we stop the bingo now"),
        *("stop driving towards him", "emergency stop now", "halt the robot"),
        *("would you stop it please", "stop everything", "get it to stop", "stop rolling"),
        *("I said stop", "tell it to stop", "stop this game", "switch the robot off"),
    ),
    (
        *("stop teasing her", "stop the music please", "the bus stop is over there"),
        *("don't stop now we are winning", "I could not stop laughing", "stop picking your nose"),
        *("has the rain stopped yet", "he stopped smoking last year"),
        *("call the next number please", "stop whispering you two", "where does the bus stop"),
        "she never stops talking",
    ),
)
QUOTED = (
    (
        *("stop the robot please", "robot stop", "tangy stop it now", "please make it stop"),
        *("can you stop the game", "we need to stop now", "stop the machine at once"),
        *("oh no stop stop", "stop before it hurts somebody", "let us stop the game here"),
        *("you have to stop the robot", "hey stop that", "stop moving the arm"),
        *("please tangy stop talking", "I want you to stop moving", "stop the whole thing"),
        *("why does it not stop", "stop turning around", "everybody wait stop the robot"),
        *("stop it immediately", "end the emergency stop the robot", "stop at once"),
        *("turn off the robot", "do not move", "freeze right there"),
    ),
    (
        *("please stop tapping on the table", "stop eating all the biscuits"),
        *("I will get off at the next stop", "he would not stop talking about his garden"),
        *("the clock has stopped", "stop kicking my chair you rascal"),
        *("we stopped for coffee on the way", "do not stop the music"),
        *("I cannot stop sneezing today", "stop hiding my glasses"),
        *("she told them to stop shouting", "we do not need to stop yet"),
        *("the doctor said I must stop drinking coffee", "where did the train stop"),
        *("good morning how are you today", "my daughter is coming on sunday"),
        *("that was a lovely cup of tea", "who has number twenty three"),
        *("I think I have two in a row", "it is very warm in here", "could you pass me the sugar"),
        *("what time is lunch", "the robot is very nice today", "tell us another joke"),
    ),
)
LATER = (
    (
        *("tangy you must stop", "please stop now tangy", "stop that robot before it falls"),
        *("make that machine stop moving", "I would like you to stop", "quick stop the robot"),
        *("stop right this moment", "will you please stop", "stop the activity", "just stop"),
        *("robot please do not come closer", "can somebody stop this"),
        *("stop we have a problem", "oh stop it tangy", "stop spinning"),
        *("we want to stop the game", "stop going backwards", "no more stop it"),
        *("stop your arm", "halt"),
    ),
    (
        *("stop biting your nails", "you should stop worrying about it"),
        *("my watch stopped at noon", "stop copying from my card"),
        *("let me know when the rain stops", "the bus does not stop here on sundays"),
        *("they will not stop fighting", "stop singing that song"),
        *("I never stop thinking of him", "put a stop to the smoking", "how was your weekend"),
        *("I need two more numbers", "the nurse comes at four", "please pass the biscuits"),
        *("are you feeling better", "read the number again"),
    ),
)


def spoken(text: str, voice: str, folder: Path) -> bytes:
    """Let a voice say something; return 16 kHz mono s16le."""
    path = folder / "said.wav"
    say = ["espeak-ng", "-v", voice, "-w", str(path), text]
    flite = ["flite", "-voice", voice, "-t", text, "-o", str(path)]
    subprocess.run(say if "-" in voice else flite, check=True, capture_output=True)  # noqa: S603
    return read_wav(path)


def noisy(pcm: bytes, decibels: float, rng: np.random.Generator) -> bytes:
    """Add white noise that is so much more quiet than the sentence."""
    sound = np.frombuffer(pcm, "<i2").astype(float)
    level = np.sqrt(np.mean(sound**2)) * 10 ** (-decibels / 20)
    return np.clip(sound + rng.normal(0, level, len(sound)), -32768, 32767).astype("<i2").tobytes()


async def main() -> None:
    """Print the table."""
    phrasebook = Phrasebook(load_activity("bingo"), load_room().placed(load_people(4)))
    recogniser, rng = Recogniser(), np.random.default_rng(1)
    heard = Lexicon(phrasebook, suggest=lambda word: "").heard()
    await recogniser.start(wanted(phrasebook, USUAL, heard))
    print(f"{'sentences':12}{'noise':>8}{'stop: heard':>16}{'others: stop':>16}")
    with tempfile.TemporaryDirectory() as folder:
        for name, lists in (
            ("developed", DEVELOPED),
            ("quoted", QUOTED),
            ("quoted", LATER),
        ):
            said = [
                (kind, spoken(text, voice, Path(folder)))
                for kind, sentences in enumerate(lists)
                for text in sentences
                for voice in VOICES
            ]
            for noise in NOISES:
                counts = Counter[int]()
                for kind, pcm in said:
                    evidence = await recogniser.decode(noisy(pcm, noise, rng))
                    counts[kind] += stops(evidence.words, phrasebook.game)
                of = Counter(kind for kind, _ in said)
                row = [f"{counts[kind]} of {of[kind]}" for kind in (0, 1)]
                print(f"{name:12}{noise:>5} dB{row[0]:>16}{row[1]:>16}", flush=True)
    await recogniser.close()


if __name__ == "__main__":
    asyncio.run(main())
