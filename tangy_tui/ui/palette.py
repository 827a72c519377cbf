"""The command palette: all available actions, found by name or by typed word.

It has one line for each action, with its key, and covers as little of the screen as possible: over
a slow link, every changed cell costs time.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

from textual import on
from textual.await_complete import AwaitComplete
from textual.command import CommandPalette, DiscoveryHit, Hit, Hits, Provider
from textual.content import Content
from textual.message import Message
from textual.types import IgnoreReturnCallbackType
from textual.widgets import Input, OptionList

from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.listing import listed

EXACT = 1000.0
"""The score of the action whose word was typed, which is listed first."""
SELF = ("palette", "help")


class PaletteEntry(NamedTuple):
    """One line: an action's name, key, typed word, and callback."""

    name: str
    key: str
    word: str
    run: IgnoreReturnCallbackType


class ActionsProvider(Provider):
    """Provides the actions of the screen, and the application's commands without a key."""

    async def discover(self) -> Hits:
        """Yield all actions in the order of the keymap, keys for editing a line last."""
        for entry in sorted(self._entries(), key=lambda entry: not entry.word):
            yield DiscoveryHit(_line(Content(entry.name), entry), entry.run, text=entry.name)

    async def search(self, query: str) -> Hits:
        """Yield the actions whose name or word resembles the typed text."""
        matcher, typed = self.matcher(query), query.strip().casefold()
        for entry in self._entries():
            score = matcher.match(entry.name)
            if entry.word:
                score = max(score, matcher.match(entry.word))
                score = EXACT if entry.word == typed else score
            if score > 0:
                name = matcher.highlight(entry.name)
                yield Hit(score, _line(name, entry), entry.run, text=entry.name)

    def _entries(self) -> Iterator[PaletteEntry]:
        app = self.app
        for one in listed(self.screen):
            if one.word not in SELF and one.action != "command_palette":
                run = partial(app.run_action, one.action, one.node)
                yield PaletteEntry(clean(one.name), one.key, one.word, run)
        for command in app.get_system_commands(self.screen):
            yield PaletteEntry(command.title, "", "", command.callback)


def _line(name: Content, entry: PaletteEntry) -> Content:
    key = Content.styled(f"{entry.key:>6}  ", "$primary bold")
    word = entry.word if entry.word not in (entry.name.casefold(), "") else ""
    return Content.assemble(key, name, (f"   {word}", "$ink-dim") if word else "")


class Palette(CommandPalette):
    """The command palette, without a blinking cursor, above an undimmed screen."""

    DEFAULT_CSS = """
    Palette { background: transparent; }
    Palette > Vertical { margin-top: 1; width: 64; max-width: 96%; }
    Palette #--results { max-height: 14; border: none; }
    Palette #--input { border: none; }
    Palette #--input SearchIcon { display: none; }
    """

    def on_mount(self) -> None:
        """Stop the cursor's blinking: each blink would be sent to the terminal."""
        for line in self.query(Input):
            line.cursor_blink = False

    def dismiss(self, result: None = None) -> AwaitComplete:
        """Close the palette once: the next Esc or Enter may come before it is gone."""
        return super().dismiss(result) if self.is_active else AwaitComplete()

    @on(Input.Submitted)
    @on(OptionList.OptionSelected)
    def _keep_first(self, event: Message) -> None:
        """Ignore Enter if a command was chosen already: it would run twice."""
        if not self.is_active:
            event.prevent_default()
