"""The choice of a fault to inject into the simulated world, or to lift."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import ClassVar

from rich.cells import cell_len
from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content

from tangy_sim.worlds.injection import AT_ONCE, KINDS, FaultKind
from tangy_tui.text.injections import NONE_FOUND, WHICH
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.choice_list import ChoiceLine, ChoiceList
from tangy_tui.ui.widgets.rows import fit, shorten

THERE, TO_COME = "there: enter lifts it", "to come: enter lifts it"
LONGEST = 30


class InjectDialog(Dialog[str | None]):
    """Lists all kinds of fault; letters filter, a number or Enter chooses."""

    DEFAULT_CSS = """
    InjectDialog > .box { width: 78; padding: 0 1; }
    InjectDialog ChoiceList { height: auto; max-height: 18; min-height: 1; }
    InjectDialog.-low ChoiceList { max-height: 12; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter", "nothing", "Bring it about, or lift it"),
        Binding("escape", "nothing", "Show all, or go back", key_display="esc"),
    ]
    HELP = (
        "What can go wrong in the simulated room. Type a part of a word to keep only what has it, "
        "go to one with up and down and press Enter, or press its number. What is there already "
        "is put right by choosing it again. Esc shows all, and then goes back."
    )

    def __init__(
        self, there: Collection[str], to_come: Collection[str], called: Mapping[str, str]
    ) -> None:
        """Create the dialog.

        Args:
            there: the kinds of the present faults.
            to_come: the kinds that are still to come.
            called: the kinds that are possible for this robot, with the console's name of each
                fault, which the filter also matches.
        """
        super().__init__(None)
        self._all = [kind for kind in KINDS.values() if kind.name in called]
        self._there = frozenset(there)
        self._to_come = frozenset(to_come)
        self._found_by = {
            kind.name: f"{kind.name} {kind.words} {called[kind.name]}".lower() for kind in self._all
        }
        self._typed = ""
        self.kinds: tuple[FaultKind, ...] = ()

    def compose(self) -> ComposeResult:
        """Lay out the kinds."""
        box = Vertical(ChoiceList("", self.HELP), id="inject", classes="box")
        box.border_title = WHICH
        yield box

    def on_mount(self) -> None:
        """Show all kinds."""
        self.query_one(ChoiceList).focus()
        self._show()

    def _show(self) -> None:
        words = self._typed.lower().split()
        order = sorted(self._all, key=lambda kind: not self._lifts(kind))
        self.kinds = tuple(
            kind for kind in order if all(w in self._found_by[kind.name] for w in words)
        )
        kinds = self.query_one(ChoiceList)
        kinds.styles.height = max(1, len(self.kinds))
        kinds.show(lambda width, height: self._lines(width))
        keys = "type to search   1-9 or enter takes   esc goes back"
        searched = Content(f"{clean(self._typed)}_   enter takes   esc shows all")
        self.query_one("#inject").border_subtitle = searched if self._typed else keys

    def _lines(self, width: int) -> list[ChoiceLine]:
        if not self.kinds:
            return [ChoiceLine(((NONE_FOUND, "dim"),))]
        label = max(cell_len(kind.name) for kind in self._all)
        lines: list[ChoiceLine] = []
        for number, kind in enumerate(self.kinds, 1):
            note = THERE if kind.name in self._there else TO_COME
            note = f"  ({note})" if self._lifts(kind) else ""
            room = width - label - 5 - cell_len(note)
            lines.append(
                ChoiceLine(
                    (
                        (f"{number if number <= 9 else '':>2} ", "robot"),
                        (fit(kind.name, label), "strong"),
                        (shorten(f"  {kind.words}", room), "text"),
                        (note, "warn"),
                    ),
                    kind.name,
                )
            )
        return lines

    def _lifts(self, kind: FaultKind) -> bool:
        return kind.name in self._there or kind.name in self._to_come

    def on_key(self, event: events.Key) -> None:
        """Choose with Enter or a number; letters filter."""
        if event.key in ("up", "down", "pageup", "pagedown", "home", "end"):
            return
        if event.key != "question_mark":
            event.stop()
            event.prevent_default()
        if event.key == "enter" and self.kinds:
            self.answer(str(self.query_one(ChoiceList).chosen))
        elif event.key == "escape":
            if not self._typed:
                self.answer(None)
            self._typed = ""
        elif event.key == "backspace":
            self._typed = self._typed[:-1]
        elif event.key in "123456789" and int(event.key) <= len(self.kinds):
            self.answer(self.kinds[int(event.key) - 1].name)
        elif event.character and (event.character.isalpha() or event.character in " -'"):
            self._typed = (self._typed + event.character)[:LONGEST]
        else:
            return
        if self.is_attached:
            self._show()

    def action_nothing(self) -> None:
        """Do nothing: `on_key` handles the keys, to check each of them."""


def comes_later(kind: str) -> bool:
    """Return whether a fault is noticed only when the robot does something."""
    return KINDS[kind].shows != AT_ONCE
