"""Calibration of speech recognition for one microphone in one room, from a few utterances.

A few commands and other sentences are decoded with several weights of the garbage branch. Each
weight gives a score per utterance, and the threshold between commands and the rest is shifted to
separate them best. Nine utterances are few, so settings are penalised by their distance from the
defaults, which are kept unless others gain a whole utterance.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.labels import UtteranceLabel
from tangy_tui.learning.verification import StopCommand
from tangy_tui.speech.evidence import USUAL, AcousticEvidence, EvidenceSettings
from tangy_tui.speech.understanding import SURE, UNSURE, understand

WEIGHTS = (0.1, 0.2, 0.43, 0.9, 2.0)
"""Weights of the garbage branch to try."""
SHIFTS = tuple(step / 4 for step in range(-8, 9))  # -2 to +2
ROOM = 0.6  # margin of every score that makes further weights unnecessary
SHIFT_SPREAD = 0.8  # prior spread of shifts around 0, and of weights (a factor) around the default
WEIGHT_SPREAD = 2.5
SURELY, PERHAPS = math.log(SURE / (1 - SURE)), math.log(UNSURE / (1 - UNSURE))
WORTH_IT = 1.0  # utterances that other settings must gain
FAR = 6.0  # scores are clipped to this


@dataclass(frozen=True, slots=True)
class CalibrationPrompt:
    """A prompt to say: a command (`meant`), or a sentence that is none (None)."""

    text: str
    meant: UtteranceLabel | None


@dataclass(frozen=True, slots=True)
class SeparationCounts:
    """How well commands and other sentences are separated: counts of the prompts."""

    commands: int
    understood: int
    offered: int
    others: int
    taken: int
    """The other sentences that were taken for a command or offered as one."""

    @property
    def kept(self) -> bool:
        """Whether at most one command in six is lost."""
        lost = self.commands - self.understood - self.offered
        return self.commands > 0 and 6 * lost <= self.commands

    @property
    def parted(self) -> bool:
        """Whether the separation is good enough to use."""
        return self.kept and 3 * self.taken <= self.others

    @property
    def gain(self) -> float:
        """The score of the result: an offered command counts half of an understood one."""
        return self.understood + self.offered / 2 - self.taken

    @property
    def perfect(self) -> bool:
        """Whether every command was understood, and nothing else taken for one."""
        return self.understood == self.commands and self.taken == 0


@dataclass(frozen=True, slots=True)
class CalibrationResult:
    """The chosen settings, and their figures and those of the defaults."""

    settings: EvidenceSettings
    figures: SeparationCounts
    usual: SeparationCounts


@dataclass(frozen=True, slots=True)
class CalibrationScore:
    """The logit that an utterance is a command (at shift 0), and whether it is the right one."""

    told: float
    asked: CalibrationPrompt
    right: bool


def score(
    evidence: AcousticEvidence,
    asked: CalibrationPrompt,
    phrasebook: Phrasebook,
    settings: EvidenceSettings,
) -> CalibrationScore:
    """Score one utterance, independent of the shift."""
    lowest = SHIFTS[0]
    said = understand(evidence, phrasebook, replace(settings, shift=lowest))
    if isinstance(said, StopCommand):
        return CalibrationScore(FAR, asked, False)
    if not said.commands:
        return CalibrationScore(-FAR, asked, False)
    first = said.commands[0]
    label = UtteranceLabel(first.behaviour, first.arguments.get("user"))
    sure = min(max(said.confidence, 1e-4), 1 - 1e-4)
    told = math.log(sure / (1 - sure)) + lowest
    return CalibrationScore(max(-FAR, min(FAR, told)), asked, label == asked.meant)


def choose(scores: Mapping[float, Sequence[CalibrationScore]]) -> CalibrationResult:
    """Choose the weight and the shift that separate commands from the rest best.

    Args:
        scores: scores of the same utterances for each weight, including the default one.
    """
    usual = _figures(scores[USUAL.garbage], 0.0)
    if spare(scores[USUAL.garbage]):
        return CalibrationResult(USUAL, usual, usual)
    weight, shift = max(
        ((weight, shift) for weight in scores for shift in SHIFTS),
        key=lambda way: (_worth(scores[way[0]], *way), way),
    )
    found = _figures(scores[weight], shift)
    if found.gain < usual.gain + WORTH_IT:
        return CalibrationResult(USUAL, usual, usual)
    return CalibrationResult(replace(USUAL, garbage=weight, shift=shift), found, usual)


def spare(scores: Sequence[CalibrationScore]) -> bool:
    """Return whether all utterances are separated without a shift, with a margin."""
    return all(
        (s.right and s.told >= SURELY + ROOM) if s.asked.meant else s.told <= PERHAPS - ROOM
        for s in scores
    )


def _worth(scores: Sequence[CalibrationScore], weight: float, shift: float) -> float:
    """Return the score of settings: log likelihood of the utterances, minus a prior penalty."""
    told = sum(
        _log_chance(s.told - shift - SURELY)
        if s.right
        else _log_chance(PERHAPS - s.told + shift) - (FAR if s.asked.meant else 0)
        for s in scores
    )
    far = math.log(weight / USUAL.garbage) / math.log(WEIGHT_SPREAD)
    return told - (shift / SHIFT_SPREAD) ** 2 / 2 - far**2 / 2


def _log_chance(margin: float) -> float:
    return -math.log1p(math.exp(-margin))


def _figures(scores: Sequence[CalibrationScore], shift: float) -> SeparationCounts:
    commands = [s for s in scores if s.asked.meant]
    others = [s for s in scores if not s.asked.meant]
    surely = sum(s.right and s.told - shift >= SURELY for s in commands)
    known = sum(s.right and s.told - shift >= PERHAPS for s in commands)
    taken = sum(s.told - shift >= PERHAPS for s in others)
    return SeparationCounts(len(commands), surely, known - surely, len(others), taken)
