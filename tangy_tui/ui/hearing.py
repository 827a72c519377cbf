"""Speech input of the application: routes commands to a screen, and answers to a question.

There is at most one recogniser. The screen that takes commands is its listener; while a question
is open, or another screen is on top, it only accepts answers and a stop.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Awaitable, Callable, Collection
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

from tangy_profiles.errors import TangyError
from tangy_tui.text.hearing import NOTHING_ASKED, SAID_TOO_EARLY, hearing_words
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
    from tangy_tui.speech.hearing_notes import HearingNote
    from tangy_tui.speech.input import SpeechInput
    from tangy_tui.ui.dialogs.question import VerifyingDialog
    from tangy_tui.ui.dialogs.remark import RemarkDialog
    from tangy_tui.ui.widgets.log_view import Kind

    SpokenQuestion: TypeAlias = VerifyingDialog | RemarkDialog

WAITS = 0.05
"""The interval of checks whether the next command of a recording is due, in s."""

STOP = "stop"
ANSWERS = "yes, no or stop"

COLOURS = {"warn": "$warning", "bad": "$error"}
"""Colours of sentences in a question, by their kind; others have the default."""


class Listener(Protocol):
    """A screen, or a part of one, that takes spoken commands."""

    @property
    def listens(self) -> bool:
        """Whether it can take a command now: it is on top, and no question is open."""

    @property
    def spoken(self) -> Phrasebook:
        """The phrases that it understands."""

    def hear(self, said: Say) -> None:
        """Take a command."""

    def told(self, sentence: str, kind: Kind) -> None:
        """Show a sentence about speech input."""


class Hearing:
    """Speech input, and its listeners."""

    def __init__(
        self,
        app: App[Any],
        ears: SpeechInput,
        stop: Callable[[], None],
        hush: Callable[[], Awaitable[None]],
    ) -> None:
        """Set up speech input; `run` listens.

        Args:
            app: the application.
            ears: the recogniser.
            stop: stops the robot.
            hush: silences Tangy, and returns when it is silent.
        """
        self.ears = ears
        self.on = True
        """Whether commands are accepted; a stop always is."""
        self._app = app
        self._stop = stop
        self._hush = hush
        self._listeners: list[Listener] = []
        self._watching: list[Callable[[], None]] = []
        self._kept: deque[Say] = deque()
        self._understood: Phrasebook | None = None
        self._failed = ""
        self._state = ""
        self._about: SpokenQuestion | None = None  # the open question when speech began
        self._steer: Callable[[str, float], None] | None = None
        ears.changed = self._changed
        ears.tell = self._note

    @property
    def by_key(self) -> bool:
        """Whether it is push-to-talk."""
        return self.ears.live and not self.ears.hands_free

    @property
    def talking(self) -> bool:
        """Whether a person is talking with push-to-talk."""
        return self.by_key and self.ears.state in ("listening", "speaking")

    @property
    def expects(self) -> str:
        """What alone is accepted now; "": commands."""
        if self._takes:
            return ""
        answers = self.ears.answers and self._question is not None
        return ANSWERS if answers else STOP if self.ears.live else ""

    @property
    def aloud(self) -> str:
        """The words that tell how to answer a question by voice; "" if that is not possible."""
        if not self.ears.answers:
            return ""
        return with_keys(OR_KEY_AND_SAY, keymap_of(self._app)) if self.by_key else OR_SAY

    def attend(self, listener: Listener) -> None:
        """Route commands to a listener from now on."""
        self._listeners.append(listener)
        if self._failed:
            listener.told(self._failed, "bad")
        self.understand()
        self.look()

    def leave(self, listener: Listener) -> None:
        """Remove a listener; the previous one takes commands again."""
        if listener in self._listeners:
            self._listeners.remove(listener)
            self._kept.clear()
            self.understand()
            self.look()

    def watch(self, changed: Callable[[], None]) -> None:
        """Add a callback for changes of the recogniser's state."""
        self._watching.append(changed)

    def watch_no_more(self, changed: Callable[[], None]) -> None:
        """Remove the callback."""
        if changed in self._watching:
            self._watching.remove(changed)

    def understand(self) -> None:
        """Match speech to the current phrases of the listener."""
        if self._listeners and (spoken := self._listeners[-1].spoken) is not self._understood:
            self._understood = spoken
            self.ears.understand_by(spoken)

    def steer_by(
        self,
        steer: Callable[[str, float], None] | None,
        options: Callable[[], Collection[str]] = tuple,
    ) -> None:
        """Route steering commands and their confidence to a callback while no screen listens.

        None removes it. `options` returns the options of the question that people are asked.
        """
        from tangy_tui.language.steering import IN_GAMES

        self._steer = steer
        self.ears.steering = () if steer is None else IN_GAMES
        self.ears.options = options

    def pause(self, paused: bool) -> None:
        """Pause or resume commands by voice."""
        self.on = not paused
        self._kept.clear()
        self.look()

    def look(self) -> None:
        """Update whether the listener takes commands, and deliver the queued ones."""
        choices = () if self._question is None else self._question.choices
        if self.ears.live:
            self.ears.asking(not self._takes, choices)
        else:  # a recording is read on demand
            self.ears.asking(self.ears.answers and self._question is not None, choices)
        while self._kept and self._free:
            self._listeners[-1].hear(self._kept.popleft())
        self._changed()

    async def talk(self) -> None:
        """Start or end an utterance (push-to-talk); Tangy is silent meanwhile."""
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
        """Show a sentence about speech input, also in an open question."""
        if (question := self._question) is not None:
            question.tell(sentence, COLOURS.get(kind, "$foreground"))
        if self._listeners:
            self._listeners[-1].told(sentence, kind)
        elif self._app.is_running and question is None:
            self._app.notify(clean(sentence), markup=False)

    @contextmanager
    def deaf(self) -> Iterator[None]:
        """Close the microphone inside the context, because Tangy speaks."""
        self.ears.shut()
        try:
            yield
        finally:
            self.ears.open()

    async def run(self) -> None:
        """Listen while the program runs or the recording lasts."""
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

    def _note(self, note: HearingNote) -> None:
        """Show a note; without a question nobody missed an answer."""
        if note.kind != "no answer" or self._question is not None:
            self.tell(hearing_words(note))

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
                if self.on and self._question is None:  # people are talking about the question
                    self._steer(text, sure)
            case Say() if self._listeners and self.on:
                self._kept.append(heard)
                if self._put_off is not None:
                    self._put_off.answer("later")
                self.look()

    def _answer(self, reply: Reply) -> None:
        """Answer the open question like its key, if it was open when the person began to speak."""
        question = self._question
        if question is None and self._free:
            self.tell(NOTHING_ASKED)
        if question is None:
            return
        if self._about is not question:
            self.tell(SAID_TOO_EARLY, "warn")
            return
        wrong = question.hear(yes=reply.yes, alternative=reply.alternative)
        said = f"Heard: {reply.alternative or ('yes' if reply.yes else 'no')}."
        self.tell(f"{said} {wrong}".rstrip(), "warn" if wrong else "text")

    async def _wanted(self) -> None:
        """Wait until speech is wanted: a recording is read on demand."""
        while not self.ears.live and not self._takes:
            question = self._question
            if self.ears.answers and question is not None and question.painted:
                self.look()
                return
            await asyncio.sleep(WAITS)

    @property
    def _free(self) -> bool:
        return self.on and bool(self._listeners) and self._listeners[-1].listens

    @property
    def _takes(self) -> bool:
        """Whether a spoken command is taken now."""
        return self._free or self._put_off is not None

    @property
    def _put_off(self) -> RemarkDialog | None:
        """The open remark that the next command puts off: it cannot be answered by voice."""
        question = self._question
        if self.ears.answers or not (self.on and self._listeners):
            return None
        from tangy_tui.ui.dialogs.remark import RemarkDialog

        return question if isinstance(question, RemarkDialog) else None

    @property
    def _question(self) -> SpokenQuestion | None:
        """The open question on top, if there is one."""
        from tangy_tui.ui.dialogs.question import VerifyingDialog
        from tangy_tui.ui.dialogs.remark import RemarkDialog

        screen = self._app.screen_stack[-1] if self._app.screen_stack else None
        return screen if isinstance(screen, VerifyingDialog | RemarkDialog) else None

    @property
    def _begins(self) -> tuple[str, ...]:
        """The states that begin a new utterance."""
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
    """Return the speech input of Tangy's application, None if there is none."""
    hearing: Hearing | None = getattr(app, "hearing", None)
    return hearing


class HearingLine(MicrophoneLine):
    """The microphone line of a screen."""

    def __init__(
        self,
        hearing: Hearing,
        steer: Callable[[str, float], None] | None = None,
        options: Callable[[], Collection[str]] = tuple,
    ) -> None:
        """Create the line; see `Hearing.steer_by` for what it sets while it is shown."""
        super().__init__(hearing.ears, lambda: hearing.expects)
        self._hearing = hearing
        self._steer, self._options = steer, options

    def on_mount(self) -> None:
        """Follow the recogniser, and the focus."""
        self._hearing.watch(self.look)
        self._hearing.steer_by(self._steer, self._options)
        self.watch(self.screen, "focused", self.look, init=False)

    def on_unmount(self) -> None:
        """Stop following."""
        self._hearing.watch_no_more(self.look)
        if self._steer is not None:
            self._hearing.steer_by(None)
