"""Ears: a source of sound and the decoder behind it, giving commands as a teacher types them."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Literal, TypeAlias

from tangy_hw.sound.meter import Meter
from tangy_hw.sound.sources import open_source
from tangy_tui.learning.commands import Phrasebook
from tangy_tui.learning.lexicon import Lexicon
from tangy_tui.learning.speech.evidence import RATE, USUAL, Evidence, Settings
from tangy_tui.learning.speech.recogniser import Recogniser, SpeechUnavailable
from tangy_tui.learning.speech.understanding import answer, understand, wanted
from tangy_tui.learning.verifying import Reply, Say, Stop

LONGEST_TALK = 6.0  # s after which push-to-talk ends by itself
RINGING = 0.3  # s for which a microphone stays shut after the robot has spoken

Heard: TypeAlias = Say | Stop | Reply
State: TypeAlias = Literal["starting", "off", "listening", "speaking", "thinking", "shut", "over"]
"""off: waiting for the key; listening: for an utterance to begin; speaking: somebody speaks."""


class Ears:
    """A source of spoken commands: `async for heard in ears`. Opening it checks the source.

    A live microphone listens while it is pushed to talk, or (hands-free) all the time; a recording
    gives one command after the other. While the robot speaks it is `shut`; while a question is
    open (`asking`) it hears answers, if that is switched on, and otherwise only what stops.
    """

    def __init__(
        self,
        source: str,
        phrasebook: Phrasebook,
        *,
        settings: Settings = USUAL,
        hands_free: bool = False,
        answers: bool = False,
        stdin: int = 0,
        folder: Path | None = None,
    ) -> None:
        """Open the source.

        Args:
            source: its name, as `tangy_hw.sound.sources` has them.
            phrasebook: what can be said.
            settings: how it is listened with this microphone.
            hands_free: listen all the time, and find out where an utterance begins and ends.
            answers: also hear yes and no while a question is open.
            stdin: the file descriptor that `-` stands for.
            folder: the data folder, for the socket and the messages of the decoder.

        Raises:
            SoundError: the source cannot be used.
        """
        self._source = open_source(source, stdin=stdin, folder=folder)
        self.live = self._source.live
        """Whether somebody is speaking right now, rather than on a recording."""
        self.hands_free = hands_free
        self.answers = answers
        self.meter = Meter()
        self.words = ""
        """The words so far of what is being said."""
        self.sound = b""
        """The last utterance that was heard, 16 kHz mono s16le."""
        self.tell: Callable[[str], None] = lambda sentence: None
        """Is called with a sentence when something must be said about hearing."""
        self.changed: Callable[[], None] = lambda: None
        """Is called when `state` or `words` have changed."""
        self._state: State = "starting"
        self._phrasebook = phrasebook
        self._settings = settings
        self._log = folder / "speech.log" if folder is not None and folder.is_dir() else None
        self._heard: AsyncIterator[Heard] | None = None
        self._sound: asyncio.Queue[bytes] | None = None  # of the utterance that is listened for
        self._talks = asyncio.Event()
        self._free = asyncio.Event()
        self._free.set()
        self._asking = False
        self._dropped = False  # the present utterance does not count
        self._ended = False  # the source has no more
        self._deaf = 0  # bytes that are not heard: the room still rings
        self._left = 0  # bytes that push-to-talk still takes

    @property
    def state(self) -> State:
        """What it is doing."""
        return "shut" if not self._free.is_set() and self._state != "over" else self._state

    @property
    def trouble(self) -> str:
        """What is wrong with the sound, in a sentence; "" if nothing is."""
        listens = self.state in ("listening", "speaking")
        return self.meter.words(speaking=self._talks.is_set()) if self.live and listens else ""

    def talk(self) -> None:
        """Push to talk: begin to listen, or end what is being said."""
        if not self.live or self.hands_free or not self._free.is_set():
            return
        if self._talks.is_set():
            self._put(b"")
        elif self._state == "off":
            self.meter.begin()
            self._left = round(LONGEST_TALK * RATE) * 2
            self._talks.set()

    def shut(self) -> None:
        """Hear nothing for a while: the robot speaks. A recording has no robot in it."""
        if self.live and self._free.is_set():
            self._free.clear()
            self._drop()
            self.changed()

    def open(self) -> None:
        """Hear again, a moment from now: the room still rings."""
        if not self._free.is_set():
            self._deaf = round(RINGING * RATE) * 2
            self._free.set()
            self.changed()

    def asking(self, asks: bool) -> None:
        """Take note that a question is open, or no longer."""
        if self._asking != asks:
            self._asking = asks
            if self.live:
                self._drop()

    def understand_by(self, phrasebook: Phrasebook) -> None:
        """Match what is heard to these phrases from now on; they are listened for later."""
        self._phrasebook = phrasebook

    def __aiter__(self) -> AsyncIterator[Heard]:
        return self

    async def __anext__(self) -> Heard:
        if self._heard is None:
            self._heard = self._hear()
        return await anext(self._heard)

    async def close(self) -> None:
        """Stop listening for good."""
        await self._source.close()
        if self._heard is not None and hasattr(self._heard, "aclose"):
            with contextlib.suppress(RuntimeError):  # somebody waits for it, and gets the end
                await self._heard.aclose()

    async def _hear(self) -> AsyncIterator[Heard]:
        recogniser = Recogniser(log=self._log, notify=self._told)
        recogniser.partial = self._partial
        recogniser.speaking = lambda: self._now("speaking")
        self._source.tell = self._told
        pump: asyncio.Task[None] | None = None
        try:
            lexicon = await asyncio.to_thread(Lexicon, self._phrasebook, suggest=lambda word: "")
            await recogniser.start(wanted(self._phrasebook, self._settings, lexicon.heard()))
            for sentence in lexicon.notices():
                self._told(sentence)
            if self.live:
                pump = asyncio.create_task(self._pump())
                spoken = self._live(recogniser)
            else:
                spoken = self._recorded(recogniser)
            async with contextlib.aclosing(spoken):  # type: ignore[type-var]
                async for evidence in spoken:
                    heard = self._understand(evidence)
                    if heard is not None:
                        yield heard
            if pump is not None:
                await pump
            self._told("The microphone has closed." if self.live else "The recording is over.")
        finally:
            self._now("over")
            if pump is not None:
                pump.cancel()
                await asyncio.wait({pump})
            await recogniser.close()
            await self._source.close()

    async def _recorded(self, recogniser: Recogniser) -> AsyncIterator[Evidence]:
        pcm = b"".join([chunk async for chunk in self._source])
        for piece in await recogniser.pieces(pcm):
            self._now("thinking")
            self.sound = piece
            try:
                evidence = await recogniser.decode(
                    piece, "answers" if self._asking and self.answers else "commands"
                )
            except SpeechUnavailable as error:
                self._told(str(error))
                continue
            self._now("listening")
            yield evidence

    async def _live(self, recogniser: Recogniser) -> AsyncIterator[Evidence]:
        while not self._ended:
            if not self.hands_free:
                self._now("off")
                await self._pushed()
                if self._ended:
                    return
            self._dropped, self._sound = False, asyncio.Queue()
            self._now("listening")
            try:
                evidence = await recogniser.hear(
                    self._sound,
                    "answers" if self._asking else "commands",
                    endpoint=self.hands_free,
                )
            except SpeechUnavailable as error:
                self._told(f"{error} Please say that again.")
                await asyncio.sleep(0)
                continue
            finally:
                self._sound = None
                self._talks.clear()
                self._partial("")
            self.sound = recogniser.said
            if not self._dropped:
                yield evidence

    async def _pushed(self) -> None:
        """Wait until somebody talks, or the source is over."""
        while not self._talks.is_set() and not self._ended:
            await self._talks.wait()

    async def _pump(self) -> None:
        """Take the sound as it comes, and keep what is to be heard."""
        try:
            async for chunk in self._source:
                self.meter.feed(chunk)
                if not self._free.is_set():
                    continue
                dropped = min(self._deaf, len(chunk))
                self._deaf -= dropped
                self._take(chunk[dropped:])
        finally:
            self._ended = True
            self._put(b"")
            self._talks.set()

    def _take(self, chunk: bytes) -> None:
        if not chunk or self._sound is None:
            return
        if not self.hands_free:
            chunk = chunk[: self._left]
            self._left -= len(chunk)
        if chunk:
            self._put(chunk)
        if not self.hands_free and self._left <= 0:
            self._put(b"")

    def _put(self, chunk: bytes) -> None:
        if self._sound is None:
            return
        self._sound.put_nowait(chunk)
        if not chunk:
            self._sound = None  # what comes now is not part of it
            self._now("thinking")

    def _drop(self) -> None:
        """Let the present utterance end, and count for nothing."""
        self._dropped = True
        self._put(b"")

    def _understand(self, evidence: Evidence) -> Heard | None:
        if self._asking:
            said = answer(evidence)
            return said if self.answers or isinstance(said, Stop) else None
        if not evidence.words:
            self._told("I heard something, but no words that I know." if self.live else "")
            return None
        return understand(evidence, self._phrasebook, self._settings)

    def _partial(self, words: str) -> None:
        if words != self.words:
            self.words = words
            self.changed()

    def _now(self, state: State) -> None:
        if state != self._state:
            self._state = state
            self.changed()

    def _told(self, sentence: str) -> None:
        if sentence:
            self.tell(sentence)
