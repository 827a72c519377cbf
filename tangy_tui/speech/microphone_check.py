"""A microphone check of a minute: the quiet room, some commands, some other sentences.

No sound is stored, only figures and settings, among them how the speaker's voice differs from those
of the acoustic model.
"""

from __future__ import annotations

import asyncio
import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from typing import Literal, Protocol, TypeAlias

from tangy_hw.audio.meter import NO_SOUND_SECONDS, Meter, SoundFault, SoundTrouble
from tangy_hw.audio.source import Source
from tangy_hw.audio.utterances import split
from tangy_hw.audio.wav import SoundError
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.labels import UtteranceLabel
from tangy_tui.language.lexicon import Lexicon
from tangy_tui.language.stop_sentence import stops
from tangy_tui.language.words import spoken, words_of
from tangy_tui.speech.calibration import (
    WEIGHTS,
    CalibrationPrompt,
    CalibrationResult,
    CalibrationScore,
    choose,
    score,
    spare,
)
from tangy_tui.speech.evidence import (
    RATE,
    USUAL,
    AcousticEvidence,
    DecoderVocabulary,
    EvidenceSettings,
    Expecting,
)
from tangy_tui.speech.loudness import LOUD, SILENT, SoundAdvice, advice, loudness
from tangy_tui.speech.understanding import wanted

COMMANDS = 6
OTHERS = 3
QUIET_SECONDS = 3.0  # s of the room alone
WAIT_SECONDS = 6.0  # s for a phrase to begin
LONGEST_SECONDS = 6.0  # s of a phrase
PATIENCE = 30.0  # s without any sound, after which the check ends
LOOK_SECONDS = 0.5  # s between two checks of the meter
TIMES = 2  # attempts at a phrase, or at the quiet room

StepKind: TypeAlias = Literal[
    "recording holds",
    "be quiet",
    "say all",
    "say",
    "say again",
    "goes on by itself",
    "works out",
]
"""The steps of a check; `say` or `say again` for each phrase."""


@dataclass(frozen=True, slots=True)
class CheckStep:
    """An instruction or a state of the check.

    `about` is the phrase to say, or the recording; `number` is the number of the phrase, the count
    of phrases, or the whole seconds to be quiet.
    """

    kind: StepKind
    about: str = ""
    number: int = 0


@dataclass(frozen=True, slots=True)
class SourceNews:
    """A message of the sound source, in its own words."""

    words: str


CheckNews: TypeAlias = CheckStep | SoundTrouble | SourceNews
Tell = Callable[[CheckNews], None]


class CheckRecogniser(Protocol):
    """The part of a recogniser that a check needs."""

    said: bytes
    speaking: Callable[[], None]

    async def start(self, wanted: DecoderVocabulary) -> None:
        """Set the vocabulary."""

    async def hear(
        self, sound: asyncio.Queue[bytes], expecting: Expecting = ..., *, endpoint: bool = ...
    ) -> AcousticEvidence:
        """Recognise one utterance as it is spoken."""

    async def decode(self, pcm: bytes, expecting: Expecting = ...) -> AcousticEvidence:
        """Decode one utterance."""

    async def pieces(self, pcm: bytes) -> list[bytes]:
        """Split a recording at its pauses."""

    async def voice(self, said: Sequence[tuple[bytes, str]]) -> str:
        """Return the voice of a person who read sentences; "" if the usual model fits."""


@dataclass(frozen=True, slots=True)
class CheckResult:
    """The result of a check; loudness in dB below full scale (negative).

    `heard` has, for each prompt, the words recognised with the chosen settings; None if nothing was
    said. `advice` is what to change.
    """

    room: float
    voice: float
    heard: tuple[tuple[CalibrationPrompt, str | None], ...]
    chosen: CalibrationResult
    parted: bool
    advice: tuple[SoundAdvice, ...]

    @property
    def room_heard(self) -> bool:
        """Whether there was any sound of the room, as a reference for the voice."""
        return self.room > SILENT


@cache
def other_talk() -> tuple[str, ...]:
    """Return sentences of everyday speech; the caller skips those that mean something."""
    content = files("tangy_tui.speech").joinpath("other_talk.toml").read_text(encoding="utf-8")
    return tuple(tomllib.loads(content)["sentences"])


def to_say(phrasebook: Phrasebook, lexicon: Lexicon) -> list[CalibrationPrompt]:
    """Return the sentences to say: commands of different behaviours, then others.

    The commands have many different words, and at least two each, because one word proves little.
    """
    heard = set(lexicon.heard())
    phrases = [p for p in phrasebook.table.all() if p.heard and p.said in heard and len(p.bare) > 1]
    chosen: list[CalibrationPrompt] = []
    known: set[str] = set()
    behaviours: set[str] = set()
    while len(chosen) < COMMANDS:
        rest = [p for p in phrases if p.behaviour not in behaviours] or [
            p for p in phrases if p.said not in {a.text for a in chosen}
        ]
        if not rest:
            break
        best = max(rest, key=lambda p: (len({*p.bare} - known), -p.rank[0], -p.rank[1]))
        known.update(best.bare)
        behaviours.add(best.behaviour)
        chosen.append(CalibrationPrompt(best.said, UtteranceLabel(best.behaviour, best.user)))
    others = [s for s in other_talk() if phrasebook.understand(s) is None and not stops(s)]
    return [*chosen, *(CalibrationPrompt(text, None) for text in others[:OTHERS])]


class MicrophoneCheck:
    """One check of one source. A recording is used as the answers, one after another."""

    def __init__(
        self,
        source: Source,
        phrasebook: Phrasebook,
        recogniser: CheckRecogniser,
        asked: Sequence[CalibrationPrompt],
        tell: Tell,
        phrases: Sequence[str] | None = None,
        patience: float = PATIENCE,
    ) -> None:
        """Prepare a check.

        Args:
            source: the sound source, closed at the end.
            phrasebook: the phrases.
            recogniser: the recogniser, started here.
            asked: the prompts, from `to_say`.
            tell: receives instructions and problems.
            phrases: the vocabulary, if not all phrases.
            patience: time without any sound, in s, after which the check ends.
        """
        self._source = source
        self._phrasebook = phrasebook
        self._recogniser = recogniser
        self._asked = asked
        self._tell = tell
        self._meter = Meter()
        self._phrases = phrases
        self._sound: asyncio.Queue[bytes] | None = None
        self._left = 0  # bytes until the timeout of the phrase
        self._spoke = False
        self._ended = False
        self._room = bytearray()
        self._quiet = asyncio.Event()
        self._wrong: SoundFault | None = None
        self._patience = patience
        self._offered = False

    async def run(self) -> CheckResult:
        """Run the check and find the settings; the source is closed at the end.

        Raises:
            SoundError: the source has no sound.
            SpeechUnavailable: the worker cannot run here.
        """
        try:
            await self._recogniser.start(wanted(self._phrasebook, USUAL, self._phrases))
            if self._source.live:
                room, sounds = await self._live()
            else:
                room, sounds = await self._recorded()
        finally:
            await self._source.close()
        if not any(sounds):
            raise SoundError(f"{self._source.name}: nobody was heard, so nothing was changed.")
        return await self._find(room, sounds)

    async def _recorded(self) -> tuple[float, list[bytes]]:
        self._tell(CheckStep("recording holds", self._source.name))
        for number, one in enumerate(self._asked, 1):
            self._tell(CheckStep("say", one.text, number))
        pcm = b"".join([chunk async for chunk in self._source])
        found = await self._recogniser.pieces(pcm)
        if len(found) < len(self._asked):
            found = max(found, split(pcm), key=len)  # noise has no pauses: split by loudness
        sounds = [*found, *([b""] * len(self._asked))][: len(self._asked)]
        return loudness(pcm, 1 - LOUD), sounds

    async def _live(self) -> tuple[float, list[bytes]]:
        self._source.tell = lambda words: self._tell(SourceNews(words))
        self._recogniser.speaking = self._began
        pump = asyncio.create_task(self._pump())
        watch = asyncio.create_task(self._watch())
        try:
            room = await self._room_alone(pump)
            sounds: list[bytes] = []
            if not self._ended:
                self._tell(CheckStep("say all", number=len(self._asked)))
            for number, asked in enumerate(self._asked, 1):
                sounds.append(await self._say(number, asked))
                await self._still_there(pump)
            return room, sounds
        finally:
            for task in (pump, watch):
                task.cancel()
            await asyncio.wait({pump, watch})

    async def _room_alone(self, pump: asyncio.Task[None]) -> float:
        """Return the loudness of the room in dB; repeat the step if there is no sound.

        A muted microphone sends silence; so does one with a noise gate.
        """
        for _ in range(TIMES):
            self._tell(CheckStep("be quiet", number=round(QUIET_SECONDS)))
            self._room.clear()
            self._quiet.clear()
            await self._quiet.wait()
            await self._still_there(pump)
            if self._ended or not self._silent(NO_SOUND_SECONDS):
                break
            while not self._ended and self._silent(NO_SOUND_SECONDS):  # noqa: ASYNC110 - polls a meter
                await asyncio.sleep(LOOK_SECONDS)
            await self._still_there(pump)
        return loudness(bytes(self._room), LOUD)

    def _silent(self, seconds: float) -> bool:
        return self._meter.seconds_since_sound >= seconds

    async def _still_there(self, pump: asyncio.Task[None]) -> None:
        """Raise the error that ended the sound, if any."""
        if pump.done():
            await pump
        elif self._ended:
            raise SoundError(
                f"{self._source.name}: nothing was heard for {self._patience:g} s, so nothing was "
                "changed: is the microphone plugged in? It may be muted."
            )

    async def _say(self, number: int, asked: CalibrationPrompt) -> bytes:
        """Ask for one prompt, twice if nothing is heard; return its sound."""
        for again in range(TIMES):
            if self._ended:
                break
            self._tell(CheckStep("say again" if again else "say", asked.text, number))
            self._spoke, self._sound = False, asyncio.Queue()
            self._left = 2 * round(WAIT_SECONDS * RATE)
            self._meter.begin()
            await self._recogniser.hear(self._sound, endpoint=True)
            self._sound = None
            if self._spoke:
                return self._recogniser.said
        return b""

    async def _pump(self) -> None:
        """Read the sound, and queue the utterances."""
        try:
            async for chunk in self._source:
                self._meter.feed(chunk)
                if not self._quiet.is_set():
                    self._room += chunk
                    if len(self._room) >= 2 * RATE * QUIET_SECONDS:
                        self._quiet.set()
                elif self._sound is not None:
                    self._sound.put_nowait(chunk)
                    self._left -= len(chunk)
                    if self._left <= 0:
                        self._stop()
        finally:
            self._end()

    def _began(self) -> None:
        self._spoke, self._left = True, 2 * round(LONGEST_SECONDS * RATE)

    def _stop(self) -> None:
        if self._sound is not None:
            self._sound.put_nowait(b"")
            self._sound = None

    def _end(self) -> None:
        self._ended = True
        self._quiet.set()
        self._stop()

    async def _watch(self) -> None:
        """Report each problem with the sound once."""
        while True:
            await asyncio.sleep(LOOK_SECONDS)
            trouble = self._meter.trouble(speaking=self._spoke)
            kind = None if trouble is None else trouble.kind
            if trouble is not None and kind != self._wrong:
                self._tell(trouble)
                if not self._offered and self._silent(NO_SOUND_SECONDS):
                    self._offered = True
                    self._tell(CheckStep("goes on by itself"))
            self._wrong = kind
            if self._silent(self._patience):
                self._end()

    async def _find(self, room: float, sounds: Sequence[bytes]) -> CheckResult:
        """Decode the utterances, with one weight or with all of them, and choose the settings."""
        self._tell(CheckStep("works out"))
        read = [
            (pcm, spoken(words_of(one.text)))
            for pcm, one in zip(sounds, self._asked, strict=True)
            if pcm
        ]
        voice = await self._recogniser.voice(read)
        scores: dict[float, list[CalibrationScore]] = {}
        words: dict[float, list[str | None]] = {}
        for weight in sorted(WEIGHTS, key=lambda weight: weight != USUAL.garbage):
            settings = EvidenceSettings(garbage=weight, voice=voice)
            if settings != USUAL:
                await self._recogniser.start(wanted(self._phrasebook, settings, self._phrases))
            heard = [await self._decoded(pcm) for pcm in sounds]
            words[weight] = [
                one.words if pcm else None for one, pcm in zip(heard, sounds, strict=True)
            ]
            scores[weight] = [
                score(one, asked, self._phrasebook, settings)
                for one, asked, pcm in zip(heard, self._asked, sounds, strict=True)
                if pcm or asked.meant  # silence proves nothing about other sentences
            ]
            if spare(scores[USUAL.garbage]):
                break
        chosen = choose(scores)
        chosen = replace(chosen, settings=replace(chosen.settings, voice=voice))
        loud = loudness(b"".join(sounds), LOUD)
        figures = chosen.figures
        return CheckResult(
            room,
            loud,
            tuple(zip(self._asked, words[chosen.settings.garbage], strict=True)),
            chosen,
            figures.parted and figures.others > 0,
            tuple(advice(room, loud, sounds, figures.perfect)),
        )

    async def _decoded(self, pcm: bytes) -> AcousticEvidence:
        return await self._recogniser.decode(pcm) if pcm else AcousticEvidence()
