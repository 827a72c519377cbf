"""One fault in detail: timeline, evidence, and advice for staff."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from textual.binding import Binding, BindingType

from tangy_profiles.faults import FaultBook
from tangy_profiles.robot import Robot
from tangy_tui.monitoring.evidence import Label
from tangy_tui.monitoring.fault import Fault
from tangy_tui.text.fault_moves import move_words
from tangy_tui.text.fault_views import DONE_WHEN, HOW_KNOWN, WHAT_TO_DO
from tangy_tui.text.faults import (
    EvidenceLine,
    evidence_of,
    fault_time,
    kind_words,
    mark_of,
    state_words,
)
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.page import PageDialog
from tangy_tui.ui.widgets.page import PageLine, heading, paragraph
from tangy_tui.ui.widgets.wrapping import wrap


class FaultDialog(PageDialog):
    """The timeline of a fault, its evidence, and the advice."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,q,enter", "close", "Close", key_display="esc"),
    ]
    HELP = (
        "One fault in full: what it is, what was seen against what was to be expected, what "
        "Tangy and people did about it and when, and what you can do. Up and down scroll."
    )

    def __init__(self, fault: Fault, book: FaultBook, robot: Robot, label: Label = str) -> None:
        """Show a fault; `label` returns the words for a behaviour."""
        super().__init__(f"{mark_of(fault)} {clean(fault.name)}")
        self._label = label
        self._fault = fault
        self._book = book
        self._robot = robot

    @property
    def fault(self) -> Fault:
        """The fault shown."""
        return self._fault

    def write(self, width: int) -> list[PageLine]:
        """Format the page for a width in cells."""
        fault = self._fault
        lines = paragraph(clean(fault.console), width, "strong")
        kind = f"{kind_words(fault)}, after step {fault.step}; {state_words(fault)}"
        lines += paragraph(kind, width, "dim")
        lines += heading(DONE_WHEN) + timeline(fault, width)
        known = any(rule.code == fault.code for rule in self._book.rules)  # the log may be older
        pieces = evidence_of(fault, self._book, self._robot, self._label) if known else []
        if pieces:
            lines += heading(HOW_KNOWN) + evidence_lines(pieces, width)
        return lines + heading(WHAT_TO_DO) + advice_lines(fault.advice, width)


def timeline(fault: Fault, width: int) -> list[PageLine]:
    """Format each move with its time in the game, and its speech."""
    lines = _entry(fault_time(fault, fault.seconds), "noticed", width)
    for move in fault.moves:
        lines += _entry(fault_time(fault, move.seconds), move_words(move), width)
        lines += _indented(f"“{clean(move.speech)}”", width, "person") if move.speech else []
    return lines


def moves_so_far(fault: Fault, width: int) -> list[PageLine]:
    """Format a fault's recovery events with their times, without speech."""
    lines: list[PageLine] = []
    for move in fault.moves:
        lines += _entry(fault_time(fault, move.seconds), move_words(move), width)
    return lines


def _entry(time: str, words: str, width: int) -> list[PageLine]:
    first, *more = wrap(clean(words), max(10, width - 10))
    head = PageLine(((f"{time:>8}  ", "dim"), (first, "text")))
    return [head, *(PageLine(((f"{'':10}{text}", "text"),)) for text in more)]


def _indented(words: str, width: int, ink: str) -> list[PageLine]:
    return [PageLine(((f"{'':10}{text}", ink),)) for text in wrap(words, max(10, width - 10))]


def evidence_lines(pieces: Sequence[EvidenceLine], width: int) -> list[PageLine]:
    """Format the observations, each above its expectation."""
    lines: list[PageLine] = []
    for piece in pieces:
        lines += paragraph(clean(piece.what), width)
        note = wrap(clean(piece.note), max(10, width - 2)) if piece.note else []
        lines += [PageLine(((f"  {text}", "dim"),)) for text in note]
    return lines


def advice_lines(advice: Sequence[str], width: int) -> list[PageLine]:
    """Format the numbered steps for staff."""
    lines: list[PageLine] = []
    for number, step in enumerate(advice, 1):
        first, *more = wrap(clean(step), max(10, width - 3))
        lines.append(PageLine(((f"{number}. ", "robot"), (first, "text"))))
        lines += [PageLine(((f"   {text}", "text"),)) for text in more]
    return lines
