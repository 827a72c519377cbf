"""Tells people who are in the robot's way why it stands."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress

from tangy_hw.navigation.surroundings import Blocker
from tangy_hw.robot_process.stop_latch import Preempted

AFTER_SECONDS = 1.0  # of standing for a person until it speaks
AGAIN_SECONDS = 8.0  # until it repeats a sentence


class WaitExplanations:
    """Says why the robot waits, in given sentences."""

    def __init__(self, words: Mapping[str, str], says: Callable[[str], Awaitable[object]]) -> None:
        """Set the sentences by kind (`Blocker`), and the speech function."""
        self._words, self._says = words, says
        self._yields_to: Blocker = ""
        self._since = 0.0
        self._said: dict[str, float] = {}
        self._saying: asyncio.Task[None] | None = None

    def note(self, yields_to: Blocker, now: float) -> None:
        """Update for what it waits, `now` in s; speak after a moment."""
        if yields_to != self._yields_to:
            self._yields_to, self._since = yields_to, now
        words = self._words.get(yields_to, "")
        last = self._said.get(yields_to)
        if not words or now - self._since < AFTER_SECONDS:
            return
        if last is not None and now - last < AGAIN_SECONDS:
            return
        if self._saying is None or self._saying.done():
            self._said[yields_to] = now
            self._saying = asyncio.create_task(self._say(words))

    async def _say(self, words: str) -> None:
        with suppress(Preempted):  # it was stopped meanwhile
            await self._says(words)
