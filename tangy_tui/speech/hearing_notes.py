"""Notes about hearing while Tangy listens; `tangy_tui.text` puts them in words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

HearingKind: TypeAlias = Literal[
    "getting ready",
    "still thinking",
    "records",
    "records no more",
    "recording over",
    "microphone closed",
    "cut off",
    "not decoded",
    "decoder failed",
    "question between",
    "no words",
    "no answer",
    "word not heard",
    "name not heard",
    "phrase not heard",
    "worker ended",
    "source",
]


@dataclass(frozen=True, slots=True)
class HearingNote:
    """One thing to say about hearing.

    Args:
        kind: what has happened.
        about: the words, the phrase, the file or the reason that it is about.
        other: whose name a word is (an id), or what a phrase sounds like.
        seconds: how long what was said is, whole.
    """

    kind: HearingKind
    about: str = ""
    other: str = ""
    seconds: int = 0
