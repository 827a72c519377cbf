"""How it is best listened with one microphone in one room, found out from a few utterances.

A few commands and a few other sentences are decoded with several weights of the garbage branch.
Each weight gives every utterance a score; the threshold between the commands and the rest is
shifted to where it parts them best. Nine utterances are few, so any settings pay for how far they
are from the usual ones, which are kept unless others gain a whole utterance.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from tangy_profiles.errors import TangyError
from tangy_profiles.people_records import MicrophoneChecked, MicrophoneForgotten
from tangy_profiles.reading import nearest, plain
from tangy_profiles.store import Store
from tangy_tui.language.commands import Phrasebook
from tangy_tui.learning.verification import StopCommand
from tangy_tui.speech.evidence import MODES, USUAL, AcousticEvidence, EvidenceSettings
from tangy_tui.speech.labels import UtteranceLabel
from tangy_tui.speech.understanding import SURE, UNSURE, understand

WEIGHTS = (0.1, 0.2, 0.43, 0.9, 2.0)
"""Of the garbage branch, to be tried."""
SHIFTS = tuple(step / 4 for step in range(-8, 9))  # -2 to +2
ROOM = 0.6  # by which every score is on its side of the threshold, with room to spare
SHIFT_SPREAD = 0.8  # how far shifts usually are from 0, and weights (as a factor) from the usual
WEIGHT_SPREAD = 2.5
SURELY, PERHAPS = math.log(SURE / (1 - SURE)), math.log(UNSURE / (1 - UNSURE))
WORTH_IT = 1.0  # utterances that other settings must gain
FAR = 6.0  # scores beyond tell no more


@dataclass(frozen=True, slots=True)
class CalibrationPrompt:
    """What somebody was asked to say: a command (`meant`), or a sentence that is none (None)."""

    text: str
    meant: UtteranceLabel | None


@dataclass(frozen=True, slots=True)
class Figures:
    """How well commands and the rest are parted: counts of the utterances that were asked for."""

    commands: int
    understood: int
    offered: int
    others: int
    taken: int
    """Of the other sentences: those that were surely taken for a command, or offered as one."""

    @property
    def kept(self) -> bool:
        """Whether at most one command in six is lost."""
        lost = self.commands - self.understood - self.offered
        return self.commands > 0 and 6 * lost <= self.commands

    @property
    def parted(self) -> bool:
        """Whether that is good enough to work with."""
        return self.kept and 3 * self.taken <= self.others

    @property
    def gain(self) -> float:
        """What it is worth, a score: a choice half as much as what is surely understood."""
        return self.understood + self.offered / 2 - self.taken

    @property
    def perfect(self) -> bool:
        """Whether every command was surely understood, and nothing else taken for one."""
        return self.understood == self.commands and self.taken == 0


@dataclass(frozen=True, slots=True)
class Chosen:
    """The settings that were found, what they do with the utterances, and the usual ones too."""

    settings: EvidenceSettings
    figures: Figures
    usual: Figures


@dataclass(frozen=True, slots=True)
class CalibrationScore:
    """How sure it is (in logits, at shift 0) that an utterance is a command, and is it right."""

    told: float
    asked: CalibrationPrompt
    right: bool


def score(
    evidence: AcousticEvidence,
    asked: CalibrationPrompt,
    phrasebook: Phrasebook,
    settings: EvidenceSettings,
) -> CalibrationScore:
    """Grade one utterance, whatever the shift of the settings is."""
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


def choose(scores: Mapping[float, Sequence[CalibrationScore]]) -> Chosen:
    """Choose the weight and the shift that part commands from the rest best.

    Args:
        scores: of the same utterances with each weight; the usual weight must be among them.
    """
    usual = _figures(scores[USUAL.garbage], 0.0)
    if spare(scores[USUAL.garbage]):
        return Chosen(USUAL, usual, usual)
    weight, shift = max(
        ((weight, shift) for weight in scores for shift in SHIFTS),
        key=lambda way: (_worth(scores[way[0]], *way), way),
    )
    found = _figures(scores[weight], shift)
    if found.gain < usual.gain + WORTH_IT:
        return Chosen(USUAL, usual, usual)
    return Chosen(replace(USUAL, garbage=weight, shift=shift), found, usual)


def spare(scores: Sequence[CalibrationScore]) -> bool:
    """Say whether all utterances are parted without any shift, and with room to spare."""
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


def _figures(scores: Sequence[CalibrationScore], shift: float) -> Figures:
    commands = [s for s in scores if s.asked.meant]
    others = [s for s in scores if not s.asked.meant]
    surely = sum(s.right and s.told - shift >= SURELY for s in commands)
    known = sum(s.right and s.told - shift >= PERHAPS for s in commands)
    taken = sum(s.told - shift >= PERHAPS for s in others)
    return Figures(len(commands), surely, known - surely, len(others), taken)


def microphone(source: str) -> str:
    """Return the name under which the settings of a source are kept.

    Paths are kept as a digest: names of people may stand in them.
    """
    kind, _, rest = source.partition(":")
    if source in ("-", "arecord", "socket") or (kind == "arecord" and rest):
        return source
    path = Path(rest if kind == "socket" and rest else source).absolute()
    digest = hashlib.sha256(str(path).encode(errors="replace")).hexdigest()[:12]
    return f"{'socket' if kind == 'socket' else 'file'} {digest}"


def keep(store: Store, source: str, chosen: Chosen) -> None:
    """Store the calibration of a microphone."""
    settings = {"garbage": chosen.settings.garbage, "shift": chosen.settings.shift}
    figures = asdict(chosen.figures)
    store.append(MicrophoneChecked(source=microphone(source), settings=settings, figures=figures))


def forget(store: Store, source: str) -> bool:
    """Go back to the usual settings for a microphone; return whether there were others."""
    if _stored(store, source) is None:
        return False
    store.append(MicrophoneForgotten(source=microphone(source)))
    return True


def is_checked(store: Store, source: str) -> bool:
    """Say whether there are settings of its own for a microphone."""
    return _stored(store, source) is not None


def settings_for(store: Store, source: str | None, mode: str = "tiers") -> EvidenceSettings:
    """Return how it is listened with a microphone: as its last check has it, else as usual.

    Args:
        store: has the checks.
        source: its name, as `tangy_hw.audio.sources` has them; None for none in particular.
        mode: one of MODES.

    Raises:
        TangyError: there is no such mode.
    """
    if mode not in MODES:
        raise TangyError(plain(f"--mode {mode[:40]!r} is not known; {nearest(mode, MODES)}"))
    stored = None if source is None else _stored(store, source)
    return replace(stored or USUAL, mode=mode)


def _stored(store: Store, source: str) -> EvidenceSettings | None:
    found: EvidenceSettings | None = None
    name = microphone(source)
    for event in store.events(MicrophoneChecked, MicrophoneForgotten):
        match event.record:
            case MicrophoneChecked(source=of, settings=settings) if of == name:
                found = _read(settings)
            case MicrophoneForgotten(source=of) if of == name:
                found = None
    return found


def _read(written: Any) -> EvidenceSettings | None:
    """Read stored settings; None where they are not what this program would write."""
    try:
        settings = replace(USUAL, garbage=float(written["garbage"]), shift=float(written["shift"]))
    except (KeyError, TypeError, ValueError):
        return None
    fits = 0 < settings.garbage <= 10 and SHIFTS[0] <= settings.shift <= SHIFTS[-1]
    return settings if fits else None
