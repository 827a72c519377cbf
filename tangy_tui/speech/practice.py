"""Practice: accuracy of spoken commands, measured on labelled recordings."""

from __future__ import annotations

import math
import os
import statistics
from collections import Counter, defaultdict
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from time import perf_counter
from typing import Any, Literal, Protocol

from tangy_hw.audio.wav import SoundError, read_wav, seconds_cut_off
from tangy_hw.worker_process import cpu_seconds
from tangy_profiles.reading import plain
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.labels import STOP, LabelledRecordings, UtteranceLabel
from tangy_tui.learning.verification import Say, StopCommand
from tangy_tui.speech.evidence import (
    LONGEST,
    RATE,
    AcousticEvidence,
    DecoderVocabulary,
    EvidenceSettings,
    Expecting,
)
from tangy_tui.speech.recogniser import SpeechUnavailable
from tangy_tui.speech.transcription import tier_of
from tangy_tui.speech.understanding import understand, wanted

Outcome = Literal["right", "offered", "wrong", "nothing"]
NOTHING = "nothing"
OUTCOMES: tuple[Outcome, ...] = ("right", "offered", "wrong", "nothing")


class PracticeRecogniser(Protocol):
    """The part of a recogniser that practice needs."""

    @property
    def pid(self) -> int | None:
        """The id of the decoding process."""

    async def start(self, wanted: DecoderVocabulary) -> None:
        """Set the vocabulary."""

    async def decode(self, pcm: bytes, expecting: Expecting = "commands") -> AcousticEvidence:
        """Decode one utterance."""


@dataclass(frozen=True, slots=True)
class PracticeRow:
    """The result of one recording.

    `understood` is the first command, sure or not ("" is nothing). `outcome` is right (sure),
    offered (the right one is among the choices), wrong (another one is asked about or offered) or
    nothing; for a recording without a command, all but nothing are false accepts.
    """

    file: str
    said: UtteranceLabel
    heard: str
    tier: str
    understood: str
    confidence: float
    choices: tuple[UtteranceLabel, ...]
    outcome: Outcome
    seconds: float
    latency: float  # s from the end of the sound to the result

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON."""
        choices = [{"behaviour": c.behaviour, "user": c.user} for c in self.choices]
        said = {"said": self.said.behaviour, "user": self.said.user}
        return {**asdict(self), **said, "choices": choices, "latency": round(self.latency, 4)}


@dataclass(frozen=True, slots=True)
class Practice:
    """All recordings of a folder, decoded with the same settings; `cpu` in s, if known.

    `cut_off` are truncated files, whose existing part was decoded. `unnamed` were not decoded,
    because their names give no label.
    """

    settings: EvidenceSettings
    rows: tuple[PracticeRow, ...]
    left_out: tuple[tuple[str, str], ...]
    cpu: float | None
    cut_off: tuple[str, ...] = ()
    unnamed: tuple[str, ...] = ()

    @property
    def commands(self) -> list[PracticeRow]:
        """The recordings of a command."""
        return [row for row in self.rows if row.said.behaviour is not None]

    @property
    def others(self) -> list[PracticeRow]:
        """The recordings of no command."""
        return [row for row in self.rows if row.said.behaviour is None]

    def intents(self) -> dict[str, Counter[Outcome]]:
        """Count the outcomes of each intent, in alphabetical order."""
        counted: dict[str, Counter[Outcome]] = defaultdict(Counter)
        for row in sorted(self.commands, key=lambda row: row.said.words):
            counted[row.said.words][row.outcome] += 1
        return dict(counted)

    def share(self, *outcomes: Outcome) -> float | None:
        """Return the share of the commands with one of these outcomes; None if there are none."""
        commands = self.commands
        return (
            sum(row.outcome in outcomes for row in commands) / len(commands) if commands else None
        )

    def false_accepts(self) -> tuple[int, int]:
        """Count the recordings without a command that were accepted: as sure, and as a choice."""
        taken = Counter(row.tier for row in self.others)
        return taken["sure"] + taken["stop"], taken["unsure"]

    def latencies(self) -> tuple[float, float, float]:
        """Return median, 95th percentile and maximum of the latencies, in s."""
        times = sorted(row.latency for row in self.rows) or [0.0]
        return (statistics.median(times), times[math.ceil(0.95 * len(times)) - 1], times[-1])

    def confusion(self) -> dict[str, Counter[str]]:
        """Return the confusion counts of labels and first understood commands, sure or not."""
        counted: dict[str, Counter[str]] = defaultdict(Counter)
        for row in sorted(self.rows, key=lambda r: (r.said.behaviour is None, r.said.words)):
            counted[row.said.words][row.understood or NOTHING] += 1
        return dict(counted)

    def document(self) -> dict[str, Any]:
        """Return everything as one JSON document."""
        sure, offered = self.false_accepts()
        median, late, worst = (round(1000 * seconds, 1) for seconds in self.latencies())
        return {
            "files": len(self.rows),
            "settings": asdict(self.settings),
            "intents": {
                intent: {"said": counts.total(), **{name: counts[name] for name in OUTCOMES}}
                for intent, counts in self.intents().items()
            },
            "accuracy": _rounded(self.share("right")),
            "offered": _rounded(self.share("right", "offered")),
            "wrong": _rounded(self.share("wrong")),
            "false_accepts": {"sure": sure, "offered": offered, "of": len(self.others)},
            "latency_ms": {"median": median, "p95": late, "worst": worst},
            "sound_seconds": round(sum(row.seconds for row in self.rows), 2),
            "cpu_seconds": None if self.cpu is None else round(self.cpu, 2),
            "confusion": {said: dict(counts) for said, counts in self.confusion().items()},
            "left_out": [{"file": file, "why": why} for file, why in self.left_out],
            "unnamed": list(self.unnamed),
            "cut_off": list(self.cut_off),
            "rows": [row.to_json() for row in self.rows],
        }


async def practise(
    found: LabelledRecordings,
    phrasebook: Phrasebook,
    settings: EvidenceSettings,
    recogniser: PracticeRecogniser,
    tell: Callable[[int, int], None] = lambda done, of: None,
    *,
    phrases: Sequence[str] | None = None,
) -> Practice:
    """Decode every recording as one whole utterance.

    Args:
        found: the labelled recordings.
        phrasebook: the phrases.
        settings: the recognition settings.
        recogniser: decodes; started here, and left running.
        tell: called after each with the number done, and the total.
        phrases: the vocabulary, if not all phrases.

    Raises:
        SpeechUnavailable: the worker cannot run here.
    """
    await recogniser.start(wanted(phrasebook, settings, phrases))
    began = cpu_seconds(recogniser.pid)
    rows: list[PracticeRow] = []
    left_out = [(os.fspath(file), why) for file, why in found.left_out]
    cut_off: list[str] = []
    for done, (file, label) in enumerate(found.recordings, 1):
        try:
            pcm = read_wav(found.folder / file)
            start = perf_counter()
            evidence = await recogniser.decode(pcm)
            said = understand(evidence, phrasebook, settings)
            latency = perf_counter() - start
            rows.append(judged(file, label, said, len(pcm) / 2 / RATE, latency))
            if seconds_cut_off(found.folder / file):
                cut_off.append(os.fspath(file))
        except SoundError as error:
            left_out.append((os.fspath(file), _reason(error, found.folder / file)))
        except SpeechUnavailable:
            left_out.append((os.fspath(file), "could not be decoded"))
        tell(done, len(found.recordings))
    ended = cpu_seconds(recogniser.pid)
    cpu = None if began is None or ended is None or ended < began else ended - began
    unnamed = tuple(map(os.fspath, found.unnamed))
    return Practice(settings, tuple(rows), tuple(left_out), cpu, tuple(cut_off), unnamed)


def judged(
    file: Path, label: UtteranceLabel, said: Say | StopCommand, seconds: float, latency: float
) -> PracticeRow:
    """Compare the understood command with the label; both times are in s."""
    tier = tier_of(said)
    commands = (said.commands or ()) if isinstance(said, Say) else ()
    choices = tuple(UtteranceLabel(c.behaviour, c.arguments.get("user")) for c in commands)
    if isinstance(said, StopCommand):
        choices = (UtteranceLabel(STOP),)
    meant = [_fits(label, choice) for choice in choices]
    outcome: Outcome = "nothing"
    if tier in ("sure", "stop"):
        outcome = "right" if meant[0] else "wrong"
    elif tier == "unsure":
        outcome = "offered" if any(meant) else "wrong"
    return PracticeRow(
        os.fspath(file),
        label,
        said.text,
        tier,
        _called(choices[0], label) if choices else "",
        round(said.confidence, 3) if isinstance(said, Say) else 1.0,
        choices,
        outcome,
        round(min(seconds, LONGEST), 3),
        latency,
    )


def _fits(said: UtteranceLabel, understood: UtteranceLabel) -> bool:
    """Return whether a command fits the label; without a labelled person, any person fits."""
    return said.behaviour == understood.behaviour and said.user in (None, understood.user)


def _called(understood: UtteranceLabel, said: UtteranceLabel) -> str:
    """Return the name of a command, with the person only if the label has one."""
    return understood.words if said.user is not None else understood.behaviour or ""


def _reason(error: SoundError, file: Path) -> str:
    """Remove the file name and the advice from an error message."""
    return str(error).removeprefix(f"{plain(str(file))}: ").partition(";")[0].rstrip(".")


def _rounded(share: float | None) -> float | None:
    return None if share is None else round(share, 4)
