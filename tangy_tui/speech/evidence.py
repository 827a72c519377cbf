"""The vocabulary of the decoder, and its evidence about an utterance."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar, Literal

from tangy_hw.audio.wav import RATE as RATE

Expecting = Literal["commands", "answers"]
"""What to recognise: commands, or the answer to a question (yes and no)."""

LONGEST = 15  # s; the longest utterance to decode


@dataclass(frozen=True, slots=True)
class EvidenceSettings:
    """Recognition settings, which depend on the microphone and the room.

    `mode` is one of LISTENING. `garbage` is the weight of all other speech, against 1 for the
    commands; `shift` is added to the acceptance threshold: above 0 is stricter. `voice` is that of
    the person who speaks, if it is known (`other_voices.means_of`).
    """

    ONLY: ClassVar[bool] = True
    mode: str = "tiers"
    garbage: float = 0.43
    shift: float = 0.0
    voice: str = ""


USUAL = EvidenceSettings()
"""The defaults, for a clean, close microphone without a check."""


@dataclass(frozen=True, slots=True)
class DecoderVocabulary:
    """The vocabulary: commands, answers, and the pronunciation of their words (ARPAbet).

    `urgent` phrases end an utterance as soon as they are heard. `stops` are sentences that stop the
    robot, common ones repeated, `no_stops` similar sentences that do not, and `game` are the words
    of the activity's title. `sentences` are requests and talk, of which it makes guesses.
    """

    phrases: tuple[str, ...]
    answers: tuple[str, ...] = ()
    urgent: tuple[str, ...] = ()
    pronunciations: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    settings: EvidenceSettings = USUAL
    stops: tuple[str, ...] = ()
    no_stops: tuple[str, ...] = ()
    game: tuple[str, ...] = ()
    sentences: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class OtherHearing:
    """What the means of other voices heard of an utterance; see `AcousticEvidence`."""

    words: str
    phrase: str
    margin: float
    guesses: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class AcousticEvidence:
    """The decoder's evidence about an utterance.

    `words` are the likeliest words, including everyday words; `phrase` is the whole phrase found by
    the grammar, or empty; `margin` is log P(sound, words) - log P(sound, grammar or any phones) per
    frame; `confidence` is that of the paper's mode, else 1; `seconds` is the length. `stop` is the
    sentence found by the stop decoder, or empty. `guesses` are the likeliest sentences, best first;
    none if a phrase was heard, or only words are known. `other` is what the means of other voices
    heard; None if the usual ones fit better.
    """

    words: str = ""
    phrase: str = ""
    margin: float = 0.0
    confidence: float = 0.0
    seconds: float = 0.0
    stop: str = ""
    guesses: tuple[str, ...] = ()
    other: OtherHearing | None = None
