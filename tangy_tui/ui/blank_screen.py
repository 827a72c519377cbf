"""Keys typed while the terminal is still blank: they do nothing, except STOP and quit."""

from __future__ import annotations

from time import monotonic
from typing import Any

from textual import events
from textual.screen import Screen

from tangy_tui.app.keymap import Keymap

BEHIND = "-behind"
"""The class of a screen that stays blank until the questions at the start are answered."""

ALWAYS = ("stop", "quit")
"""The actions of keys that count at any time."""


class BlankScreen:
    """Tells which keys were read before anything was on the terminal."""

    def __init__(self) -> None:
        self._until: float | None = None

    def drawn(self, screen: Screen[Any]) -> None:
        """Note that a screen is being drawn now."""
        if self._until is None and not screen.has_class(BEHIND):
            self._until = monotonic()

    def hides(self, event: events.Event, keymap: Keymap) -> bool:
        """Return whether an event is a key or a paste that nobody aimed at a screen."""
        if not isinstance(event, events.Key | events.Paste):
            return False
        if self._until is not None and event.time >= self._until:
            return False
        return not (isinstance(event, events.Key) and keymap.action(event.key) in ALWAYS)
