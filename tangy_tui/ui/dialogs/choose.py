"""The choice of one of several options: people, policies, activities."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar

from rich.cells import cell_len
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content

from tangy_profiles.person import unaccented
from tangy_tui.text.phrases import NONE_FOUND
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.page import Page, PageLine, Write
from tangy_tui.ui.widgets.rows import fit
from tangy_tui.ui.widgets.wrapping import wrap

UNFILTERED = "letters filter   enter takes it   esc goes back"
FILTERED = "/{}_   enter takes it   esc shows all"


@dataclass(frozen=True, slots=True)
class Option:
    """One option: its id, its name, and a description."""

    id: str
    name: str
    note: str = ""


class OptionPage(Page):
    """The options; letters filter them by name, with or without accents."""

    LETTERS_FILTER = True

    def __init__(self, write: Write, names: Sequence[str]) -> None:
        super().__init__(write)
        self._names = [unaccented(name) for name in names]

    def _kept(self, lines: Sequence[PageLine]) -> Sequence[PageLine]:
        """Return the lines of the options whose names match, those that begin so first.

        Their notes do not count.
        """
        words = unaccented(self.filter).split()
        kept = [
            line
            for line in lines
            if line.choice is None or all(word in self._names[line.choice] for word in words)
        ]
        kept.sort(key=self._rank)
        return kept or [PageLine(((NONE_FOUND, "dim"),))]

    def _rank(self, line: PageLine) -> int:
        wanted = unaccented(self.filter).strip()
        name = "" if line.choice is None else self._names[line.choice]
        return 0 if name == wanted else 1 if name.startswith(wanted) else 2

    def _say_filter(self, count: str = "") -> None:
        """Show the filter at the foot of the dialog."""
        keys = FILTERED.format(clean(self.filter)) if self.filter else UNFILTERED
        self.screen.query_one(".box").border_subtitle = keys.replace("[", "\\[")


class ChooseDialog(Dialog[str | None]):
    """Up and down move the cursor, letters filter, Enter chooses.

    The answer is the id of the option, or None.
    """

    DEFAULT_CSS = """
    ChooseDialog > .box { width: 78; padding: 0 1; }
    ChooseDialog Page { height: auto; max-height: 1fr; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape", "close", "Choose none", key_display="esc"),
    ]
    HELP = (
        "Choose with up and down, and take it with Enter. Type some letters to see only the lines "
        "with them; esc shows all lines again, or goes back without a choice."
    )

    def __init__(self, question: str, options: Sequence[Option]) -> None:
        super().__init__(None)
        self._question = clean(question)
        self._options = tuple(options)

    def compose(self) -> ComposeResult:
        """Lay out the list."""
        names = [option.name for option in self._options]
        box = Vertical(OptionPage(self._write, names), id="choose", classes="box")
        box.border_title = Content(self._question)
        box.border_subtitle = UNFILTERED
        yield box

    def on_mount(self) -> None:
        """Focus the list."""
        self.query_one(Page).focus()

    def on_page_chosen(self, event: Page.Chosen) -> None:
        """Close with the chosen option."""
        event.stop()
        self.answer(self._options[event.index].id)

    def action_close(self) -> None:
        """Choose none."""
        self.answer(None)

    def _write(self, width: int) -> list[PageLine]:
        label = min(width // 2, max((cell_len(clean(o.name)) for o in self._options), default=0))
        return [
            PageLine((("  ", "text"), (fit(name, label), "strong"), (f"  {note}", "dim")), number)
            for number, option in enumerate(self._options)
            for name, note in _lines(option, width - label - 5)
        ]


def _lines(option: Option, width: int) -> Iterator[tuple[str, str]]:
    """Yield the lines of an option: its name and a part of its note, wrapped to a width."""
    name = clean(option.name)
    for line in wrap(clean(option.note), width) or [""]:
        yield name, line
        name = ""
