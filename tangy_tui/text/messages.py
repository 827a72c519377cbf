"""Words of the list of messages that staff can read again."""

from __future__ import annotations

from datetime import datetime

TITLE = "The last messages"
NONE_YET = "Tangy has not told you anything yet."
KEYS = "up down more   esc closes"
ABOVE = "Everything that Tangy told you is in the lines above: scroll up to read it again."
HELP = (
    "What Tangy told you since the program began, the newest message first, with the time of day. "
    "If you went on with a game that was interrupted, what its log has from before is below. "
    "Up and down scroll."
)


def told_words(at: datetime, words: str) -> str:
    """Write a message with the time of day at which it was shown (s matter in a game)."""
    return f"{at:%H:%M:%S} {words}"
