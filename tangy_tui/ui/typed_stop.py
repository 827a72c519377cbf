"""The word stop, typed where letters are keys: it stops the robot, as it does in a line.

Who types "stop the robot" in a hurry does not look whether there is a line to type in. The rest of
what is typed then, until there is a pause, is no key of anything.
"""

from __future__ import annotations

from typing import Literal

WORD = "stop"
TOGETHER_SECONDS = 1.5
"""From one letter to the next: longer apart they are keys that somebody means."""
REST_SECONDS = 1.0
"""After which the rest of a sentence is over."""

Taken = Literal["key", "stop", "rest"]
"""What a key that was pressed is: a key, the end of the word, or the rest of its sentence."""


class TypedStop:
    """Listens for the word among the keys. `take` each of them."""

    def __init__(self) -> None:
        self._letters = ""
        self._last = float("-inf")
        self._stopped = False

    def take(self, letter: str | None, now: float) -> Taken:
        """Take a key that was pressed at a time in s; None: it is no letter, space or return."""
        since, self._last = now - self._last, now
        if letter is None:
            self._letters, self._stopped = "", False
            return "key"
        if self._stopped and since <= REST_SECONDS:
            return "rest"
        self._stopped = False
        before = self._letters if since <= TOGETHER_SECONDS else ""
        self._letters = (before + letter.casefold())[-len(WORD) :]
        if self._letters != WORD:
            return "key"
        self._letters, self._stopped = "", True
        return "stop"
