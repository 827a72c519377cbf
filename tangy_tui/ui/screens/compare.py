"""Two policies side by side, row by row: of two teachers, or before and after."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

from rich.cells import cell_len
from textual.app import App, ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import Static

from tangy_profiles.activity import Activity
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.comparison import SituationComparison, compare
from tangy_tui.learning.policy import Decision, Policy
from tangy_tui.text.comparison import WHY_A, WHY_B
from tangy_tui.text.keys import with_keys
from tangy_tui.text.numbers import counted
from tangy_tui.text.policies import (
    ALL_THE_SAME,
    NOTHING_TO_COMPARE,
    ONE_POLICY,
    WHICH,
    compared_words,
)
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.choose import ChooseDialog
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.keys import bind, keymap_of
from tangy_tui.ui.panels import key_line, panel
from tangy_tui.ui.policy_options import DIGEST_SHOWN, comparison_options, policy_options
from tangy_tui.ui.reasons import why_row
from tangy_tui.ui.widgets.page import Page, PageLine
from tangy_tui.ui.widgets.rows import Span, fit
from tangy_tui.ui.widgets.status_line import Status, StatusLine

SIDE_BY_SIDE = 110
"""From this width in cells, a situation and both policies fit on one line."""


WIDEST = 44
"""The greatest width of one policy in cells, so that both can be read together."""


async def choose_two(app: App[Any], workspace: Workspace, first: str | None) -> list[str]:
    """Let the user choose two policies or teachers; `first` is one already. [] if cancelled."""
    options = comparison_options(workspace.store, workspace.activity)
    if len(options) < 2:
        await app.push_screen_wait(MessageDialog(ONE_POLICY, title=NOTHING_TO_COMPARE))
        return []
    wanted = [] if first is None else [first]
    for question in ("Compare:", "Compare with:")[len(wanted) :]:
        left = [option for option in options if option.id not in wanted]
        chosen = await app.push_screen_wait(ChooseDialog(question, left))
        if chosen is None:
            return []
        wanted.append(chosen)
    return wanted


async def choose_policy(app: App[Any], workspace: Workspace) -> str | None:
    """Let the user choose one of the stored policies."""
    options = policy_options(workspace.store, workspace.activity)
    return await app.push_screen_wait(ChooseDialog(WHICH, options))


def decision_words(activity: Activity, decision: Decision) -> str:
    """Format the behaviour and its share of votes, or why Tangy would ask."""
    if not decision.seen:
        return "asks: never shown"
    if decision.contested:
        return "asks: contested"
    asks = "" if decision.sure else " (asks)"
    return f"{activity.behaviour_words(decision.behaviour)} {decision.share:.0%}{asks}"


class CompareScreen(TangyScreen[None]):
    """Every situation with the behaviours of A and B; marked rows that differ come first."""

    TITLE = "Compare"
    CSS = """
    CompareScreen #summary { height: auto; max-height: 5; padding: 0 1; margin: 1 0 0 0; }
    CompareScreen #comparison { height: 1fr; }
    """
    HELP = (
        "Two policies side by side: in each situation what both do, and how sure they are "
        "of it. Rows that differ come first and have a mark; {differences} shows only "
        "these. 1 tells why A does so, and 2 why B does; Enter is 1."
    )
    BINDINGS: ClassVar[list[BindingType]] = [
        *bind("differences"),
        *bind("why", "why(0)"),
        Binding("1", "why(0)", WHY_A, id="number"),
        Binding("2", "why(1)", WHY_B, id="number"),
        *bind("another", "choose"),
        *bind("back", "leave"),
    ]

    def __init__(
        self, workspace: Workspace, a: Policy, b: Policy, notices: Sequence[str] = ()
    ) -> None:
        """Create the screen; `notices` are warnings about the policies."""
        super().__init__()
        self._workspace = workspace
        self._pair = (a, b)
        self._notices = tuple(notices)
        rows = compare(workspace.activity, a, b)
        self._all = sorted(rows, key=lambda row: row.same)
        self._only = False

    @property
    def rows(self) -> list[SituationComparison]:
        """The rows shown."""
        return [row for row in self._all if not (self._only and row.same)]

    def compose(self) -> ComposeResult:
        """Lay out the compared policies above the rows."""
        yield StatusLine(Status(mode="compare", note=" : ".join(p.name for p in self._pair)))
        yield Static(self._summary(), id="summary", markup=False)
        yield panel(Page(self._write, id="comparison"), "Comparison")
        yield key_line(
            ("1 2", "why"), "differences:differences", "filter", "another", "back", "help"
        )

    def on_mount(self) -> None:
        """Focus the page."""
        self.query_one(Page).focus()

    def action_differences(self) -> None:
        """Show only the rows that differ, or all."""
        self._only = not self._only
        self.query_one(Page).show(self._write)

    def action_why(self, which: int) -> None:
        """Explain the behaviour of A or B in the chosen row."""
        chosen, rows = self.query_one(Page).chosen, self.rows
        if chosen is not None and chosen < len(rows):
            policy = self._pair[which]
            self.app.push_screen(why_row(self._workspace, policy, rows[chosen].situation))

    def on_page_chosen(self, event: Page.Chosen) -> None:
        """Explain A's behaviour."""
        event.stop()
        self.action_why(0)

    async def action_choose(self) -> None:
        """Compare other policies."""
        self.leave(None)
        await self.run_action("app.compare")

    def action_leave(self) -> None:
        """Close the screen."""
        self.leave(None)

    def _summary(self) -> str:
        differ = sum(not row.same for row in self._all)
        said = compared_words(differ, len(self._all))
        names = [
            f"{letter}: {policy.name} ({policy.digest[:DIGEST_SHOWN]}, "
            f"{counted(len(policy.demonstrations), 'demonstration')})"
            for letter, policy in zip("AB", self._pair, strict=True)
        ]
        return clean(" ".join(["   ".join(names) + ".", said, *self._notices]))

    def _write(self, width: int) -> list[PageLine]:
        rows = self.rows
        if not rows:
            return [PageLine(((with_keys(ALL_THE_SAME, keymap_of(self.app)), "dim"),))]
        activity = self._workspace.activity
        words = [clean(activity.in_words(row.situation)) for row in rows]
        label = max(cell_len(word) for word in words) + 2
        wide = width >= SIDE_BY_SIDE
        half = min(WIDEST, max(8, (width - (label if wide else 0) - 4) // 2))
        lines: list[PageLine] = []
        for number, (row, word) in enumerate(zip(rows, words, strict=True)):
            head: tuple[Span, ...] = (
                ("  " if row.same else "! ", "warn"),
                (fit(word, label if wide else width - 2), "text" if row.same else "strong"),
            )
            both = (
                *self._side("A", row.a, row.same, half),
                *self._side("B", row.b, row.same, half),
            )
            if wide:
                lines.append(PageLine((*head, *both), number))
            else:
                lines += [PageLine(head, number), PageLine((("    ", "text"), *both), number)]
        return lines

    def _side(self, letter: str, decision: Decision, same: bool, width: int) -> tuple[Span, ...]:
        ink = "text" if same else ("strong" if decision.sure else "warn")
        words = decision_words(self._workspace.activity, decision)
        return ((f"{letter} ", "dim"), (fit(clean(words), width - 2), ink))
