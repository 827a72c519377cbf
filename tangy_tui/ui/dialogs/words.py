"""The choice of one of some words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content

from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.type_ahead_guard import Clock, FreshKeys
from tangy_tui.ui.widgets.choice_list import ChoiceLine, ChoiceList
from tangy_tui.ui.widgets.rows import Row


class WordsDialog(Dialog[str | None]):
    """Lists words; up and down or first letters move the cursor, Enter chooses."""

    DEFAULT_CSS = """
    WordsDialog > .box { width: 50; padding: 0 1; }
    WordsDialog ChoiceList { height: auto; max-height: 16; }
    WordsDialog.-low ChoiceList { max-height: 11; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [Binding("enter", "nothing", "Choose it")]
    HELP = "Go to one with up and down, or with its first letter, and press Enter. Esc goes back."

    def __init__(self, title: str, words: Sequence[str], *, clock: Clock | None = None) -> None:
        super().__init__(None)
        self._title = clean(title)
        self._words = tuple(words)
        self._clock = clock
        self._keys = FreshKeys()

    def compose(self) -> ComposeResult:
        """Lay out the words."""
        box = Vertical(ChoiceList("", self.HELP), id="words", classes="box")
        box.border_title = Content(self._title)
        box.border_subtitle = "enter chooses   esc goes back"
        yield box

    def on_mount(self) -> None:
        """Show the words, and accept keys from now on."""
        words = self.query_one(ChoiceList)
        words.styles.height = len(self._words)
        words.show(lambda width, height: [ChoiceLine(_row(word), word) for word in self._words])
        words.focus()
        self._keys.watch(self, self._clock)

    def on_key(self, event: events.Key) -> None:
        """Choose with Enter, close with esc, jump to a first letter."""
        words = self.query_one(ChoiceList)
        if event.key in ("enter", "escape"):
            if self._keys.take(event):
                self.answer(str(words.chosen) if event.key == "enter" else None)
        elif event.character and event.character.isalpha():
            event.stop()
            self._jump(words, event.character.lower())

    def _jump(self, words: ChoiceList, letter: str) -> None:
        """Move the cursor to the next word with this first letter."""
        at = self._words.index(str(words.chosen))
        turned = self._words[at + 1 :] + self._words[: at + 1]
        found = next((word for word in turned if word.lower().startswith(letter)), None)
        if found is not None:
            words.action_choose(self._words.index(found) - at)

    def action_nothing(self) -> None:
        """Do nothing: `on_key` handles the keys, to check each of them."""


def _row(word: str) -> Row:
    return ((clean(word), "text"),)
