"""Ears and a voice that tests control."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

from tangy_hw.audio.meter import SoundTrouble
from tangy_profiles.voice import VoicePreference
from tangy_tui.language.commands import Phrasebook
from tangy_tui.learning.teaching_events import TeachingEvent
from tangy_tui.learning.verification import Reply, Say, StopCommand
from tangy_tui.speech.hearing_notes import HearingNote
from tangy_tui.speech.input import SpeechInput


@dataclass
class FakeMeter:
    """Shows the given level."""

    level: float = 0.0


class FakeEars:
    """Stands in for `SpeechInput`: a test decides the heard utterances. As in the original, an open
    question blocks commands, and answers are heard only if that is switched on.
    """

    def __init__(
        self, *, live: bool = True, hands_free: bool = False, answers: bool = False
    ) -> None:
        self.live = live
        self.hands_free = hands_free
        self.answers = answers
        self.state = "off" if live and not hands_free else "listening"
        self.words = ""
        self.trouble: SoundTrouble | None = None
        self.records = False
        self.sound = b""
        self.meter = FakeMeter()
        self.tell: Callable[[HearingNote], None] = lambda note: None
        self.changed: Callable[[], None] = lambda: None
        self.asks = False
        self.closed = False
        self.followed: list[TeachingEvent] = []
        self.books: list[Phrasebook] = []
        self.pulled = 0
        self._coming: asyncio.Queue[Say | StopCommand | Reply | None] = asyncio.Queue()

    @property
    def ears(self) -> SpeechInput:
        """Itself, in the place of real ears."""
        return cast(SpeechInput, self)

    def be(
        self,
        state: str,
        words: str = "",
        level: float = 0.0,
        trouble: SoundTrouble | None = None,
    ) -> None:
        """Change the state."""
        self.state, self.words, self.trouble = state, words, trouble
        self.meter.level = level
        self.changed()

    def follow(self, events: Iterable[TeachingEvent]) -> None:
        """Record the following event."""
        self.followed += events

    def talk(self) -> None:
        """Begin or end listening."""
        if self.state in ("off", "listening"):
            self.be("listening" if self.state == "off" else "thinking")

    def shut(self) -> None:
        """Hear nothing."""
        self.be("shut")

    def open(self) -> None:
        """Hear again."""
        self.be("off" if self.live and not self.hands_free else "listening")

    def asking(self, asks: bool, choices: Sequence[str] = ()) -> None:
        """Record that a question is open."""
        self.asks = asks

    def understand_by(self, phrasebook: Phrasebook) -> None:
        """Record the phrasebook."""
        self.books.append(phrasebook)

    def hear(self, *heard: Say | StopCommand | Reply) -> None:
        """Hear this, unless an open question blocks it."""
        for one in heard:
            wanted = isinstance(one, StopCommand) or (
                self.answers if isinstance(one, Reply) else True
            )
            if not self.live or wanted:
                if isinstance(one, Reply):
                    self._begin_to_speak()
                self._coming.put_nowait(one)

    def _begin_to_speak(self) -> None:
        """Pass through the state in which an answer begins, unless a test has done so."""
        before = self.state
        if before not in ("speaking", "thinking"):
            self.be("speaking" if self.live else "thinking")
            self.be(before)

    def say(self, words: str, *, sure: bool = True) -> Say:
        """Make a command of words, as the decoder understands them."""
        confidence = 0.83 if sure else 0.52
        found = self.books[-1].choices(words) if self.books else ()
        commands = tuple(replace(command, confidence=confidence) for command in found)
        return Say(words, confidence, commands, sure)

    def end(self) -> None:
        """End the source."""
        self._coming.put_nowait(None)

    def __aiter__(self) -> FakeEars:
        return self

    async def __anext__(self) -> Say | StopCommand | Reply:
        self.pulled += 1
        heard = await self._coming.get()
        if heard is None:
            self.be("over")
            raise StopAsyncIteration
        return heard

    async def close(self) -> None:
        """Record the end."""
        self.closed = True


class FakeVoice:
    """Stands in for `Voice`: a test decides when a line has been heard."""

    def __init__(
        self, begin: Callable[[], None], end: Callable[[], None], silent: str = ""
    ) -> None:
        self.lines: list[str] = []
        self.preferences: list[VoicePreference | None] = []
        self.prepared: tuple[str, ...] = ()
        self.silent = silent
        self.hushed = 0
        self.closed = False
        self._begin, self._end = begin, end
        self._line: asyncio.Future[bool] | None = None

    @property
    def speaking(self) -> bool:
        return self._line is not None

    def say(
        self, text: str, preference: VoicePreference | None = None, *, interrupt: bool = False
    ) -> asyncio.Future[bool]:
        assert not interrupt
        assert self._line is None, "two lines at once"
        self.lines.append(text)
        self.preferences.append(preference)
        self._line = asyncio.get_running_loop().create_future()
        self._begin()
        return self._line

    def heard(self, to_the_end: bool = True) -> None:
        """Mark the line as heard."""
        line, self._line = self._line, None
        if line is not None:
            line.set_result(to_the_end)
            self._end()

    def hush(self) -> None:
        self.hushed += 1
        self.heard(False)

    async def quiet(self) -> None:
        while self._line is not None:  # noqa: ASYNC110 - it is a test's
            await asyncio.sleep(0)

    def prerender(self, texts: Iterable[str], preference: VoicePreference | None = None) -> Any:
        self.prepared = tuple(texts)

    async def close(self) -> None:
        self.closed = True
