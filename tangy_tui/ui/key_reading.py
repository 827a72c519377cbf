"""Handles input before key bindings: a typed stop, letters for an input line, pasted text."""

from __future__ import annotations

from typing import Any

from textual import events
from textual.app import App
from textual.widgets import Input

from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.early_keys import EarlyKeys
from tangy_tui.ui.keys import keymap_of
from tangy_tui.ui.pasted_text import pasted_text
from tangy_tui.ui.typed_stop import Taken, TypedStop


class KeyReader:
    """Handles input that is no shortcut: a typed or pasted stop, letters of a line, other paste."""

    def __init__(self, app: App[None], early: EarlyKeys) -> None:
        self._app = app
        self._early = early
        self._typed_stop = TypedStop()

    def takes(self, event: events.Event) -> bool:
        """Handle an event, unless it is for the widgets; return whether it is handled."""
        if not isinstance(event, events.Key | events.Paste) or event.is_forwarded:
            return False  # a key that no widget used comes back here
        if self._early.keep(event):
            return True
        focused = self._app.focused
        writes = isinstance(focused, Input) or getattr(focused, "writes", False)
        outside = not writes or isinstance(event, events.Paste) or self._typed_stop.begun
        if outside and self._says_stop(event):
            return True
        if not writes and self._is_typed(event):
            return True
        if writes or not isinstance(event, events.Key):
            return False
        if self._begins_filter(event) or self._opens_dialog(event):
            return True
        filters = getattr(focused, "LETTERS_FILTER", False) and event.is_printable
        return bool(pasted_text(event)) and _is_text(event) and not filters

    def _begins_filter(self, event: events.Key) -> bool:
        """Start to filter before the next key is read, which may arrive together with this one."""
        app: Any = self._app
        top = app.screen_stack[-1] if app.screen_stack else None
        if keymap_of(app).action(event.key) != "filter" or not isinstance(top, TangyScreen):
            return False
        if not pasted_text(event):
            begin = getattr(top, "action_search", app.action_filter)
            if top.is_mounted:
                begin()
            else:  # it has no widgets yet
                top.call_later(begin)
        return True

    def _opens_dialog(self, event: events.Key) -> bool:
        """Open a dialog before the next key is read, which may be a letter for it."""
        top = self._app.screen_stack[-1] if self._app.screen_stack else None
        if not isinstance(top, TangyScreen) or pasted_text(event) or not top.is_mounted:
            return False
        action = top.LETTERS_FOLLOW.get(keymap_of(self._app).action(event.key) or "")
        if action is None or not top.check_action(action, ()):
            return False
        getattr(top, f"action_{action}")()
        if (opened := self._app.screen) is not top:
            self._early.wait_for(opened)
        return True

    def _is_typed(self, event: events.Key | events.Paste) -> bool:
        """Let the screen take a letter as text, whatever has the focus."""
        top = self._app.screen_stack[-1] if self._app.screen_stack else None
        return isinstance(top, TangyScreen) and top.take_letter(event)

    def _says_stop(self, event: events.Key | events.Paste) -> bool:
        """Stop once the word is complete; return whether the event belongs to the word."""
        from tangy_tui.language.stop_sentence import stops  # loaded after the first screen

        if text := event.text if isinstance(event, events.Paste) else pasted_text(event).strip():
            taken: Taken = "stop" if stops(text) else "key"
        elif isinstance(event, events.Key):
            known = event.character if event.is_printable else None
            letter = "\n" if event.key == "enter" else known
            taken = self._typed_stop.take(letter, event.time)  # when it was typed, not handled
        else:
            taken = "key"
        if taken == "stop":
            app: Any = self._app
            app.action_stop()  # at once
        return taken != "key"


def _is_text(event: events.Key | events.Paste) -> bool:
    return isinstance(event, events.Key) and (event.is_printable or event.key == "enter")


def prepare_stop() -> None:
    """Load the classifier of stop sentences, after the first screen is drawn."""
    from tangy_tui.language.stop_sentence import prepare

    prepare()
