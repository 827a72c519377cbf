"""Tangy's voice: a queue of lines, spoken one after the other, that can be cut at once."""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from tangy_hw.audio.number_reader import as_called, marked_up
from tangy_hw.audio.player import PlayerError, SoundPlayer
from tangy_hw.audio.synthesis import USUAL, NoSuchVoice, Synthesiser, VoiceError
from tangy_profiles.cards import Deck
from tangy_profiles.plain_text import plain
from tangy_profiles.voice import VoicePreference


@dataclass(frozen=True, slots=True)
class PrerenderedSpeech:
    """Texts synthesised in advance: their number, bytes and seconds."""

    texts: int
    bytes: int
    seconds: float


@dataclass(frozen=True, slots=True)
class _Line:
    text: str
    preference: VoicePreference
    heard: asyncio.Future[bool]
    sound: Path | None = None
    """WAV file to play instead of a text."""


class SpeechVoice:
    """Speaks lines one after the other; it never raises an error in a game.

    It belongs to one event loop. It reports each problem once, in a sentence. Without sound it
    stops trying, and people have the text on the screen.
    """

    def __init__(
        self,
        synthesiser: Synthesiser,
        player: SoundPlayer | None,
        *,
        deck: Deck | None = None,
        usual: VoicePreference = USUAL,
        on_begin: Callable[[], None] | None = None,
        on_end: Callable[[], None] | None = None,
        tell: Callable[[str], None] | None = None,
    ) -> None:
        """Prepare a voice; nothing is started before the first line.

        Args:
            synthesiser: makes the WAV files.
            player: plays them; None: nothing is played.
            deck: deck whose calls are pronounced as a caller says them.
            usual: rate and voice of lines without a preference.
            on_begin: called before sound starts (a microphone is muted).
            on_end: called after sound has ended, for any reason (a microphone is opened).
            tell: called with a sentence about each problem, once.
        """
        self._synthesiser = synthesiser
        self._player = player
        self._deck = deck
        self._usual = usual.over(USUAL)
        self._on_begin = on_begin
        self._on_end = on_end
        self._tell = tell
        self._told: set[str] = set()
        self._queue: deque[_Line] = deque()
        self._waiting = asyncio.Event()
        self._quiet = asyncio.Event()
        self._quiet.set()
        self._worker: asyncio.Task[None] | None = None
        self._speaking: asyncio.Task[bool] | None = None
        self._begun = False
        self._closed = False
        self._preparing: set[asyncio.Task[PrerenderedSpeech]] = set()

    @property
    def speaking(self) -> bool:
        """Whether a line is being spoken, or queued."""
        return self._speaking is not None or bool(self._queue)

    @property
    def silent(self) -> str:
        """Why nothing is heard, in one sentence; "" if sound works."""
        return self._synthesiser.reason or ("" if self._player else "No sound comes out.")

    def say(
        self, text: str, preference: VoicePreference | None = None, *, interrupt: bool = False
    ) -> asyncio.Future[bool]:
        """Queue a line, or speak it at once instead of the whole queue.

        Returns:
            A future that need not be awaited and never fails: whether the line was heard to its
            end. It is False at once if nothing can be heard.
        """
        if interrupt:
            self.hush()
        return self._enqueue(text, (preference or self._usual).over(self._usual))

    def play(self, sound: Path) -> asyncio.Future[bool]:
        """Queue a WAV file, as `say` queues a line."""
        return self._enqueue("", self._usual, sound)

    def _enqueue(
        self, text: str, wanted: VoicePreference, sound: Path | None = None
    ) -> asyncio.Future[bool]:
        heard: asyncio.Future[bool] = asyncio.get_running_loop().create_future()
        if self._closed or self.silent:
            if self._synthesiser.reason:
                self._tell_once(self._synthesiser.reason)
            heard.set_result(False)
            return heard
        self._queue.append(_Line(text, wanted, heard, sound))
        self._quiet.clear()
        self._waiting.set()
        if self._worker is None:
            self._worker = asyncio.create_task(self._work())
        return heard

    def hush(self) -> None:
        """Cut the current line at once, and clear the queue."""
        while self._queue:
            _settle(self._queue.popleft().heard, False)
        if self._speaking is not None:
            if self._player is not None:
                self._player.stop()
            self._speaking.cancel()

    async def quiet(self) -> None:
        """Wait until nothing is spoken, and `on_end` was called."""
        await self._quiet.wait()

    def prerender(self, texts: Iterable[str]) -> asyncio.Task[PrerenderedSpeech]:
        """Synthesise texts in advance, in the background, one at a time.

        Returns:
            A task that never fails: what was made, or found in the cache. It stops at the first
            text that cannot be synthesised, and reports it.
        """
        task = asyncio.create_task(self._prerender(tuple(texts)))
        self._preparing.add(task)
        task.add_done_callback(self._preparing.discard)
        return task

    async def close(self) -> None:
        """Cut everything, and end all tasks of this voice."""
        self._closed = True
        self.hush()
        self._synthesiser.end()
        for task in (*self._preparing, *([self._speaking] if self._speaking else [])):
            task.cancel()
            await asyncio.wait({task})
        if self._worker is not None:
            self._worker.cancel()
            await asyncio.wait({self._worker})

    async def _work(self) -> None:
        try:
            while True:
                await self._waiting.wait()
                while self._queue:
                    line = self._queue.popleft()
                    self._speaking = asyncio.create_task(self._speak(line))
                    try:
                        await asyncio.wait({self._speaking})
                        _settle(line.heard, _result(self._speaking))
                    finally:
                        _settle(line.heard, False)
                        self._speaking = None
                self._waiting.clear()
                self._end()
                self._quiet.set()
        finally:
            self._end()
            self._quiet.set()

    async def _speak(self, line: _Line) -> bool:
        """Speak one line; return whether it was heard to its end."""
        try:
            while self._player is not None:
                wav = line.sound or await self._made(line.text, line.preference)
                if wav is None:
                    return True
                self._begin()
                try:
                    await self._player.play(wav)
                    return True
                except PlayerError:
                    if wav.exists():
                        raise
                    if wav == line.sound:
                        raise VoiceError(f"{plain(wav.name)} is not there any more.") from None
                    # The cache has just been emptied, which is not the player's fault.
        except PlayerError as error:
            self._player = None
            self._tell_once(f"{error} What Tangy says is shown as text.")
        except VoiceError as error:
            self._tell_once(str(error))
        except Exception as error:  # a game goes on, whatever is wrong with its voice
            self._tell_once(f"The voice failed ({type(error).__name__}: {error}).")
        return False

    async def _made(self, text: str, preference: VoicePreference) -> Path | None:
        """Return the WAV of a text (None: nothing to say), if necessary in the default voice."""
        written = marked_up(as_called(text, self._deck))
        if not written:
            return None
        try:
            return await asyncio.to_thread(self._synthesiser.render, written, preference)
        except NoSuchVoice as error:
            if preference.voice == self._usual.voice:
                raise
            usual = VoicePreference(preference.rate, self._usual.voice)
            wav = await asyncio.to_thread(self._synthesiser.render, written, usual)
            self._tell_once(str(error))
            return wav

    async def _prerender(self, texts: tuple[str, ...]) -> PrerenderedSpeech:
        begun, size, done = time.monotonic(), 0, 0
        if self.silent:
            texts = ()
        for text in texts:
            try:
                wav = await self._made(text, self._usual)
                size += wav.stat().st_size if wav is not None else 0
            except (VoiceError, OSError) as error:
                self._tell_once(str(error))
                break
            done += 1
        return PrerenderedSpeech(done, size, time.monotonic() - begun)

    def _begin(self) -> None:
        if not self._begun:
            self._begun = True
            if self._on_begin is not None:
                self._on_begin()

    def _end(self) -> None:
        if self._begun:
            self._begun = False
            if self._on_end is not None:
                try:
                    self._on_end()
                except Exception as error:  # the next line must still be spoken
                    self._tell_once(f"The voice failed ({type(error).__name__}: {error}).")

    def _tell_once(self, sentence: str) -> None:
        if sentence not in self._told:
            self._told.add(sentence)
            if self._tell is not None:
                self._tell(sentence)


def _settle(heard: asyncio.Future[bool], so: bool) -> None:
    if not heard.done():
        heard.set_result(so)


def _result(task: asyncio.Task[bool]) -> bool:
    return not task.cancelled() and task.exception() is None and task.result()
