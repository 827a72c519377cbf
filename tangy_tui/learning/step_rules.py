"""Rules that a teacher adds to a step: the behaviour is the same whatever the value of some facts.

A rule covers the situations of the same stage that differ from the step's only in those facts and
that were not shown yet. It is logged as resolutions of those situations, so the library, the policy
and later contradicting demonstrations handle it like any resolution.
"""

from __future__ import annotations

from tangy_profiles.activity import Activity
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.situations import seen_facts
from tangy_profiles.demonstration import Demonstration, Resolution, Step
from tangy_profiles.state import Situation
from tangy_profiles.store import Store
from tangy_tui.learning.conflicts import shown_steps
from tangy_tui.learning.editing import Editor
from tangy_tui.learning.library import read_library
from tangy_tui.learning.teaching_events import (
    NoRule,
    RuleChoice,
    Ruled,
    RuleUndone,
    SameWhatever,
)


class StepRules:
    """The rules added in one teaching session."""

    def __init__(self, activity: Activity, store: Store) -> None:
        """Use an activity, and the log that stores the rules."""
        self._activity, self._store = activity, store
        self._noted: list[tuple[str, Ruled, int]] = []

    @property
    def possible(self) -> bool:
        """Whether steps can get rules: only in activities declared by facts."""
        return isinstance(self._activity, DeclaredActivity)

    def choices(self, shown: Demonstration) -> tuple[RuleChoice, ...] | NoRule:
        """Return the rules that the last step of a demonstration can get, widest first."""
        last = self._last_step(shown)
        if isinstance(last, NoRule):
            return last
        activity, step, facts = last
        offered = [facts] if len(facts) == 1 else [facts, *((one,) for one in facts)]
        covers = [(one, len(self._covered(activity, step, one))) for one in offered]
        found = tuple(RuleChoice(one, number) for one, number in covers if number)
        return found or NoRule("all shown")

    def would(self, shown: Demonstration, command: SameWhatever) -> Ruled | NoRule:
        """Return the rule that the last step of a demonstration would get, or why it cannot."""
        last = self._last_step(shown)
        if isinstance(last, NoRule):
            return last
        activity, step, facts = last
        whatever = command.facts or facts
        for fact in whatever:
            if fact not in facts:
                return NoRule("not gone by", fact, facts)
        covers = self._covered(activity, step, whatever)
        if not covers:
            return NoRule("all shown")
        return Ruled(len(shown.steps), step, whatever, tuple(covers))

    def note(self, shown: Demonstration, command: SameWhatever) -> Ruled | NoRule:
        """Add a rule to the last step of a demonstration, or return why that is not possible."""
        ruled = self.would(shown, command)
        if isinstance(ruled, NoRule):
            return ruled
        editor = Editor(self._store, self._activity)
        with self._store.transaction():
            for situation in ruled.covers:
                said = Resolution(situation, (ruled.step.behaviour,), frozenset(), ruled.facts)
                editor.settle(said)
        self._noted.append((shown.id, ruled, len(ruled.covers)))
        return ruled

    def take_back(self, shown: Demonstration) -> RuleUndone | None:
        """Undo the rule of the last step, if one was added in this session."""
        if not self._noted:
            return None
        demonstration, ruled, edits = self._noted[-1]
        if (demonstration, ruled.number) != (shown.id, len(shown.steps)):
            return None
        editor = Editor(self._store, self._activity)
        with self._store.transaction():
            for _ in range(edits):
                editor.undo()
        self._noted.pop()
        return RuleUndone(ruled)

    def _last_step(
        self, shown: Demonstration
    ) -> tuple[DeclaredActivity, Step, tuple[str, ...]] | NoRule:
        """Return the activity, the last step, and the facts that its stage sees."""
        if not shown.steps:
            return NoRule("no step")
        step, activity = shown.steps[-1], self._activity
        if not isinstance(activity, DeclaredActivity):
            return NoRule("no facts")
        facts = tuple(seen_facts(step.state.situation))
        return (activity, step, facts) if facts else NoRule("no facts")

    def _covered(
        self, activity: DeclaredActivity, step: Step, whatever: tuple[str, ...]
    ) -> list[Situation]:
        library = read_library(self._store, activity.name)
        met = {one.step.state.situation for one in shown_steps(library.demonstrations)}
        own = step.state.situation
        kept = {f: v for f, v in seen_facts(own).items() if f not in whatever}

        def differs_so(one: Situation) -> bool:
            facts = seen_facts(one)
            same = all(facts.get(fact) == value for fact, value in kept.items())
            return one.stage == own.stage and one != own and same and one not in met

        return [one for one in activity.situations if differs_so(one)]
