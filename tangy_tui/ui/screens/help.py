"""Context help: the screen, the focused widget, and all available keys."""

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
from textual.widget import Widget
from textual.widgets import Static

from tangy_tui.text.keys import DIGIT_SHOWN, HELP_KEYS, with_keys
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.keys import bind, keymap_of
from tangy_tui.ui.listing import listed
from tangy_tui.ui.type_ahead_guard import draws_digit

KEY = "$accent bold"

Keys = tuple[tuple[str, str], ...]
"""Pairs of a key and its action."""


@dataclass(frozen=True, slots=True)
class Help:
    """The contents of help: a title, paragraphs, keys available here, and global keys."""

    title: str
    paragraphs: tuple[str, ...]
    here: Keys
    everywhere: Keys


def help_for(screen: Screen[Any]) -> Help:
    """Collect the help of a screen and its focused widget, and their keys."""
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
    boxes = (_title(box) for box in screen.query(".box"))  # a dialog's
    title = str(screen.TITLE or next(filter(None, boxes), "Tangy"))
    if focused is not None and (own := _title(focused)):
        title = f"{title} · {own}"
    return Help(title, tuple(paragraphs), _pairs(here), _pairs(everywhere))


def _title(widget: Widget) -> str:
    """Return the title of a widget without its markup."""
    return Content.from_markup(widget.border_title or "").plain


def _yes(screen: Screen[Any]) -> str:
    """Return the key for yes: of this question, or of the next ones."""
    own: str = getattr(screen, "yes_key", "")
    return own or (DIGIT_SHOWN if draws_digit(screen.app) else "y")


def _has_phrases(screen: Screen[Any]) -> bool:
    """Return whether the screen has a phrasebook."""
    return bool(screen.query("#command-input")) and hasattr(screen.app, "action_phrases")


def _pairs(keys: dict[str, str]) -> Keys:
    return tuple((key, does) for does, key in keys.items())


class HelpScreen(Dialog[None]):
    """The help above a screen; esc, q and ? close it.

    Enter does not: "?" may be typed as a command with Enter, which would close it at once.
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
        """Focus the text."""
        self.query_one(VerticalScroll).focus()

    def action_close(self) -> None:
        """Close the dialog."""
        self.answer(None)

    async def action_phrases(self) -> None:
        """Open the phrasebook, if the screen takes commands."""
        app = self.app
        below = [screen for screen in app.screen_stack if screen is not self]
        if below and _has_phrases(below[-1]):
            self.answer(None)
            app.call_next(app.run_action, "app.phrases")

    def on_click(self, event: events.Click) -> None:
        """Close on a click outside."""
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
