"""The palette: everything that can be done here, found by name or by its typed word.

It lists one line for each action, with its key, and covers no more of the screen than it needs:
over a slow link each cell that changes is time that a person waits.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

from textual.command import CommandPalette, DiscoveryHit, Hit, Hits, Provider
from textual.content import Content
from textual.types import IgnoreReturnCallbackType
from textual.widgets import Input

from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.listing import listed

EXACT = 1000.0
"""The score of the action whose word was typed: it stands first."""
SELF = ("palette", "help")


class PaletteEntry(NamedTuple):
    """One line: its name, its key, the word to type for it, and what it does."""

    name: str
    key: str
    word: str
    run: IgnoreReturnCallbackType


class ActionsProvider(Provider):
    """Gives the palette the actions of the screen, and the program's commands without a key."""

    async def discover(self) -> Hits:
        """Give all of them in the order of the keymap, the keys that only edit a line last."""
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
    """The command palette, without a blinking cursor, over a screen that stays as it is."""

    DEFAULT_CSS = """
    Palette { background: transparent; }
    Palette > Vertical { margin-top: 1; width: 64; max-width: 96%; }
    Palette #--results { max-height: 14; border: none; }
    Palette #--input { border: none; }
    Palette #--input SearchIcon { display: none; }
    """

    def on_mount(self) -> None:
        """Keep the cursor still: each blink would be written to the terminal."""
        for line in self.query(Input):
            line.cursor_blink = False
