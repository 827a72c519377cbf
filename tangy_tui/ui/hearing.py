"""What the program does with what it hears: commands go to a screen, answers to a question.

The program has one pair of ears at most. Whichever screen takes commands at the moment is their
listener; while a question is open, or something lies over that screen, only answers and what stops
the robot are heard.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Awaitable, Callable
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Protocol

from tangy_profiles.errors import TangyError
from tangy_tui.text.hearing import hearing_words
from tangy_tui.text.keys import with_keys
from tangy_tui.text.voice import HANDS_FREE, OR_KEY_AND_SAY, OR_SAY, RECORDING
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.keys import keymap_of
from tangy_tui.ui.widgets.microphone_line import MicrophoneLine

if TYPE_CHECKING:
    from collections.abc import Iterator

    from textual.app import App

    from tangy_tui.language.commands import Phrasebook
    from tangy_tui.learning.verification import Reply, Say, StopCommand
    from tangy_tui.speech.input import SpeechInput
    from tangy_tui.ui.dialogs.question import VerifyingDialog
    from tangy_tui.ui.widgets.log_view import Kind

WAITS = 0.05
"""Seconds between two looks whether the next command of a recording is due."""

STOP = "stop"
ANSWERS = "yes, no or stop"

COLOURS = {"warn": "$warning", "bad": "$error"}
"""Of sentences in a question, by their kind; others stand in the usual one."""


class Listener(Protocol):
    """What takes spoken commands: a screen, or a part of one."""

    @property
    def listens(self) -> bool:
        """Whether a command could be put to it now: it is seen, and no question is open."""

    @property
    def spoken(self) -> Phrasebook:
        """What can be said to it."""

    def hear(self, said: Say) -> None:
        """Take a command."""

    def told(self, sentence: str, kind: Kind) -> None:
        """Show a sentence about hearing."""


class Hearing:
    """The ears of the program, and who listens through them."""

    def __init__(
        self,
        app: App[Any],
        ears: SpeechInput,
        stop: Callable[[], None],
        hush: Callable[[], Awaitable[None]],
    ) -> None:
        """Take the ears; `run` listens.

        Args:
            app: the program.
            ears: the speech input.
            stop: stops the robot.
            hush: lets Tangy fall silent, and returns when it is.
        """
        self.ears = ears
        self.on = True
        """Whether commands are taken; what stops the robot is heard in any case."""
        self._app = app
        self._stop = stop
        self._hush = hush
        self._listeners: list[Listener] = []
        self._watching: list[Callable[[], None]] = []
        self._kept: deque[Say] = deque()
        self._understood: Phrasebook | None = None
        self._failed = ""
        self._state = ""
        self._about: VerifyingDialog | None = None  # the question when somebody began to speak
        self._steer: Callable[[str, float], None] | None = None
        ears.changed = self._changed
        ears.tell = lambda note: self.tell(hearing_words(note))

    @property
    def by_key(self) -> bool:
        """Whether a key is pushed to talk."""
        return self.ears.live and not self.ears.hands_free

    @property
    def talking(self) -> bool:
        """Whether somebody is talking who has pushed the key for it."""
        return self.by_key and self.ears.state in ("listening", "speaking")

    @property
    def expects(self) -> str:
        """What alone is listened for; "" if that is commands."""
        if self._free:
            return ""
        answers = self.ears.answers and self._question is not None
        return ANSWERS if answers else STOP if self.ears.live else ""

    @property
    def aloud(self) -> str:
        """How an answer to a question begins that is given by voice; "" if none can be."""
        if not self.ears.answers:
            return ""
        return with_keys(OR_KEY_AND_SAY, keymap_of(self._app)) if self.by_key else OR_SAY

    def attend(self, listener: Listener) -> None:
        """Route utterances to a listener from now on."""
        self._listeners.append(listener)
        if self._failed:
            listener.told(self._failed, "bad")
        self.understand()
        self.look()

    def leave(self, listener: Listener) -> None:
        """Give nothing more to a listener; the one before it takes commands again."""
        if listener in self._listeners:
            self._listeners.remove(listener)
            self._kept.clear()
            self.understand()
            self.look()

    def watch(self, changed: Callable[[], None]) -> None:
        """Call this whenever there may be something else to show of the ears."""
        self._watching.append(changed)

    def watch_no_more(self, changed: Callable[[], None]) -> None:
        """Call this no longer."""
        if changed in self._watching:
            self._watching.remove(changed)

    def understand(self) -> None:
        """Match an utterance to the listener's current phrases."""
        if self._listeners and (spoken := self._listeners[-1].spoken) is not self._understood:
            self._understood = spoken
            self.ears.understand_by(spoken)

    def steer_by(self, steer: Callable[[str, float], None] | None) -> None:
        """Give what steers a game, with how sure it is, to this while nobody takes commands.

        None: to nobody any more.
        """
        from tangy_tui.language.steering import IN_GAMES

        self._steer = steer
        self.ears.steering = () if steer is None else IN_GAMES

    def pause(self, paused: bool) -> None:
        """Take no commands by voice for a while, or take them again."""
        self.on = not paused
        self._kept.clear()
        self.look()

    def look(self) -> None:
        """Check whether the listener takes commands now, and deliver the queued ones."""
        choices = () if self._question is None else self._question.choices
        if self.ears.live:
            self.ears.asking(not self._free, choices)
        else:  # a recording says its next command when it is asked for it
            self.ears.asking(self.ears.answers and self._question is not None, choices)
        while self._kept and self._free:
            self._listeners[-1].hear(self._kept.popleft())
        self._changed()

    async def talk(self) -> None:
        """Push to talk: begin or end the utterance; Tangy is silent meanwhile."""
        if not self._watching:
            return
        if not self.ears.live:
            self.tell(RECORDING)
        elif self.ears.hands_free:
            self.tell(HANDS_FREE)
        else:
            if self.ears.state == "shut":
                await self._hush()
            self.ears.talk()

    def tell(self, sentence: str, kind: Kind = "dim") -> None:
        """Show a sentence about hearing; where a question lies over the screen, in both."""
        if (question := self._question) is not None:
            question.tell(sentence, COLOURS.get(kind, "$foreground"))
        if self._listeners:
            self._listeners[-1].told(sentence, kind)
        elif self._app.is_running and question is None:
            self._app.notify(clean(sentence), markup=False)

    @contextmanager
    def deaf(self) -> Iterator[None]:
        """Hear nothing for a while: Tangy speaks."""
        self.ears.shut()
        try:
            yield
        finally:
            self.ears.open()

    async def run(self) -> None:
        """Listen for as long as the program runs or the source lasts."""
        try:
            while True:
                await self._wanted()
                heard = await anext(self.ears, None)
                if heard is None:
                    break
                self._take(heard)
        except TangyError as error:
            self._failed = str(error)
            self.tell(self._failed, "bad")
        finally:
            await self.ears.close()

    def _take(self, heard: Say | StopCommand | Reply) -> None:
        from tangy_tui.learning.verification import Reply, Say, StopCommand

        match heard:
            case StopCommand(text):
                self._stop()
                self.tell(f"Heard: {text}.", "warn")
            case Reply():
                self._answer(heard)
            case Say(text, sure, commands=None) if self._steer is not None and not self._free:
                self.tell(f"Heard: {text}.")
                if self.on and self._question is None:  # it is talk about what is asked
                    self._steer(text, sure)
            case Say() if self._listeners and self.on:
                self._kept.append(heard)
                self.look()

    def _answer(self, reply: Reply) -> None:
        """Answer the open question as its key would, if it was there when somebody began."""
        question = self._question
        if question is None or self._about not in (None, question):
            return
        wrong = question.hear(yes=reply.yes, alternative=reply.alternative)
        said = f"Heard: {reply.alternative or ('yes' if reply.yes else 'no')}."
        self.tell(f"{said} {wrong}".rstrip(), "warn" if wrong else "text")

    async def _wanted(self) -> None:
        """Wait until an utterance is wanted: a recording is read on demand."""
        while not self.ears.live and not self._free:
            question = self._question
            if self.ears.answers and question is not None and question.painted:
                self.look()
                return
            await asyncio.sleep(WAITS)

    @property
    def _free(self) -> bool:
        return self.on and bool(self._listeners) and self._listeners[-1].listens

    @property
    def _question(self) -> VerifyingDialog | None:
        """The question that is open, if one lies over the screens."""
        from tangy_tui.ui.dialogs.question import VerifyingDialog

        screen = self._app.screen_stack[-1] if self._app.screen_stack else None
        return screen if isinstance(screen, VerifyingDialog) else None

    @property
    def _begins(self) -> tuple[str, ...]:
        """The states in which somebody begins to say something new."""
        if not self.ears.live:
            return ("thinking",)
        return ("listening", "speaking") if self.by_key else ("speaking",)

    def _changed(self) -> None:
        state = self.ears.state
        if state != self._state:
            self._state = state
            if state in (("listening", "speaking") if self.ears.live else ("thinking",)):
                self._about = self._question
            if state in self._begins and self._question is not None:
                self._question.tell("")
        for show in tuple(self._watching):
            show()


def hearing_of(app: object) -> Hearing | None:
    """Return the ears of Tangy's program, if it has any."""
    hearing: Hearing | None = getattr(app, "hearing", None)
    return hearing


class HearingLine(MicrophoneLine):
    """The microphone of the program on one line, for as long as it is on a screen."""

    def __init__(self, hearing: Hearing, steer: Callable[[str, float], None] | None = None) -> None:
        """Make the line; `steer` takes what steers the screen while it takes no commands."""
        super().__init__(hearing.ears, lambda: hearing.expects)
        self._hearing = hearing
        self._steer = steer

    def on_mount(self) -> None:
        """Follow the ears, and what has the keys."""
        self._hearing.watch(self.look)
        self._hearing.steer_by(self._steer)
        self.watch(self.screen, "focused", self.look, init=False)

    def on_unmount(self) -> None:
        """Follow no longer."""
        self._hearing.watch_no_more(self.look)
        if self._steer is not None:
            self._hearing.steer_by(None)
