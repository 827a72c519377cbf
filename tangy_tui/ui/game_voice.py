"""Tangy's speech in a game; if faster than life, the next line interrupts the last."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from typing import Any

from textual.app import App

from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Acted
from tangy_tui.monitoring.fault import Moved
from tangy_tui.monitoring.supervision import Event
from tangy_tui.ui.speaking import opening_lines, preference_of, speaker_of

AS_IN_LIFE = 1.0
"""Up to this pace (ratio to real time), the game waits for a line to end."""


class GameVoice:
    """Speaks the lines of a game."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._app: App[Any] | None = None
        self._line: asyncio.Future[bool] | None = None

    def begin(self, app: App[Any]) -> None:
        """Synthesise the common sentences in the background."""
        self._app = app
        speaker_of(app).prepare(opening_lines(self._workspace.activity))

    def tell(self, events: Sequence[Event], pace: float) -> None:
        """Speak the speech of these events.

        Args:
            events: the new events.
            pace: a ratio to real time; 0 if the user steps through the events, or all come
                at once.
        """
        if self._app is None:
            return
        speaker = speaker_of(self._app)
        for event in events:
            if isinstance(event, Acted):
                speech, person = event.speech, event.action.target
            elif isinstance(event, Moved) and event.move.speech:
                speech, person = event.move.speech, None
            else:
                continue
            preference = preference_of(self._workspace, person)
            if 0 < pace <= AS_IN_LIFE:
                self._line = speaker.say(speech, preference)
            else:
                self._line = None
                speaker.interject(speech, preference)

    def hush(self) -> None:
        """Stop speaking."""
        self._line = None
        if self._app is not None:
            speaker_of(self._app).hush()

    async def heard(self, pace: float, nudge: asyncio.Event) -> bool:
        """Wait until the last line is spoken, at a pace up to `AS_IN_LIFE`; a nudge ends it.

        `pace` is a ratio to real time.

        Returns:
            Whether there is nothing left to wait for.
        """
        line = self._line
        if line is None or line.done() or pace > AS_IN_LIFE:
            return True
        nudge.clear()
        nudged: asyncio.Future[Any] = asyncio.ensure_future(nudge.wait())
        either: set[asyncio.Future[Any]] = {line, nudged}
        try:
            await asyncio.wait(either, return_when=asyncio.FIRST_COMPLETED)
        finally:
            nudged.cancel()
        return line.done() and not nudge.is_set()
