"""The explanation of one decision: votes, demonstrated steps, and the draws of a strategy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

from rich.cells import cell_len
from textual.app import ComposeResult
from textual.binding import Binding, BindingType

from tangy_profiles.activity import Activity
from tangy_profiles.beliefs import Beta
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.persuasion import StrategyChoice
from tangy_tui.learning.conflicts import DemonstratedStep
from tangy_tui.learning.explanation import DecisionReasons
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policy import SURE
from tangy_tui.text.decisions import (
    HOW_SURE,
    WHY_HEADINGS,
    chosen_words,
    earlier_words,
    reasons_words,
    strategy_title,
    why_words,
)
from tangy_tui.text.numbers import counted
from tangy_tui.text.whose_turn import IN_DETAIL
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.page import PageDialog
from tangy_tui.ui.messages import OpenStep
from tangy_tui.ui.widgets.page import Page, PageLine, heading, paragraph
from tangy_tui.ui.widgets.policy_table import bar
from tangy_tui.ui.widgets.posteriors import curve
from tangy_tui.ui.widgets.rows import Span, fit, shorten

LONGEST_BAR = 20
LONGEST_CURVE = 16
SHORTEST_CURVE = 4
MOST = 8
"""The number of steps of a group that are shown at first, the newest."""


@dataclass(frozen=True, slots=True)
class ComingStep:
    """The step that Tangy takes next, in words, its explanation, and a heading for the last one."""

    words: str
    why: DecisionReasons
    before: str


class WhyDialog(PageDialog):
    """The situation, the votes, the steps behind a decision, and the draws of a strategy.

    Up and down go from step to step and scroll; Enter opens the step in its demonstration. The
    newest steps come first; if there are many, Enter on the last line shows the others. In a game,
    where staff read plain sentences first, Enter closes the dialog until they go to a step.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,q,w", "close", "Close", key_display="esc"),
    ]
    HELP = (
        "First what Tangy does now and why, and who waits. Then the details: what it does next, "
        "and what its last step rests on: how sure Tangy is of each "
        "behaviour, which demonstrated steps say so or say otherwise, and for a way of speaking "
        "the number that was drawn from what is believed of each. Up and down choose a step and "
        "scroll; then Enter opens it where it was demonstrated. The newest steps come first; "
        "Enter on the last line shows the others."
    )

    def __init__(
        self,
        workspace: Workspace,
        why: DecisionReasons,
        choice: StrategyChoice | None = None,
        *,
        title: str = "Why this?",
        remarks: Sequence[str] = (),
        coming: ComingStep | None = None,
    ) -> None:
        """Create the dialog.

        Args:
            workspace: the workspace of the decision.
            why: the explanation of the decision.
            choice: the strategy that was chosen with the decision, if any.
            title: the title of the dialog.
            remarks: sentences before the others, such as who answered what.
            coming: the step that follows the explained one; it is explained first.
        """
        super().__init__(clean(title))
        self._workspace = workspace
        self._why = why
        self._choice = choice
        self._remarks = tuple(remarks)
        self.coming = coming
        """The next step of the game, explained before the last one."""
        self.plain: Sequence[str] = ()
        """What Tangy does now and why, in plain sentences, before all details."""
        self.at = ""
        """The time of day of these sentences; "": the game is played in simulated time."""
        self._whole = set[int]()  # the groups of steps that are shown in full
        library = read_library(workspace.store, workspace.activity.name)
        self._numbers = {id: n for n, id in enumerate(library.entries, 1)}

    def compose(self) -> ComposeResult:
        """Lay out the page, with the keys that work at first, and the time of a live answer."""
        opens = "enter opens a step   " if self._why.steps and not self.plain else ""
        self._keys = f"{opens}esc closes"
        if self.at:
            self._title = f"{self._title}, at {self.at}"
        yield from super().compose()

    @property
    def why(self) -> DecisionReasons:
        """The explanation shown."""
        return self._why

    def on_page_chosen(self, event: Page.Chosen) -> None:
        """Open a step in its demonstration; close the plain sentences if none was gone to."""
        event.stop()
        if self.plain and not event.page.moved:
            self.action_close()
            return
        if event.index >= len(self._why.steps):
            self._whole.add(event.index - len(self._why.steps))
            page = self.query_one(Page)
            page.show(self.write, page.cursor)
            return
        shown = self._why.steps[event.index]
        self.post_message(OpenStep(shown.demonstration, shown.number))

    def write(self, width: int) -> list[PageLine]:
        """Format the page for a width in cells."""
        lines: list[PageLine] = []
        for sentence in self.plain:
            lines += paragraph(clean(sentence), width, "strong")
        lines += heading(IN_DETAIL) if self.plain else []
        if (coming := self.coming) is not None:
            lines += paragraph(clean(coming.words), width, "text" if self.plain else "strong")
            for sentence in reasons_words(self._workspace.activity, coming.why):
                lines += paragraph(clean(sentence), width)
            lines += heading(clean(coming.before))
        words = why_words(self._workspace.activity, self._why, votes=False)
        for sentence in (*self._remarks, *words):
            lines += paragraph(clean(sentence), width)
        lines += vote_lines(self._workspace.activity, self._why, width)
        if self._choice is not None:
            lines += choice_lines(self._choice, self._workspace.name(self._choice.person), width)
        return lines + self._step_lines(width)

    def _step_lines(self, width: int) -> list[PageLine]:
        why = self._why
        lines: list[PageLine] = []
        first = 0  # of a group, among all steps
        groups = (why.rests_on, why.against, why.near)
        for group, (title, steps) in enumerate(zip(WHY_HEADINGS, groups, strict=True)):
            if steps:
                lines += heading(f"{title} {counted(len(steps), 'step')}")
            few = steps if group in self._whole or len(steps) <= MOST + 1 else steps[-MOST:]
            last = first + len(steps) - 1
            for number, shown in enumerate(reversed(few)):
                lines.append(PageLine(self._step(shown, bool(why.near), width), last - number))
            if rest := len(steps) - len(few):
                lines.append(PageLine(((earlier_words(rest), "dim"),), len(why.steps) + group))
            first += len(steps)
        return lines

    def _step(self, shown: DemonstratedStep, elsewhere: bool, width: int) -> tuple[Span, ...]:
        """Format a step: behaviour, demonstration, teacher; for a similar situation, that too."""
        number = self._numbers.get(shown.demonstration)
        where = f"demonstration {number}" if number else shown.demonstration
        behaviour = clean(self._workspace.activity.behaviour_words(shown.step.behaviour))
        if elsewhere:
            situation = self._workspace.activity.in_words(shown.step.state.situation)
            behaviour = f"{clean(situation)} -> {behaviour}"
        tail = f"  step {shown.number} of {where}, {clean(shown.teacher)}"
        head = shorten(behaviour, max(12, width - 2 - cell_len(tail)))
        return (
            ("  ", "text"),
            (head, "strong"),
            (shorten(tail, width - 2 - cell_len(head)), "text"),
        )


def vote_lines(activity: Activity, why: DecisionReasons, width: int) -> list[PageLine]:
    """Draw the votes as bars, the largest first."""
    votes = why.decision.votes
    names = [clean(activity.behaviour_words(behaviour)) for behaviour, _ in votes]
    label = min(max(map(cell_len, names)), max(8, width - 12))
    points = min(LONGEST_BAR, max(0, width - label - 9))
    lines = heading(HOW_SURE)
    for name, (behaviour, share) in zip(names, votes, strict=True):
        decided = behaviour == why.decision.behaviour
        ink = "curve" if share >= SURE else "warn"
        lines.append(
            PageLine(
                (
                    ("  ", "text"),
                    (fit(name, label), "strong" if decided else "text"),
                    ("  ", "text"),
                    (bar(share, points), ink),
                    (f" {share:>4.0%}", "text" if share >= SURE else "warn"),
                )
            )
        )
    return lines


def choice_lines(choice: StrategyChoice, name: str, width: int) -> list[PageLine]:
    """Explain the choice of a strategy: the draw of each, and its posterior."""
    lines = heading(strategy_title(clean(name), clean(choice.strategy)))
    if choice.method:
        lines += paragraph(chosen_words(clean(choice.method)), width)
    label = min(14, max(cell_len(clean(strategy)) for strategy in choice.draws))
    points = min(LONGEST_CURVE, width - label - 34)
    head = f"  {fit('', label)}  number  done/asked  mean"
    lines.append(PageLine(((head, "dim"),)))
    off = [strategy for strategy in choice.beliefs if strategy not in choice.draws]
    for strategy, number in sorted(choice.draws.items(), key=lambda draw: -draw[1]):
        used = strategy == choice.strategy
        mark = "★ " if used else "  "
        row: list[Span] = [
            (mark, "good"),
            (fit(clean(strategy), label), "strong" if used else "text"),
            (f"  {number:>6.3f}", "strong" if used else "text"),
            *_belief(choice.beliefs, strategy, points),
        ]
        lines.append(PageLine(tuple(row)))
    if off:
        lines += paragraph(f"Switched off: {', '.join(map(clean, off))}.", width, "dim")
    return lines


def _belief(beliefs: Mapping[str, Beta], strategy: str, points: int) -> tuple[Span, ...]:
    """Format the posterior of a strategy; "" if it was not logged."""
    belief = beliefs.get(strategy)
    if belief is None:
        return ()
    counts = f"{belief.complied}/{belief.trials}"
    drawn = curve(belief, points) if points >= SHORTEST_CURVE else ""
    return (
        (f"  {counts:>10}", "text"),
        (f"  {belief.mean:.2f}", "text"),
        ("  ", "text"),
        (drawn, "curve"),
    )
