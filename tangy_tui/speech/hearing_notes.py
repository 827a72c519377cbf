"""Notes about speech recognition for people; `tangy_tui.text` has their words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from tangy_tui.language.lexicon import Lexicon

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


def not_heard(lexicon: Lexicon) -> tuple[HearingNote, ...]:
    """Return a note for each word and phrase of a lexicon that cannot be recognised."""
    words = (
        HearingNote("name not heard", said.word, lexicon.whose[said.word])
        if said.word in lexicon.whose
        else HearingNote("word not heard", said.word)
        for said in lexicon.unknown
    )
    phrases = (
        HearingNote("phrase not heard", one.phrase.said, one.other.said) for one in lexicon.alike
    )
    return (*words, *phrases)
