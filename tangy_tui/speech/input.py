"""Speech input: a sound source with a decoder, yielding commands as if they were typed."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncGenerator, AsyncIterator, Callable, Collection, Iterable, Sequence
from pathlib import Path
from typing import TypeAlias

from tangy_hw.audio.meter import Meter, SoundTrouble
from tangy_hw.audio.source import SpokenRecording
from tangy_hw.audio.sources import open_source
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.lexicon import Lexicon
from tangy_tui.language.steering import Steering
from tangy_tui.learning.teaching_events import TeachingEvent
from tangy_tui.learning.verification import Reply, Say, StopCommand
from tangy_tui.speech.evidence import LONGEST, RATE, USUAL, AcousticEvidence, EvidenceSettings
from tangy_tui.speech.hearing_notes import HearingKind, HearingNote, not_heard
from tangy_tui.speech.recogniser import Recogniser, SpeechUnavailable
from tangy_tui.speech.recordings import Recorder
from tangy_tui.speech.understanding import commanded, replied, sounds_of, understand, wanted
from tangy_tui.speech.utterance import MOST_TALK, State, Utterance

RINGING = 0.3  # s for which the microphone stays muted after the robot has spoken
FAILURES = 3  # failed utterances in a row after which hands-free listening ends

Heard: TypeAlias = Say | StopCommand | Reply
WAITS: dict[State, HearingKind] = {"starting": "getting ready", "thinking": "still thinking"}


class SpeechInput:
    """A source of spoken commands: `async for heard in ears`. Opening it checks the source.

    A live microphone listens in push-to-talk, or (hands-free) all the time; a recording yields one
    command after another. While the robot speaks it is `shut`. While a question is open (`asking`)
    it hears answers, if enabled, and otherwise only stop commands.
    """

    def __init__(
        self,
        source: str,
        phrasebook: Phrasebook,
        *,
        settings: EvidenceSettings = USUAL,
        hands_free: bool = False,
        answers: bool = False,
        spoken: bool = False,
        recorder: Recorder | None = None,
        stdin: int = 0,
        folder: Path | None = None,
    ) -> None:
        """Open the source.

        Args:
            source: its name, as in `tangy_hw.audio.sources`.
            phrasebook: the phrases.
            settings: the settings of this microphone.
            hands_free: listen all the time, and detect the ends of utterances.
            spoken: play a recording in real time like live speech, starting at `begin`; hands-free.
            answers: also recognise yes and no while a question is open.
            recorder: records utterances, with the teacher's consent.
            stdin: the file descriptor of the source `-`.
            folder: the data folder, for the socket and the decoder's log.

        Raises:
            SoundError: the source cannot be used.
        """
        self._source = open_source(source, stdin=stdin, folder=folder, spoken=spoken)
        self.live = self._source.live
        """Whether it is live speech, not a recording."""
        self.hands_free = hands_free or isinstance(self._source, SpokenRecording)
        self.answers = answers
        self.meter = Meter()
        self.words = ""  # the partial result of the current utterance
        self.sound = b""  # the last utterance, 16 kHz mono s16le
        self.tell: Callable[[HearingNote], None] = lambda note: None
        """Called with a note for people."""
        self.changed: Callable[[], None] = lambda: None
        """Called when `state` or `words` have changed."""
        self._state: State = "starting"
        self._phrasebook = phrasebook
        self._settings = settings
        self._recorder = recorder
        self._log = folder / "speech.log" if folder is not None and folder.is_dir() else None
        self._heard: AsyncGenerator[Heard, None] | None = None
        self._recogniser: Recogniser | None = None
        self.utterance: Utterance | None = None  # the current or awaited one
        self._talks = asyncio.Event()  # it has begun, or none will
        self._free = asyncio.Event()
        self._free.set()
        self._shuts = 0  # how many callers have shut it and not opened it yet
        self._asking, self._choices = False, tuple[str, ...]()
        self.steering: tuple[Steering, ...] = ()  # accepted while commands are not
        self.options: Callable[[], Collection[str]] = tuple  # of the question to people
        self._renew = False  # the vocabulary has changed
        self._noticed: set[HearingNote] = set()
        if recorder is not None:
            recorder.tell = lambda why: self._told("records no more", why)
        self.ended = False  # the source has ended
        self._closed = False
        self._over = asyncio.Event()  # all tasks have ended
        self._deaf = 0  # bytes still to ignore, because the room reverberates

    @property
    def state(self) -> State:
        """The state, such as listening or thinking."""
        return "shut" if not self._free.is_set() and self._state != "over" else self._state

    @property
    def records(self) -> bool:
        """Whether verified utterances are recorded."""
        return self._recorder is not None

    @property
    def trouble(self) -> SoundTrouble | None:
        """The fault of the sound; None if it is good."""
        listens = self.state in ("listening", "speaking")
        spoken = not self.words and not self.hands_free  # a voice that was heard is loud enough
        return self.meter.trouble(speaking=spoken) if self.live and listens else None

    def begin(self) -> None:
        """Start a recording that is played in real time."""
        self._source.begin()

    def talk(self) -> None:
        """Push to talk: begin to listen, or end the utterance."""
        if not self.live or self.hands_free or not self._free.is_set():
            return
        if self.utterance is not None and not self.utterance.over:
            self._end()
        elif self._state in WAITS:
            self._told(WAITS[self._state])
        elif self._state == "off":
            self.meter.begin()
            self.utterance = Utterance(found=False)
            asyncio.get_running_loop().call_later(MOST_TALK, self._late, self.utterance)
            self._talks.set()
            self._now("listening")

    def shut(self) -> None:
        """Mute the microphone while the robot speaks; a recording is not affected."""
        if not self.live:
            return
        self._shuts += 1
        if self._free.is_set():
            self._free.clear()
            self._end(dropped=True)
            self.changed()

    def open(self) -> None:
        """Unmute after a short delay, because the room reverberates."""
        self._shuts = max(0, self._shuts - 1)
        if not self._shuts and not self._free.is_set():
            self._deaf = round(RINGING * RATE) * 2
            self._free.set()
            self.changed()

    def asking(self, asks: bool, choices: Sequence[str] = ()) -> None:
        """Set whether a question is open, and its choices."""
        self._choices = tuple(choices)
        if self._asking != asks:
            self._asking = asks
            if self.live:
                self._end(dropped=True)

    def understand_by(self, phrasebook: Phrasebook) -> None:
        """Use this phrasebook from the next utterance on."""
        before, self._phrasebook = self._phrasebook, phrasebook
        if sounds_of(before) != sounds_of(phrasebook):
            self._renew = True
            self._talks.set()

    def follow(self, events: Iterable[TeachingEvent]) -> None:
        """Pass the events of commands to the recorder, which labels recordings by them."""
        if self._recorder is not None:
            self._recorder.follow(events)

    def __aiter__(self) -> AsyncIterator[Heard]:
        return self

    async def __anext__(self) -> Heard:
        if self._heard is None:
            if self._closed:
                raise StopAsyncIteration
            self._heard = self._hear()
        return await anext(self._heard)

    async def close(self) -> None:
        """Stop listening, and end the decoder, even if it is busy."""
        self._closed = True
        await self._source.close()
        if self._recogniser is not None:
            await self._recogniser.close()
        if self._heard is not None:
            try:
                await self._heard.aclose()
            except RuntimeError:  # another task waits for it, and gets the end
                await self._over.wait()

    async def _hear(self) -> AsyncGenerator[Heard, None]:
        recogniser = self._recogniser = Recogniser(
            log=self._log, notify=lambda how: self._told("worker ended", how)
        )
        recogniser.partial = self._partial
        recogniser.speaking = self._spoke
        self._source.tell = lambda words: self._told("source", words)
        pump: asyncio.Task[None] | None = None
        try:
            await self._listen_for(recogniser)
            if self._closed:
                return
            if self._recorder is not None:
                self._told("records")
            if self.live:
                pump = asyncio.create_task(self._pump())
                spoken = self._live(recogniser)
            else:
                spoken = self._recorded(recogniser)
            async with contextlib.aclosing(spoken):
                async for evidence in spoken:
                    heard = self._understand(evidence)
                    if heard is not None and self._recorder is not None:
                        self._recorder.heard(self.sound, heard)
                    if heard is not None and not self._closed:
                        yield heard
            if pump is not None:
                await pump
            if self._closed:
                return
            self._told("recording over" if self._source.recorded else "microphone closed")
        except SpeechUnavailable:
            if not self._closed:
                raise
        finally:
            try:
                if pump is not None:
                    pump.cancel()
                    await asyncio.wait({pump})
                await recogniser.close()
                await self._source.close()
            finally:
                self._over.set()
                self._now("over")

    async def _listen_for(self, recogniser: Recogniser) -> None:
        """Send the current vocabulary to the decoder."""
        self._renew, phrasebook = False, self._phrasebook
        lexicon = await asyncio.to_thread(Lexicon, phrasebook, suggest=lambda word: "")
        if self._closed:
            return
        await recogniser.start(wanted(phrasebook, self._settings, lexicon.heard()))
        await asyncio.to_thread(phrasebook.prepare)  # not when the first words wait for it
        for note in (one for one in not_heard(lexicon) if one not in self._noticed):
            self._noticed.add(note)
            self.tell(note)

    async def _recorded(self, recogniser: Recogniser) -> AsyncGenerator[AcousticEvidence, None]:
        pcm = b"".join([chunk async for chunk in self._source])
        for piece in await recogniser.pieces(pcm):
            self._now("thinking")
            self.sound = piece
            if len(piece) > 2 * RATE * LONGEST:
                self._told("cut off", seconds=round(len(piece) / 2 / RATE))
            try:
                if self._renew:
                    await self._listen_for(recogniser)
                evidence = await recogniser.decode(
                    piece, "answers" if self._asking and self.answers else "commands"
                )
            except SpeechUnavailable as error:
                if self._closed:
                    raise
                self._told("decoder failed", str(error))
                continue
            self._now("listening")
            yield evidence

    async def _live(self, recogniser: Recogniser) -> AsyncGenerator[AcousticEvidence, None]:
        failures = 0
        while (utterance := await self._next(recogniser)) is not None:
            try:
                evidence = await recogniser.hear(
                    utterance.chunks,
                    "answers" if self._asking else "commands",
                    endpoint=self.hands_free,
                )
                failures, left = 0, recogniser.left
            except SpeechUnavailable as error:
                failures += 1
                if self._closed or (self.hands_free and failures >= FAILURES):
                    raise
                self._told("not decoded", str(error))
                evidence, left = None, b""
            finally:
                self.utterance = None
                self._talks.clear()
                self._partial("")
            if self.hands_free and not utterance.dropped:
                self._go_on(left + utterance.rest())
            if evidence is None:
                continue
            self.sound = recogniser.said
            command = understand(evidence, self._phrasebook, self._settings)
            if not utterance.dropped or isinstance(command, StopCommand):  # a stop always counts
                yield evidence
            elif evidence.words and self._asking:
                self._told("question between", evidence.words)

    async def _next(self, recogniser: Recogniser) -> Utterance | None:
        """Wait for the next utterance; None if the source has ended."""
        while True:
            if self.hands_free and (self.utterance is None or self.utterance.dropped):
                self.utterance = None if self.ended else Utterance(found=True)
            if self._renew:
                if self.hands_free or self.utterance is None:
                    self._now("starting")
                await self._listen_for(recogniser)
                continue
            if self.hands_free:
                if self.utterance is not None:
                    self._now("listening")
                return self.utterance
            if self.utterance is not None or self.ended:
                return self.utterance
            self._now("off")
            await self._talks.wait()
            if self.utterance is None:
                self._talks.clear()

    def _go_on(self, begun: bytes) -> None:
        """Continue with the stream after an utterance, where the next one may have begun."""
        if begun or not self.ended:
            self.utterance = Utterance(found=True, begun=begun)
            if self.ended:
                self.utterance.end()

    async def _pump(self) -> None:
        """Read the sound, and queue the parts to decode."""
        try:
            async for chunk in self._source:
                self.meter.feed(chunk)
                if not self._free.is_set():
                    continue
                dropped = min(self._deaf, len(chunk))
                self._deaf -= dropped
                if self.utterance is not None:
                    self.utterance.add(chunk[dropped:], asyncio.get_running_loop().time())
                    self._thinks()
        finally:
            self.ended = True
            self._end()
            self._talks.set()

    def _late(self, utterance: Utterance) -> None:
        """End an utterance after a timeout, because no more sound comes."""
        if self.utterance is utterance:
            self._end()

    def _end(self, *, dropped: bool = False) -> None:
        """End the current utterance; if `dropped`, ignore it."""
        if self.utterance is not None:
            self.utterance.end(dropped=dropped)
            self._thinks()

    def _thinks(self) -> None:
        if self.utterance is not None and self.utterance.over:
            self._now("thinking")

    def _understand(self, evidence: AcousticEvidence) -> Heard | None:
        heard: Heard | None
        if self._asking:
            people = self._phrasebook.table.answers if self.steering else {}
            heard, told = replied(
                evidence, self._settings, self._choices, self.steering,
                people, self.options(), answers=self.answers,
            )  # fmt: skip
        else:
            heard, told = commanded(evidence, self._phrasebook, self._settings, live=self.live)
        if told is not None:
            self._told(told)
        return heard

    def _partial(self, words: str) -> None:
        if words != self.words:
            self.words = words
            self.changed()

    def _spoke(self) -> None:
        if self.utterance is not None and not self.utterance.over:
            self._now("speaking")

    def _now(self, state: State) -> None:
        if state != self._state:
            self._state = state
            self.changed()

    def _told(self, kind: HearingKind, about: str = "", *, seconds: int = 0) -> None:
        self.tell(HearingNote(kind, about, seconds=seconds))
