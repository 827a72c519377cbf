"""The input of the decoder, and its evidence about an utterance."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar, Literal

from tangy_hw.audio.wav import RATE
from tangy_profiles.activity import LISTENING

__all__ = [
    "LONGEST",
    "RATE",
    "USUAL",
    "AcousticEvidence",
    "EvidenceSettings",
    "Expecting",
    "Wanted",
]

Expecting = Literal["commands", "answers"]
"""What is listened for: commands, or the answer to a question (yes and no)."""

LONGEST = 15  # s of an utterance that are decoded at most
MODES = LISTENING


@dataclass(frozen=True, slots=True)
class EvidenceSettings:
    """Settings of listening, which depend on the microphone and the room.

    `mode` is one of MODES. `garbage` is the weight of all speech that is no command, against 1 for
    the commands; `shift` is added to what is demanded of the sound: above 0 is stricter.
    """

    ONLY: ClassVar[bool] = True
    mode: str = "tiers"
    garbage: float = 0.43
    shift: float = 0.0


USUAL = EvidenceSettings()
"""For a clean, close microphone that nobody has checked."""


@dataclass(frozen=True, slots=True)
class Wanted:
    """The vocabulary: commands, answers, and the pronunciation of their words (ARPAbet).

    Those that are `urgent` end an utterance as soon as they are heard. `stops` are many ways to
    stop the robot, common ones several times, `no_stops` sentences with such words that stop
    nothing, and `game` are the words that the game is called by.
    """

    phrases: tuple[str, ...]
    answers: tuple[str, ...] = ()
    urgent: tuple[str, ...] = ()
    pronunciations: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    settings: EvidenceSettings = USUAL
    stops: tuple[str, ...] = ()
    no_stops: tuple[str, ...] = ()
    game: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class AcousticEvidence:
    """What the decoder says of an utterance.

    `words` are the likeliest ones, everyday words among them; `phrase` is the whole phrase that
    the grammar finds, or empty; `margin` is log P(sound, words) - log P(sound, grammar or any
    phones) a frame; `confidence` is that of the paper's mode, else 1; `seconds` is the length.
    `stop` is the sentence that stops the robot, where the ears for stopping found one.
    """

    words: str = ""
    phrase: str = ""
    margin: float = 0.0
    confidence: float = 0.0
    seconds: float = 0.0
    stop: str = ""
