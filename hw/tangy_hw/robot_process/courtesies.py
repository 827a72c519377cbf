"""What a robot says on its way to those for whom it stands: nobody is to wonder why it waits."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress

from tangy_hw.navigation.surroundings import Held
from tangy_hw.robot_process.stop_latch import Preempted

AFTER_SECONDS = 1.0  # that it has stood for somebody until it says so
AGAIN_SECONDS = 8.0  # until it says the same again


class Courtesies:
    """Says why the robot waits, in words that it is given by whom it waits for."""

    def __init__(self, words: Mapping[str, str], says: Callable[[str], Awaitable[object]]) -> None:
        """Take the words, by "walking" and "standing", and what says them."""
        self._words, self._says = words, says
        self._lets: Held = ""
        self._since = 0.0
        self._said: dict[str, float] = {}
        self._saying: asyncio.Task[None] | None = None

    def note(self, lets: Held, now: float) -> None:
        """Take note of for whom it stands, `now` in s; say so when it has for a moment."""
        if lets != self._lets:
            self._lets, self._since = lets, now
        words = self._words.get(lets, "")
        last = self._said.get(lets)
        if not words or now - self._since < AFTER_SECONDS:
            return
        if last is not None and now - last < AGAIN_SECONDS:
            return
        if self._saying is None or self._saying.done():
            self._said[lets] = now
            self._saying = asyncio.create_task(self._say(words))

    async def _say(self, words: str) -> None:
        with suppress(Preempted):  # it was stopped meanwhile
            await self._says(words)
