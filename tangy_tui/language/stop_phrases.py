"""Sentences that stop a robot or a game, and sentences that do not.

The stop decoder's language model and the stop model are trained on them. Some were written for it
(`stop_sentences.toml`); most are generated from `stopping.toml` with a fixed seed.
"""

from __future__ import annotations

import random
import re
import tomllib
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any

from tangy_tui.language.examples import templates
from tangy_tui.language.stop_sentence import STOPS
from tangy_tui.language.words import spoken, words_of

EACH = 40
"""The number of sentences generated from each template."""
PLAIN = 3
"""The repetitions of each plain sentence."""
WRITTEN = 6
"""The repetitions of each sentence of `stop_sentences.toml`."""
SEED = 1
OTHERS = ("others", "talk", "ends")
_SLOT = re.compile(r"{(\w+)}")


@cache
def stop_texts(without: str = "") -> tuple[str, ...]:
    """Return sentences that stop the robot, in lower case; common ones are repeated.

    Args:
        without: the name of a written set that is left out, for figures that are quoted on it.
    """
    return (*STOPS * PLAIN, *_made("said", "stops"), *_written(("stops",), without))


@cache
def other_stop_texts(without: str = "") -> tuple[str, ...]:
    """Return sentences that do not stop the robot, in lower case."""
    talk = (spoken(words_of(text)) for text in templates()["talk"]["other"])
    return (*_made("said_of_others", "others"), *talk, *_written(OTHERS, without))


@cache
def stop_sets() -> Mapping[str, Mapping[str, Sequence[str]]]:
    """Return the written sets by name, each with `stops`, `others` and most with `talk`."""
    return _read("stop_sentences.toml")


@cache
def game_words() -> frozenset[str]:
    """Return what the game is called in the sentences."""
    return frozenset(_read("stopping.toml")["called"])


def _written(kinds: Collection[str], without: str) -> tuple[str, ...]:
    texts = (
        spoken(words_of(text))
        for name, told in stop_sets().items()
        if name != without
        for kind in kinds
        for text in told.get(kind, ())
    )
    return tuple(texts) * WRITTEN


def _made(plain: str, forms: str) -> Iterator[str]:
    texts, chance = _read("stopping.toml"), random.Random(SEED)
    yield from tuple(texts[plain]) * PLAIN
    for form in texts[forms]:
        for _ in range(EACH):
            yield " ".join(_SLOT.sub(lambda slot: chance.choice(texts[slot[1]]), form).split())


@cache
def _read(name: str) -> Mapping[str, Any]:
    content = files("tangy_tui.language").joinpath(name).read_text(encoding="utf-8")
    return tomllib.loads(content)
