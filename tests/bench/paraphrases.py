"""How many requests outside every phrasebook are understood, typed and as if they had been heard.

Run by hand: `python -m tests.bench.paraphrases`. The sentences of `sentences.py` at even places set
the limits of `paraphrases` and `understanding`, the others are quoted; `--set` counts another one:
`requests_second.toml` set no limit; `staff_sayings.toml` and `staff_requests.toml` became wordings
of Bingo; `requests_development.toml`, of three activities, may choose limits and templates.
`--half` takes every second sentence of each list; the first half of the development set was looked
at, the second only counted. `--noise` lets voices say the sentences, each one of them, clean or
with white noise this many dB below, and decodes them. `--phrases` counts phrases and keywords
alone, and `--show` lists the errors of sentences that may be looked at.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import tomllib
from collections import Counter
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from tangy_profiles.activity import load_activity
from tangy_profiles.person import load_people
from tangy_profiles.room import load_room
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.intents import Intents
from tangy_tui.language.paraphrases import SURE
from tangy_tui.learning.verification import Say, StopCommand
from tangy_tui.speech.decoder import make_decoder
from tangy_tui.speech.evidence import USUAL, AcousticEvidence
from tangy_tui.speech.understanding import clearly_heard, understand, wanted
from tests.bench.sentences import FAR, NEAR, WORDINGS
from tests.bench.spoken_stops import VOICES, Said, Voices

SETS = {
    "second": "requests_second.toml",
    "held": "requests_held.toml",
    "development": "requests_development.toml",
    "staff": "staff_requests.toml",
    "sayings": "staff_sayings.toml",
}
SHOWN = {(name, half) for name in ("staff", "sayings") for half in (None, 0, 1)}
SHOWN |= {("development", 0)}
"""The sets, and halves of sets, whose errors may be looked at."""
OUTCOMES = ("right", "offered", "wrong", "misled", "nothing")


class Sentence(NamedTuple):
    """A sentence of a kind, and its request: a behaviour ("" is nothing) and a person."""

    kind: str
    text: str
    behaviour: str
    user: str | None = None


def written_sentences(half: int) -> list[Sentence]:
    """Return every second sentence of `sentences.py`, from the first or the second on."""
    asked = [Sentence("paraphrase", text, meant) for text, meant in WORDINGS.items()]
    others = [[Sentence(kind, text, "") for text in texts] for kind, texts in
              (("near", NEAR), ("other", FAR))]  # fmt: skip
    return [one for listed in (asked, *others) for one in listed[half::2]]


def sets_of(file: Path, part: slice) -> dict[str, list[Sentence]]:
    """Return a part of each list of sentences in a file, by activity."""
    read = tomllib.loads(file.read_text(encoding="utf-8"))
    by_activity = {"bingo": read} if "requests" in read else read
    return {activity: _sentences_in(one, part) for activity, one in by_activity.items()}


def _sentences_in(read: Mapping[str, Any], part: slice) -> list[Sentence]:
    found = [
        Sentence("paraphrase", text, behaviour)
        for behaviour, texts in read["requests"].items()
        for text in texts[part]
    ]
    found += [
        Sentence("visit", text, "navigate to user", f"user{visit['person']}")
        for visit in read.get("visits", ())
        for text in visit["says"][part]
    ]
    talk = read["talk"].items()
    return found + [Sentence(kind, text, "") for kind, texts in talk for text in texts[part]]


def spoken(sentence: Sentence, book: Phrasebook) -> str:
    """Judge how voice control understands a sentence that was heard clearly."""
    return understood(sentence, clearly_heard(sentence.text), book)


def understood(sentence: Sentence, evidence: AcousticEvidence, book: Phrasebook) -> str:
    """Judge how voice control understands a sentence as it was heard."""
    said = understand(evidence, book, USUAL)
    if isinstance(said, StopCommand):
        return "wrong"
    commands = said.commands or ()
    meant = [_fits(sentence, c.behaviour, c.arguments.get("user")) for c in commands]
    return _judged(meant, sure=said.sure)


def typed(sentence: Sentence, book: Phrasebook) -> str:
    """Judge how the command bar understands a sentence."""
    command = book.understand(sentence.text)
    if command is None:
        return "nothing"
    first = _fits(sentence, command.behaviour, command.arguments.get("user"))
    others = [_fits(sentence, name, None) for name in command.alternatives]
    sure = command.confidence >= SURE or not book.learns
    return _judged([first, *others], sure=sure)


def _fits(sentence: Sentence, behaviour: str, user: str | None) -> bool:
    return (behaviour, sentence.user or user) == (sentence.behaviour, user)


def _judged(meant: list[bool], *, sure: bool) -> str:
    if not meant:
        return "nothing"
    if sure:
        return "right" if meant[0] else "wrong"
    return "offered" if any(meant) else "misled"


def table(sentences: list[Sentence], book: Phrasebook, *, show: bool = False) -> None:
    """Print how many of each kind are right, offered, wrong and so on."""
    print_outcomes(sentences, book, spoken, show=show)
    print_outcomes(sentences, book, typed, show=show)


def print_outcomes(
    sentences: list[Sentence],
    book: Phrasebook,
    door: Callable[[Sentence, Phrasebook], str],
    *,
    show: bool = False,
) -> None:
    """Print how many sentences of each kind have each outcome, typed or heard."""
    counts: dict[str, Counter[str]] = {}
    for one in sentences:
        outcome = door(one, book)
        counts.setdefault(one.kind, Counter())[outcome] += 1
        if show and outcome != ("right" if one.behaviour else "nothing"):
            said = understand(clearly_heard(one.text), book, USUAL)
            meant = [c.behaviour for c in said.commands or ()] if isinstance(said, Say) else []
            print(f"  {door.__name__} {outcome}: {one.text} ({one.behaviour}): {meant}")
    for kind, count in counts.items():
        told = "  ".join(f"{name} {count[name]:3}" for name in OUTCOMES)
        print(f"{door.__name__:8}{kind:12} n {count.total():3}  {told}")


def by_sound(sentences: list[Sentence], book: Phrasebook, noise: str) -> None:
    """Let voices say the sentences, decode them, and print how many are right and so on."""
    decoder = make_decoder(wanted(book, USUAL))
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # the grammar's unfinished paths are printed there
    said = {
        one: Said("", one.text, VOICES[place % len(VOICES)]) for place, one in enumerate(sentences)
    }

    with tempfile.TemporaryDirectory() as folder:
        voices = Voices(Path(folder))
        voices.say(list(said.values()))

        def heard(one: Sentence, book: Phrasebook) -> str:
            pcm = voices.heard(said[one], noise, ())
            return understood(one, decoder.decode(pcm, "commands"), book)

        for family in (True, False):
            some = [one for one in sentences if ("-" in said[one].voice) == family]
            print("espeak" if family else "flite, festival", noise)
            print_outcomes(some, book, heard)
    decoder.close()


def main() -> None:
    """Print the tables."""
    options = argparse.ArgumentParser(description="Measure what is understood of paraphrases.")
    options.add_argument("--set", choices=SETS)
    options.add_argument("--half", type=int, choices=(0, 1), help="every second sentence of a set")
    options.add_argument("--noise", help="clean, or dB")
    options.add_argument("--phrases", action="store_true")
    options.add_argument("--show", action="store_true")
    chosen = options.parse_args()
    learnt = None if chosen.phrases else Intents().model
    people = load_room().placed(load_people(4))
    if chosen.set:
        part = slice(None) if chosen.half is None else slice(chosen.half, None, 2)
        show = chosen.show and (chosen.set, chosen.half) in SHOWN
        for activity, sentences in sets_of(Path(__file__).parent / SETS[chosen.set], part).items():
            print(activity)
            book = Phrasebook(load_activity(activity), people, learnt)
            if chosen.noise:
                by_sound(sentences, book, chosen.noise)
            else:
                table(sentences, book, show=show)
        return
    book = Phrasebook(load_activity("bingo"), people, learnt)
    for name, half in (("set the limits", 0), ("quoted", 1)):
        print(name)
        table(written_sentences(half), book, show=chosen.show and half == 0)


if __name__ == "__main__":
    main()
