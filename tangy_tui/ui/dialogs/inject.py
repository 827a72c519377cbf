"""The choice of a fault to inject into the simulated world, or to lift."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
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
from tangy_tui.ui.pasted_text import pasted_text
from tangy_tui.ui.widgets.choice_list import ChoiceLine, ChoiceList
from tangy_tui.ui.widgets.rows import fit, shorten

THERE, TO_COME = "there: enter lifts it", "to come: enter lifts it"


class KindList(ChoiceList):
    """The list of kinds: letters filter, also if many arrive together; digits choose."""

    LETTERS_FILTER = True

    def __init__(self, help: str, changed: Callable[[], None]) -> None:
        """Make an empty list.

        Args:
            help: what its help says.
            changed: called when the filter has changed; shows what matches.
        """
        super().__init__("", help)
        self._changed = changed

    def _is_filter_key(self, event: events.Key) -> bool:
        if event.is_printable and event.character in set("123456789-'"):
            return event.character in "-'" or bool(pasted_text(event))
        return super()._is_filter_key(event)

    def _kept(self, lines: Sequence[ChoiceLine]) -> Sequence[ChoiceLine]:
        return lines  # the dialog filters: it knows more names of a kind than the line shows

    def _refilter(self) -> None:
        self._changed()


class InjectDialog(Dialog[str | None]):
    """Lists all kinds of fault; letters filter, a number or Enter chooses."""

    DEFAULT_CSS = """
    InjectDialog > .box { width: 78; padding: 0 1; }
    InjectDialog KindList { height: auto; max-height: 18; min-height: 1; }
    InjectDialog.-low KindList { max-height: 12; }
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
        self.kinds: tuple[FaultKind, ...] = ()

    def compose(self) -> ComposeResult:
        """Lay out the kinds."""
        box = Vertical(KindList(self.HELP, self._show), id="inject", classes="box")
        box.border_title = WHICH
        yield box

    def on_mount(self) -> None:
        """Show all kinds."""
        self.query_one(KindList).focus()
        self._show()

    def _show(self) -> None:
        shown = self.query_one(KindList)
        words = shown.filter.lower().split()
        order = sorted(self._all, key=lambda kind: not self._lifts(kind))
        self.kinds = tuple(
            kind for kind in order if all(w in self._found_by[kind.name] for w in words)
        )
        shown.styles.height = max(1, len(self.kinds))
        shown.show(lambda width, height: self._lines(width))
        keys = "type to search   1-9 or enter takes   esc goes back"
        searched = Content(f"{clean(shown.filter)}_   enter takes   esc shows all")
        self.query_one("#inject").border_subtitle = searched if shown.filter else keys

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
        """Choose with Enter or a number; letters have gone to the list."""
        if event.key in ("up", "down", "pageup", "pagedown", "home", "end", "question_mark"):
            return
        event.stop()
        event.prevent_default()
        if event.key == "enter":
            self.app.call_later(self._take)  # after the moves that arrived before it
        elif event.key == "escape":
            self.answer(None)
        elif event.key in "123456789" and int(event.key) <= len(self.kinds):
            self.answer(self.kinds[int(event.key) - 1].name)

    def _take(self) -> None:
        if self.kinds:
            self.answer(str(self.query_one(KindList).chosen))

    def action_nothing(self) -> None:
        """Do nothing: `on_key` handles the keys, to check each of them."""


def comes_later(kind: str) -> bool:
    """Return whether a fault is noticed only when the robot does something."""
    return KINDS[kind].shows != AT_ONCE
