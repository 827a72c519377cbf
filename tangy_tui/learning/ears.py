"""Ears: a microphone and the speech decoder behind it, giving commands as a teacher types them."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from pathlib import Path

from tangy_tui.learning.commands import Phrasebook
from tangy_tui.learning.microphone import Microphone, open_microphone
from tangy_tui.learning.speech import Recogniser, SpeechUnavailable
from tangy_tui.learning.verifying import Say


class Ears:
    """A source of spoken commands: `async for say in ears`. Opening it checks the source.

    `shut` it while a question is open or the robot speaks: a live microphone then drops what it
    hears, a recording waits.
    """

    def __init__(
        self, source: str, phrasebook: Phrasebook, *, stdin: int = 0, log: Path | None = None
    ) -> None:
        """Open the source.

        Args:
            source: FILE.wav, - or arecord, as `microphone.open_microphone` has them.
            phrasebook: what can be said.
            stdin: the file descriptor that `-` stands for.
            log: where messages of the decoder go.

        Raises:
            SoundError: the source cannot be used.
        """
        self.live = source in ("-", "arecord")
        """Whether somebody is speaking right now, rather than on a recording."""
        self._microphone: Microphone = open_microphone(source, stdin=stdin)
        self._phrasebook = phrasebook
        self._log = log
        self._words: AsyncIterator[Say] | None = None
        self.tell: Callable[[str], None] = lambda sentence: None
        """Is called with a sentence when something must be said about hearing."""

    def shut(self) -> None:
        """Stop listening for a while."""
        self._microphone.shut()

    def open(self) -> None:
        """Listen again."""
        self._microphone.open()

    def __aiter__(self) -> AsyncIterator[Say]:
        return self

    async def __anext__(self) -> Say:
        if self._words is None:
            self._words = self._hear()
        return await anext(self._words)

    async def _hear(self) -> AsyncIterator[Say]:
        recogniser = Recogniser(log=self._log, notify=self._told)
        try:
            await recogniser.start(self._phrasebook.spoken())
            if recogniser.left_out:
                self._told(f"Cannot be heard, only typed: {', '.join(recogniser.left_out)}.")
            self._told("Listening.")
            async for utterance in self._microphone:
                try:
                    heard = await recogniser.decode(utterance)
                except SpeechUnavailable as error:  # it is started again for the next one
                    self._told(f"{error} Please say that again.")
                    continue
                if heard.text:
                    yield Say(heard.text, heard.confidence)
                else:
                    self._told("I heard something, but no words that I know.")
            self._told("The recording is over." if not self.live else "The microphone has closed.")
        finally:
            await recogniser.close()
            await self._microphone.close()

    def _told(self, sentence: str) -> None:
        self.tell(sentence)
