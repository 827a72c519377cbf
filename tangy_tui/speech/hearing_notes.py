"""Notes about speech recognition for people; `tangy_tui.text` has their words."""

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
    """One note.

    Args:
        kind: what has happened.
        about: the words, phrase, file or reason concerned.
        other: the id of the person with this name, or the similar phrase.
        seconds: the length of the utterance, in whole s.
    """

    kind: HearingKind
    about: str = ""
    other: str = ""
    seconds: int = 0
