"""The drill: what staff see of a fault, two questions per round, and finally a score."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.content import Content
from textual.widgets import Static

from tangy_tui.monitoring.drill import Drill
from tangy_tui.monitoring.drill_rounds import Round
from tangy_tui.text.drills import (
    LEAVE,
    LEAVE_DETAIL,
    NO_HURRY,
    SAW,
    SEE_NOW,
    SHEET_KEPT,
    WAS_RIGHT,
    WELCOME,
    StyledLine,
    note_words,
    option_words,
    question_words,
    round_parts,
    sheet_lines,
    so_far_words,
    told_lines,
)
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.panels import LOW, KeyLine, key_line, panel
from tangy_tui.ui.type_ahead_guard import SETTLE_SECONDS, clock_of
from tangy_tui.ui.widgets.page import Page, PageLine, heading, paragraph
from tangy_tui.ui.widgets.status_line import Status, StatusLine
from tangy_tui.ui.widgets.wrapping import wrap

LABEL = 11
"""The width of the labels in cells."""

ON = ("enter",)
"""The keys that continue."""


class DrillScreen(TangyScreen[None]):
    """Rounds of observations, questions and corrections; then the score sheet.

    A question ignores keys typed before it was visible.
    """

    TITLE = "Rehearse"
    CSS_PATH = "drill.tcss"
    VERTICAL_BREAKPOINTS = LOW
    AUTO_FOCUS = "#drill"
    HELP = (
        f"{WELCOME} Answer by the number or letter. Some rounds have no fault: then Tangy goes on "
        "by itself. One point for each right answer; the time is told, and not scored. "
        "Esc leaves. Your answers are kept as an unfinished drill."
    )
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("1,2,3,4,0", "nothing", "Answer", key_display="0 to 4"),
        Binding("y,n", "nothing", "Yes or no", key_display="y n"),
        Binding("enter", "nothing", "Go on", key_display="enter"),
        Binding("escape", "leave", "Leave the drill"),
    ]

    def __init__(self, drill: Drill) -> None:
        """Create the screen of a drill that has not begun."""
        super().__init__()
        self.drill = drill
        self._from: float | None = None
        self._at_end = False

    def compose(self) -> ComposeResult:
        """Lay out the observations above the question."""
        yield StatusLine(Status(mode="rehearse"))
        yield panel(Page(id="drill"))
        yield Static(id="asked", markup=False)
        yield key_line(("esc", "leave"), ("?", "help"))

    def on_mount(self) -> None:
        """Explain the drill, and wait for a key."""
        page = self.query_one(Page)
        page.border_title = "Rehearse"
        note = self.drill.note
        told = ["" if note is None else note_words(note), WELCOME, NO_HURRY]
        page.show(lambda width: [
            line for part in told if part for line in [*paragraph(part, width), PageLine()]
        ])  # fmt: skip
        self._ask("Ready?", (("enter", "the first round"),))

    def on_unmount(self) -> None:
        """Store the answers, however the screen is closed."""
        self.drill.leave()

    def on_key(self, event: events.Key) -> None:
        """Handle an answer or Enter; ignore keys typed ahead."""
        question = self.drill.question
        keys = ON if question is None else question.keys
        if event.key not in (*keys, *ON):
            return
        event.stop()
        if self._from is None or event.time < self._from or event.key not in keys:
            return
        if question is None:
            self._go_on()
            return
        answered, shown = self.drill.answer(event.key), self.drill.round
        if answered is None or shown is None:
            self._show_question()
            return
        self._show_told(shown, told_lines(self.drill.simulator, shown, answered))

    def action_nothing(self) -> None:
        """Do nothing: `on_key` handles the keys, to check each of them."""

    def action_leave(self) -> None:
        """Leave; ask first if the drill is unfinished and has answers."""
        if self._at_end or not self.drill.sheet.answered or self.drill.over:
            self.leave(None)
            return
        self.app.push_screen(
            ConfirmDialog(
                LEAVE,
                LEAVE_DETAIL,
                yes="leave",
                no="go on with the drill",
            ),
            self._left,
        )

    def _left(self, leaves: bool | None) -> None:
        if leaves:
            self.drill.leave()  # stored before home reads it
            self.call_later(self.leave, None)

    def _go_on(self) -> None:
        if self._at_end:
            self.leave(None)
        elif self.drill.over:
            self._show_sheet()
        else:
            self._show_round()

    def _show_round(self) -> None:
        shown = self.drill.next()
        if shown is None:
            return
        self._status(f"{shown.number} of {self.drill.rounds}")
        page = self.query_one(Page)
        page.border_title = SEE_NOW
        page.show(lambda width: _seen(self.drill, shown, width))
        page.scroll_home(animate=False)
        self._show_question()
        self.call_after_refresh(self.drill.shown)

    def _show_question(self) -> None:
        question, shown = self.drill.question, self.drill.round
        if question is None or shown is None:
            return
        choices = tuple((choice.key, option_words(question, choice)) for choice in question.choices)
        self._ask(question_words(question, shown), choices)

    def _show_told(self, shown: Round, told: Sequence[StyledLine]) -> None:
        page = self.query_one(Page)
        page.border_title = WAS_RIGHT
        page.show(
            lambda width: [
                *(line for ink, words in told for line in paragraph(clean(words), width, ink)),
                *heading(SAW),
                *_seen(self.drill, shown, width),
            ]
        )
        page.scroll_home(animate=False)
        what = "your score" if self.drill.over else "the next round"
        self._ask(so_far_words(self.drill.sheet), (("enter", what),))

    def _show_sheet(self) -> None:
        self._at_end = True
        sheet = self.drill.sheet
        self._status("score")
        page = self.query_one(Page)
        page.border_title = "Score sheet"
        page.show(
            lambda width: [
                line
                for ink, words in sheet_lines(sheet, width, self.drill.before)
                for line in ([PageLine(((words, ink),))] if len(words) <= width else
                             paragraph(words, width, ink))
            ]
        )  # fmt: skip
        page.scroll_home(animate=False)
        self._ask(SHEET_KEPT, (("enter", "back"),))

    def _status(self, note: str) -> None:
        self.query_one(StatusLine).show(Status(mode="rehearse", note=note))

    def _ask(self, question: str, choices: tuple[tuple[str, str], ...]) -> None:
        """Show a question; keys count from a moment after it is visible."""
        parts: list[str | tuple[str, str]] = [(clean(question), "bold")]
        for key, words in choices:
            parts += ["\n", (f" {key} ", "$warning bold"), f" {clean(words)}"]
        self.query_one("#asked", Static).update(Content.assemble(*parts))
        keys = [key for key, _ in choices]
        answers = ("enter", "go on") if keys == ["enter"] else (" ".join(keys), "answer")
        self.query_one(KeyLine).show(
            answers, ("up down", "scroll"), ("esc", "leave"), ("?", "help")
        )
        self._from = None
        self.call_after_refresh(self._settle)

    def _settle(self) -> None:
        self._from = clock_of(self.app)() + SETTLE_SECONDS


def _seen(drill: Drill, shown: Round, width: int) -> list[PageLine]:
    """Format the observations of a round, with labels."""
    lines: list[PageLine] = []
    for label, text in round_parts(drill.simulator, shown):
        for number, part in enumerate(wrap(clean(text), max(8, width - LABEL))):
            name = label if number == 0 else ""
            ink = "strong" if label == "Noticed" else "text"
            lines.append(PageLine(((f"{name:{LABEL}}", "dim"), (part, ink))))
    return lines
