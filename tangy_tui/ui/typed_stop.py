"""The word stop, typed where letters are keys: it stops the robot, as it does in an input line.

A person who types "stop the robot" in a hurry does not check for an input line. The rest of the
sentence, until a pause, triggers no keys.
"""

from __future__ import annotations

from typing import Literal

WORD = "stop"
TOGETHER_SECONDS = 1.5
"""The longest time in s between two letters of the word; otherwise they are separate keys."""
REST_SECONDS = 1.0
"""The pause in s that ends the rest of the sentence."""

Taken = Literal["key", "stop", "rest"]
"""What a pressed key is: a key, the last letter of the word, or part of the sentence after it."""


class TypedStop:
    """Detects the word among the keys. `take` each of them."""

    def __init__(self) -> None:
        self._letters = ""
        self._last = float("-inf")
        self._stopped = False

    @property
    def begun(self) -> bool:
        """Whether the next letter may complete the word, or belong to the sentence after it.

        A letter of the word may have opened a line, into which the others go.
        """
        return self._stopped or any(self._letters.endswith(WORD[:n]) for n in range(1, len(WORD)))

    def take(self, letter: str | None, now: float) -> Taken:
        """Handle a key pressed at a time in s; None: it is no letter, space or return."""
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
