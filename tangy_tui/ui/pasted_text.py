"""Pasted text triggers no letter shortcuts.

Most terminals bracket pasted text, which Textual turns into one event. Otherwise (in some
multiplexers, or from a program that types) it arrives as keys, more at once than a person types.
Over a slow link a few keys may arrive together, and a held key repeats.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from textual import events
from textual.message import Message

TYPED_TOGETHER = 3
"""The most characters read at once that still count as typed."""

_SEQUENCE = re.compile(r"\x1b(?:\[[0-?]*[ -/]*[@-~]|O.|[@-Z\\-_])")
_CHARACTERS = re.compile(r"[^\x00-\x1f\x7f]+")
_MARK = "_pasted_text"


def pasted_in(data: str) -> str:
    """Return input read at once if it contains pasted text, otherwise ""."""
    for run in _CHARACTERS.findall(_SEQUENCE.sub("\x00", data)):
        if len(run) > TYPED_TOGETHER and len(set(run)) > 1:
            return data
    return ""


def marked(messages: Iterable[Message], pasted: str) -> Iterator[Message]:
    """Mark keys as parts of a pasted text."""
    for message in messages:
        if pasted and isinstance(message, events.Key):
            setattr(message, _MARK, pasted)
            pasted = " "  # only its first key carries the text
        yield message


def pasted_text(event: events.Event) -> str:
    """Return the pasted text for its first key, " " for its other keys, "" for typed keys."""
    return str(getattr(event, _MARK, ""))
