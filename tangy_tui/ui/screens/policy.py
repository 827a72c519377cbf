"""The policy screen: Tangy's behaviour in every situation, with its share of votes."""

from __future__ import annotations

from typing import Any, ClassVar

from textual.app import ComposeResult
from textual.binding import BindingType
from textual.widgets import Static

from tangy_profiles.activity import Activity
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.effects import Effects
from tangy_tui.learning.policy import Decision, Policy
from tangy_tui.text import policies as text
from tangy_tui.text.keys import with_keys
from tangy_tui.text.learnt import effects_words
from tangy_tui.text.numbers import counted, listed
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.keys import bind, keymap_of
from tangy_tui.ui.panels import key_line, panel
from tangy_tui.ui.reasons import why_row
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.policy_table import PolicyRow, PolicyTable
from tangy_tui.ui.widgets.status_line import Status, StatusLine


def policy_rows(activity: Activity, policy: Policy) -> list[PolicyRow]:
    """Return a row for every possible situation, in the order of a game."""
    return [
        _row(activity, activity.in_words(situation), policy.decide(situation))
        for situation in activity.situations
    ]


def _row(activity: Activity, words: str, decision: Decision) -> PolicyRow:
    """Format the behaviour in a situation, or why Tangy would ask."""
    if not decision.seen:  # Tangy asks there, whatever the trees vote for
        return PolicyRow(words, "never shown", 0.0, 0)
    if decision.contested:
        answers = listed((activity.behaviour_words(b) for b, _ in decision.votes), "or")
        return PolicyRow(words, "contested", decision.share, decision.seen, answers)
    note = "" if decision.sure else "not sure: asks"
    done = activity.behaviour_words(decision.behaviour)
    return PolicyRow(words, done, decision.share, decision.seen, note)


class PolicyScreen(TangyScreen[None]):
    """The policy table with vote shares, and the learnt effects."""

    CSS_PATH = "policy.tcss"
    HELP = (
        "One row for each situation that can come about: what Tangy does, how sure it is "
        "of that, and how often it was demonstrated. Below: what was seen to follow "
        "each behaviour. Choose a row and press Enter or {why} to see why; {compare} compares with "
        "another policy or a teacher, {another} shows another policy, {begin} lets Tangy "
        "play by it. Where nothing was shown, or demonstrations disagree, Tangy asks in the game."
    )
    BINDINGS: ClassVar[list[BindingType]] = [
        *bind("why"),
        *bind("begin", "play", name=text.PLAY_BY_THIS),
        *bind("compare"),
        *bind("another", "app.other_policy"),
        *bind("back", "leave"),
    ]

    def __init__(
        self,
        workspace: Workspace,
        policy: Policy,
        effects: Effects,
    ) -> None:
        """Create the screen."""
        super().__init__()
        self._workspace = workspace
        self.policy = policy
        self._effects = effects

    def compose(self) -> ComposeResult:
        """Lay out the table and the effects."""
        yield StatusLine(Status(mode="policy", note=self.policy.name))
        keymap = keymap_of(self.app)
        yield Static(self._summary(), id="summary", markup=False)
        yield Static(with_keys(text.NOW_PLAY, keymap), id="what-now", markup=False)
        yield panel(PolicyTable())
        yield panel(LogView(id="effects", follow=False), "What follows")
        yield key_line(
            "begin:play", "why", "filter", "compare", "another", "panel:next panel",
            ("up down", "choose"), "back", "help",
        )  # fmt: skip

    def on_mount(self) -> None:
        """Fill the table and the effects."""
        activity = self._workspace.activity
        table = self.query_one(PolicyTable)
        table.show(policy_rows(activity, self.policy))
        table.focus()
        effects = self.query_one(LogView)
        for behaviour in activity.behaviours:
            words = activity.behaviour_words(behaviour)
            variables = self._effects.values.get(behaviour)
            if variables is None:
                effects.write(f"{words}: never demonstrated", "warn")
            else:
                effects.write(f"{words}: {effects_words(variables)}")

    def action_why(self) -> None:
        """Explain the chosen row (by default the first)."""
        self._explain(self.query_one(PolicyTable).chosen or 0)

    def on_policy_table_chosen(self, event: PolicyTable.Chosen) -> None:
        """Explain the row chosen with Enter."""
        event.stop()
        self._explain(event.index)

    def _explain(self, index: int) -> None:
        situation = self._workspace.activity.situations[index]
        self.app.push_screen(why_row(self._workspace, self.policy, situation))

    def action_play(self) -> None:
        """Let Tangy run a game with this policy, after confirmation."""
        self.run_worker(self._play(), name="play")

    async def _play(self) -> None:
        app: Any = self.app
        dialog = ConfirmDialog(text.PLAY_NOW, text.PLAY_DETAIL, yes="play", no="not now")
        if await app.push_screen_wait(dialog):
            await app.action_play(self.policy.digest)

    def action_compare(self) -> None:
        """Compare this policy with another, or with a teacher's demonstrations."""
        app: Any = self.app
        app.run_worker(app.compare(f"policy:{self.policy.digest}"))

    def action_leave(self) -> None:
        """Close the screen."""
        self.leave(None)

    def _summary(self) -> str:
        policy, activity = self.policy, self._workspace.activity
        decisions = [policy.decide(s) for s in activity.situations]
        shown = sum(1 for decision in decisions if decision.seen)
        contested = sum(1 for decision in decisions if decision.contested)
        unsure = sum(1 for d in decisions if d.seen and not d.sure and not d.contested)
        said = f"Learnt from {counted(len(policy.demonstrations), 'demonstration')}: "
        said += f"{shown} of {len(decisions)} situations were shown"
        said += f", {contested} contested" if contested else ""
        return said + (f", {unsure} not sure." if unsure else ".")
