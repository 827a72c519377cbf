"""Text pasted where letters are shortcuts: it triggers none of them.

Most terminals say what is pasted; Textual makes one event of that. Where they do not (inside some
multiplexers, or through a program that types) it comes as keys, more of them at once than a person
types. Over a slow link a few keys may come together, and a key that is held repeats itself.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from textual import events
from textual.message import Message

TYPED_TOGETHER = 3
"""The most characters that count as typed when they are read at once."""

_SEQUENCE = re.compile(r"\x1b(?:\[[0-?]*[ -/]*[@-~]|O.|[@-Z\\-_])")
_CHARACTERS = re.compile(r"[^\x00-\x1f\x7f]+")
_MARK = "_pasted_text"


def pasted_in(data: str) -> str:
    """Return the pasted text among input read at once; "" if there is none."""
    for run in _CHARACTERS.findall(_SEQUENCE.sub("\x00", data)):
        if len(run) > TYPED_TOGETHER and len(set(run)) > 1:
            return data
    return ""


def marked(messages: Iterable[Message], pasted: str) -> Iterator[Message]:
    """Mark keys as parts of a text that was pasted."""
    for message in messages:
        if pasted and isinstance(message, events.Key):
            setattr(message, _MARK, pasted)
            pasted = " "  # the text is told with its first key alone
        yield message


def pasted_text(event: events.Event) -> str:
    """Return the text that a key begins which was pasted, " " for its other keys, else ""."""
    return str(getattr(event, _MARK, ""))
