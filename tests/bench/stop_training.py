"""Learn which sentences stop the robot, with scikit-learn.

Run by hand: `python -m tests.bench.stop_training` trains the model, and writes it where Tangy
reads it. Do so after `stopping.toml`, `stop_sentences.toml` or an activity's phrases have changed.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

from tangy_profiles.activity import load_activity, shipped_activities
from tangy_tui import language
from tangy_tui.language.answers import NO, YES
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.examples import Example, examples_of
from tangy_tui.language.intent_training import train
from tangy_tui.language.steering import IN_GAMES, WHILE_TEACHING, steering_texts
from tangy_tui.language.stop_likelihood import MODEL, STOP
from tangy_tui.language.stop_phrases import game_words, other_stop_texts, stop_texts
from tangy_tui.language.words import Words, words_of

OFTEN = 6  # the most times a sentence counts
OWN = 4  # how many times each phrase of an activity counts
EVERY = 6  # one in this many of the sentences that ask for an activity's behaviours is used

_CONTRACTED = re.compile(r"\b(\w+)n't\b")
_VERBS = {"ca": "can", "wo": "will", "sha": "shall"}


def stop_examples(without: str = "") -> tuple[Example, ...]:
    """Return the sentences, in a fixed order, without the written set `without`."""
    found: list[Example] = []
    for texts, meant in ((stop_texts(without), STOP), (other_stop_texts(without), "")):
        for text, times in Counter(texts).items():
            for way in dict.fromkeys((text, in_full(text))):
                found += [Example(_plain(words_of(way)), meant)] * min(times, OFTEN)
    for text in (*YES, *NO, *steering_texts(WHILE_TEACHING), *steering_texts(IN_GAMES)):
        found += [Example(_plain(words_of(text)), "")] * OWN
    for activity in map(load_activity, shipped_activities()):
        phrases = Phrasebook(activity, ()).phrases
        found += [Example(_plain(words_of(phrase)), "") for phrase in phrases] * OWN
        found += [Example(_plain(e.words), "") for e in examples_of(activity)[::EVERY]]
    return tuple(found)


def in_full(text: str) -> str:
    """Return a text with each "don't" and the like in full: voices say both, writers the short."""
    return _CONTRACTED.sub(lambda short: f"{_VERBS.get(short[1], short[1])} not", text)


def digest_of(examples: Iterable[Example]) -> str:
    """Return the digest that identifies a model's training sentences."""
    return hashlib.sha256(json.dumps(list(examples)).encode()).hexdigest()[:32]


def main() -> None:
    """Train the model of stops."""
    examples = stop_examples()
    model = json.loads(train(examples).to_json())
    told = json.dumps({"made_of": digest_of(examples), **model}, separators=(",", ":"))
    Path(language.__file__).with_name(MODEL).write_text(told, encoding="utf-8")


def _plain(words: Iterable[str]) -> Words:
    return tuple(_each(words))


def _each(words: Iterable[str]) -> Iterator[str]:
    for word in words:
        yield "game" if word in game_words() else word.replace("'", "")


if __name__ == "__main__":
    main()
