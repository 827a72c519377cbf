"""Sentences that stop a robot or a game, and sentences about stopping other things.

The stop decoder's language model is trained on them. Most are generated from `stopping.toml` with a
fixed seed.
"""

from __future__ import annotations

import random
import re
import tomllib
from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files

from tangy_tui.language.stop_sentence import STOPS

EACH = 40
"""The number of sentences generated from each template."""
PLAIN = 3
"""The repetitions of each plain sentence."""
SEED = 1
_SLOT = re.compile(r"{(\w+)}")


@cache
def stop_texts() -> tuple[str, ...]:
    """Return sentences that stop the robot, in lower case; common ones are repeated."""
    return (*STOPS * PLAIN, *_made("said", "stops"))


@cache
def other_stop_texts() -> tuple[str, ...]:
    """Return sentences about stopping other things, in lower case."""
    return _made("said_of_others", "others")


def _made(plain: str, forms: str) -> tuple[str, ...]:
    texts, chance = _texts(), random.Random(SEED)
    made = (_filled(form, texts, chance) for form in texts[forms] for _ in range(EACH))
    return (*tuple(texts[plain]) * PLAIN, *made)


def _filled(form: str, texts: Mapping[str, Sequence[str]], chance: random.Random) -> str:
    return " ".join(_SLOT.sub(lambda slot: chance.choice(texts[slot[1]]), form).split())


@cache
def _texts() -> Mapping[str, Sequence[str]]:
    content = files("tangy_tui.language").joinpath("stopping.toml").read_text(encoding="utf-8")
    return tomllib.loads(content)
