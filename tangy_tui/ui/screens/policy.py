"""The policy screen: what Tangy would do in every situation, and how sure it is."""

from __future__ import annotations

from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import Static

from tangy_profiles.activity import Activity
from tangy_tui.house import House
from tangy_tui.learning.effects import Effects
from tangy_tui.learning.policy import Decision, Policy
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.panels import key_line, panel
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.policy_table import PolicyRow, PolicyTable
from tangy_tui.ui.widgets.status_line import Status, StatusLine


def policy_rows(activity: Activity, policy: Policy) -> list[PolicyRow]:
    """Return a row for every situation that can come about, in the order of a game."""
    return [
        _row(activity.in_words(situation), policy.decide(situation))
        for situation in activity.situations
    ]


def _row(words: str, decision: Decision) -> PolicyRow:
    """Write what is done in a situation; where Tangy would ask, the words say why."""
    if not decision.seen:  # whatever the trees would vote for, Tangy asks there
        return PolicyRow(words, "never shown", 0.0, 0)
    if decision.contested:
        answers = " or ".join(behaviour for behaviour, _ in decision.votes)
        return PolicyRow(words, "contested", decision.share, decision.seen, answers)
    note = "" if decision.sure else "not sure: asks"
    return PolicyRow(words, decision.behaviour, decision.share, decision.seen, note)


class PolicyScreen(TangyScreen[None]):
    """The policy table with vote shares, and the learnt effects."""

    CSS_PATH = "policy.tcss"
    HELP = (
        "One row for each situation that can come about: what Tangy does, which share of the "
        "trees voted for it, and how often it was demonstrated. Below: what was seen to follow "
        "each behaviour. A situation that was never shown needs another demonstration."
    )
    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape,enter", "leave", "Back")]

    def __init__(
        self, house: House, policy: Policy, effects: Effects, leave_after: float | None = None
    ) -> None:
        """Make the screen; `leave_after` so many seconds it closes by itself."""
        super().__init__()
        self._house = house
        self._policy = policy
        self._effects = effects
        self._leave_after = leave_after

    def compose(self) -> ComposeResult:
        """Lay out the table and the effects."""
        yield StatusLine(Status(mode="policy", note=self._policy.name))
        yield Static(self._summary(), id="summary", markup=False)
        yield panel(PolicyTable())
        yield panel(LogView(id="effects"), "What follows")
        yield key_line(("tab", "next panel"), ("up down", "scroll"), ("esc", "back"), ("?", "help"))

    def on_mount(self) -> None:
        """Fill both."""
        activity = self._house.activity
        table = self.query_one(PolicyTable)
        table.show(policy_rows(activity, self._policy))
        table.focus()
        effects = self.query_one(LogView)
        for behaviour in activity.behaviours:
            variables = self._effects.values.get(behaviour)
            if variables is None:
                effects.write(f"{behaviour}: never demonstrated", "warn")
            else:
                told = (f"{v} {' or '.join(sorted(seen))}" for v, seen in variables.items())
                effects.write(f"{behaviour}: {'; '.join(told)}")
        if self._leave_after is not None:
            self.set_timer(self._leave_after, self.action_leave)

    def action_leave(self) -> None:
        """Go back."""
        self.dismiss(None)

    def _summary(self) -> str:
        policy, activity = self._policy, self._house.activity
        shown = sum(1 for s in activity.situations if policy.decide(s).seen)
        count = len(policy.demonstrations)
        plural = "" if count == 1 else "s"
        return (
            f"Learnt from {count} demonstration{plural}: {shown} of {len(activity.situations)} "
            f"situations were shown."
        )
