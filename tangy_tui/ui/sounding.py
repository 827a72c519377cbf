"""The application with speech input and output: their keys, start and end."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from tangy_tui.text.voice import LISTENS, LISTENS_NOT, NO_MICROPHONE, OFF, ON
from tangy_tui.ui.app import FirstScreen, TangyApp
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.hearing import Hearing
from tangy_tui.ui.keys import bind
from tangy_tui.ui.speaking import Speaker

if TYPE_CHECKING:
    from textual.binding import BindingType

    from tangy_profiles.activity import Activity
    from tangy_tui.speech.input import SpeechInput


class SoundingApp(TangyApp):
    """The application with a voice that can be switched on, and with speech input if given.

    The microphone is closed while Tangy speaks; STOP silences Tangy.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        *bind("talk", priority=True),
        *bind("listen"),
        *bind("voice"),
    ]

    def __init__(
        self,
        first: FirstScreen | None = None,
        *,
        activity: Activity | None = None,
        ears: SpeechInput | None = None,
        voice: bool = False,
        **settings: Any,
    ) -> None:
        """Create the application.

        Args:
            first: creates the first screen.
            activity: the activity whose lines are spoken.
            ears: the recogniser, if there is one.
            voice: whether the voice is on from the start.
            settings: as for every `TangyApp`.
        """
        super().__init__(first, **settings)
        self.speaker = Speaker(activity, self._tell_of_voice)
        self.hearing: Hearing | None = None
        if ears is not None:
            self.hearing = Hearing(self, ears, self._told_to_stop, self.speaker.silence)
            self.speaker.hearing = self.hearing
        self._speaks = voice

    def on_mount(self) -> None:
        """Start to listen, and to speak."""
        hearing = self.hearing
        if hearing is not None:
            self.screen_change_signal.subscribe(self, lambda _: hearing.look(), immediate=True)
            hearing.look()
            self.run_worker(hearing.run(), name="ears", group="ears")
        if self._speaks:
            self.speaker.switch(True)

    async def on_unmount(self) -> None:
        """Close the voice; the recogniser ends with the workers."""
        await self.speaker.close()

    def stop(self, reason: str) -> None:
        """Send `Stop` to every open screen, and stop speaking."""
        self.speaker.hush()
        super().stop(reason)

    async def action_talk(self) -> None:
        """Start or end an utterance (push-to-talk)."""
        if self.hearing is not None:
            await self.hearing.talk()

    def action_listen(self) -> None:
        """Pause or resume listening."""
        if self.hearing is None:
            self.say(NO_MICROPHONE)
        else:
            self.hearing.pause(self.hearing.on)
            self.say(LISTENS if self.hearing.on else LISTENS_NOT)

    def action_voice(self) -> None:
        """Switch the voice on or off."""
        if self.speaker.on:
            self.speaker.switch(False)
            self.say(OFF)
        elif self.speaker.switch(True):
            self.say(ON)

    def _told_to_stop(self) -> None:
        self.action_stop()

    def _tell_of_voice(self, sentence: str) -> None:
        def tell() -> None:
            self.notify(clean(sentence), severity="warning", markup=False)

        self.call_later(tell)  # at the start there is no screen yet
