"""Tangy's voice in the application: can be switched at any time, and never blocks.

All speech is also shown on the screen. The voice is created on first use; a synthesiser and a
player do the work, each in its own process.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Protocol

from tangy_profiles.activity import Activity
from tangy_profiles.voice import VoicePreference
from tangy_tui.text.voice import shown_words

if TYPE_CHECKING:
    from tangy_hw.audio.voice import PrerenderedSpeech, SpeechVoice
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.ui.hearing import Hearing

GAP = 0.15
"""Delay in s of a line that interrupts another: in fast games, most are interrupted themselves."""


class CanSpeak(Protocol):
    """The interface of a `SpeechVoice` used here."""

    @property
    def speaking(self) -> bool:
        """Whether a line is being spoken or queued."""

    @property
    def silent(self) -> str:
        """Why nothing is audible; "" if it is."""

    def say(
        self, text: str, preference: VoicePreference | None = None, *, interrupt: bool = False
    ) -> asyncio.Future[bool]:
        """Speak a line."""

    def hush(self) -> None:
        """Stop speaking, and clear the queue."""

    async def quiet(self) -> None:
        """Wait until nothing is spoken."""

    def prerender(self, texts: Iterable[str]) -> asyncio.Task[PrerenderedSpeech]:
        """Synthesise texts in advance."""

    async def close(self) -> None:
        """Stop all processes."""


Tell = Callable[[str], None]
MakeVoice = Callable[[Activity, Callable[[], None], Callable[[], None], Tell], CanSpeak]
"""Creates a voice for an activity, with callbacks for start and end of sound, and for messages."""


def make_voice(
    activity: Activity, begin: Callable[[], None], end: Callable[[], None], tell: Tell
) -> SpeechVoice:
    """Create a voice with the programs of this machine; report if there is no audio output."""
    from tangy_hw.audio.player import PlayerError, SoundPlayer, open_player
    from tangy_hw.audio.synthesis import Synthesiser
    from tangy_hw.audio.voice import SpeechVoice

    synthesiser = Synthesiser()
    player: SoundPlayer | None = None
    try:
        player = open_player()
    except PlayerError as error:
        if not synthesiser.reason:
            tell(shown_words(str(error)))
    return SpeechVoice(
        synthesiser, player, deck=activity.deck, on_begin=begin, on_end=end, tell=tell
    )


class Speaker:
    """Speaks Tangy's lines while it is `on`. Used in one event loop only."""

    def __init__(self, activity: Activity | None, tell: Tell, make: MakeVoice = make_voice) -> None:
        """Create a speaker that is off; `tell` shows a sentence about the voice."""
        self.on = False
        self.hearing: Hearing | None = None
        """The speech input, closed while Tangy speaks."""
        self._activity = activity
        self._tell = tell
        self.make_voice = make
        self._voice: CanSpeak | None = None
        self._before: set[asyncio.Task[None]] = set()  # voices that are being closed
        self._known: tuple[str, ...] = ()
        self._later: asyncio.TimerHandle | None = None

    @property
    def speaking(self) -> bool:
        """Whether a line is being spoken, or waits to be."""
        return self._later is not None or (self._voice is not None and self._voice.speaking)

    def switch(self, on: bool) -> bool:
        """Switch the voice on or off; return whether it is on now, which needs audio output."""
        self.hush()
        self.on = on and self._can_speak()
        if self.on:
            self.prepare(self._known)
        return self.on

    def say(self, text: str, preference: VoicePreference) -> asyncio.Future[bool] | None:
        """Queue a line; the returned future is done when it was spoken.

        None: it is not spoken, because the voice is off, or a person is talking to Tangy.
        """
        voice = self._voice
        if not self.on or voice is None or not text or self._is_talked_to:
            return None
        return voice.say(text, preference)

    def interject(self, text: str, preference: VoicePreference) -> None:
        """Speak a line instead of all others, unless another one replaces it at once."""
        waits = self.speaking
        self.hush()
        if waits:
            loop = asyncio.get_running_loop()
            self._later = loop.call_later(GAP, self._now, text, preference)
        else:
            self.say(text, preference)

    def hush(self) -> None:
        """Stop speaking, and clear the queue."""
        if self._later is not None:
            self._later.cancel()
            self._later = None
        if self._voice is not None:
            self._voice.hush()

    async def silence(self) -> None:
        """Stop speaking, and wait until the microphone is open again."""
        self.hush()
        if self._voice is not None:
            await self._voice.quiet()

    def prepare(self, texts: Iterable[str]) -> None:
        """Synthesise likely lines in advance: now if the voice is on, or when it is switched on."""
        self._known = tuple(texts)
        if self.on and self._voice is not None and self._known:
            self._voice.prerender(self._known)

    async def speak_of(self, activity: Activity) -> None:
        """Change to another activity, with a voice made for it."""
        on, self._activity = self.on, activity
        await self.close()
        self._voice, self._known = None, ()
        self.switch(on)

    async def close(self) -> None:
        """Close the voice."""
        self.on = False
        self.hush()
        if self._voice is not None:
            await self._voice.close()
        if self._before:
            await asyncio.wait(self._before)

    def _now(self, text: str, preference: VoicePreference) -> None:
        self._later = None
        self.say(text, preference)

    def _can_speak(self) -> bool:
        """Create the voice, again if it was not audible; report why it cannot speak."""
        if self._activity is None:
            return False
        voice = self._voice
        if voice is None or voice.silent:
            if voice is not None:
                ending = asyncio.ensure_future(voice.close())
                self._before.add(ending)
                ending.add_done_callback(self._before.discard)
            told: list[str] = []

            def tell(sentence: str) -> None:
                told.append(sentence)
                self._tell(sentence)

            voice = self._voice = self.make_voice(self._activity, self._begin, self._end, tell)
            if voice.silent and not told:
                self._tell(voice.silent)
        return not voice.silent

    @property
    def _is_talked_to(self) -> bool:
        return self.hearing is not None and self.hearing.talking

    def _begin(self) -> None:
        if self.hearing is not None:
            self.hearing.ears.shut()

    def _end(self) -> None:
        if self.hearing is not None:
            self.hearing.ears.open()


def opening_lines(activity: Activity) -> tuple[str, ...]:
    """Return the sentences to everybody that occur in every game: above all the calls.

    Lines with a person's name are not known in advance.
    """
    lines: list[str] = []
    for behaviour in activity.behaviours.values():
        template = behaviour.speech[activity.plain_strategy]
        if "{name}" in template or "{numbers}" in template:
            continue
        calls = [(n,) for n in activity.deck.numbers] if "{call}" in template else [()]
        lines += [activity.fill(template, "", call) for call in calls]
    return tuple(dict.fromkeys(lines))


def preference_of(workspace: Workspace, person: str | None) -> VoicePreference:
    """Return a person's preferred way of being spoken to; for everybody, the default."""
    found = (one.voice for one in workspace.people if one.id == person)
    return next(found, VoicePreference())


def speaker_of(app: object) -> Speaker:
    """Return the voice of Tangy's application; for any other, a silent one."""
    speaker: Speaker | None = getattr(app, "speaker", None)
    return speaker or Speaker(None, lambda sentence: None)
