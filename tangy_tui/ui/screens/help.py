"""Help for where the user is: the screen, the widget that has the keys, and all keys there."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.content import Content
from textual.screen import Screen
from textual.widgets import Static

from tangy_tui.text.keys import DIGIT_SHOWN, HELP_KEYS, with_keys
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.keys import bind, keymap_of
from tangy_tui.ui.listing import listed
from tangy_tui.ui.type_ahead_guard import draws_digit

KEY = "$accent bold"

Keys = tuple[tuple[str, str], ...]
"""Pairs of a key and what it does."""


@dataclass(frozen=True, slots=True)
class Help:
    """The help: a title, paragraphs, the keys here, and the keys everywhere."""

    title: str
    paragraphs: tuple[str, ...]
    here: Keys
    everywhere: Keys


def help_for(screen: Screen[Any]) -> Help:
    """Collect the help of a screen, of the widget that has the keys, and of the keys."""
    focused = screen.focused
    nodes: Iterable[Any] = (screen,) if focused is None else (screen, focused)
    keymap, typing = keymap_of(screen.app), bool(screen.query("#command-input"))
    yes = _yes(screen)
    paragraphs = [
        with_keys(text.replace("{yes}", yes), keymap, typing=typing)
        for node in nodes
        if (text := getattr(node, "HELP", ""))
    ]
    here: dict[str, str] = {}
    everywhere: dict[str, str] = {}
    for one in listed(screen):
        word = f"  ({one.word})" if typing and one.word and one.word != one.name.lower() else ""
        (everywhere if one.everywhere else here).setdefault(f"{one.name}{word}", one.key)
    title = str(screen.TITLE or "Tangy")
    if focused is not None and isinstance(focused.border_title, str) and focused.border_title:
        title = f"{title} · {focused.border_title}"
    return Help(title, tuple(paragraphs), _pairs(here), _pairs(everywhere))


def _yes(screen: Screen[Any]) -> str:
    """Give the key that says yes: a question's own, or elsewhere that of the questions to come."""
    own: str = getattr(screen, "yes_key", "")
    return own or (DIGIT_SHOWN if draws_digit(screen.app) else "y")


def _has_phrases(screen: Screen[Any]) -> bool:
    """Say whether there is a page of what can be said on a screen."""
    return bool(screen.query("#command-input")) and hasattr(screen.app, "action_phrases")


def _pairs(keys: dict[str, str]) -> Keys:
    return tuple((key, does) for does, key in keys.items())


class HelpScreen(Dialog[None]):
    """The help over a screen; any of esc, q and ? closes it.

    Enter does not: after "?", typed as a command with Enter, the help would be gone at once.
    """

    DEFAULT_CSS = """
    HelpScreen { background: transparent; }
    HelpScreen > .box { width: 76; height: auto; }
    HelpScreen Static { width: 100%; height: auto; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,q,question_mark,f1", "close", "Close", show=False),
        *bind("phrases", show=False),
    ]

    def __init__(self, help: Help) -> None:
        super().__init__(None)
        self._help = help

    def compose(self) -> ComposeResult:
        """Lay out paragraphs and keys."""
        box = VerticalScroll(Static(self._content()), id="help", classes="box")
        box.border_title = Content(f"Help: {self._help.title}")
        box.border_subtitle = HELP_KEYS
        yield box

    def on_mount(self) -> None:
        """Let the arrows scroll."""
        self.query_one(VerticalScroll).focus()

    def action_close(self) -> None:
        """Go back."""
        self.answer(None)

    async def action_phrases(self) -> None:
        """Go on to all that can be said, where commands are given."""
        app = self.app
        below = [screen for screen in app.screen_stack if screen is not self]
        if below and _has_phrases(below[-1]):
            self.answer(None)
            app.call_next(app.run_action, "app.phrases")

    def on_click(self, event: events.Click) -> None:
        """Close when something else is clicked on."""
        if event.widget is self:
            self.answer(None)

    def _content(self) -> Content:
        parts: list[str | tuple[str, str] | Content] = []
        for paragraph in self._help.paragraphs:
            parts += [paragraph, "\n\n"]
        for heading, keys in (("Here", self._help.here), ("Everywhere", self._help.everywhere)):
            if keys:
                parts.append((f"{heading}\n", "$ink-dim"))
                parts += [p for k, does in keys for p in ((f"{k:>8}", KEY), f"   {does}\n")]
                parts.append("\n")
        return Content.assemble(*parts).rstrip()
