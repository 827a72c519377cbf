"""Contradictions, reported during teaching: a different behaviour in the same situation.

The list of conflicts reports them only later, when the teacher who knows the answer may have left.
"""

from __future__ import annotations

from collections.abc import Iterable

from tangy_profiles.demonstration import Demonstration
from tangy_profiles.state import Situation
from tangy_tui.learning.conflicts import DemonstratedStep, Resolution, joined, shown_steps


class Contradictions:
    """Earlier answers by situation; reports each contradiction once."""

    def __init__(
        self,
        earlier: Iterable[Demonstration],
        resolutions: Iterable[Resolution] = (),
        *,
        teacher: str = "",
    ) -> None:
        """Index earlier demonstrations and the resolutions of their conflicts.

        Contradictions that `teacher` has been told about already are not reported again.
        """
        self._settled = joined(resolutions)
        self._shown: dict[Situation, dict[str, list[DemonstratedStep]]] = {}
        self._told: set[tuple[Situation, frozenset[str]]] = set()
        for shown in sorted(shown_steps(earlier), key=lambda shown: shown.step.id):
            if shown.teacher == teacher:
                self.found(shown)
            else:
                self._add(shown)

    def found(self, now: DemonstratedStep) -> DemonstratedStep | None:
        """Add a step and return the latest step that contradicts it, if that is new.

        Return None if no other behaviour was shown, if a teacher called this answer right, or if
        this pair of answers was reported before.
        """
        situation, behaviour = now.step.state.situation, now.step.behaviour
        self._add(now)
        if self.called_right(situation, behaviour):
            return None
        others = [
            steps[-1]
            for other, steps in self._shown.get(situation, {}).items()
            if other != behaviour and steps
        ]
        if not others:
            return None
        other = others[-1]
        pair = (situation, frozenset((behaviour, other.step.behaviour)))
        if pair in self._told:
            return None
        self._told.add(pair)
        return other

    def usual(self, situation: Situation) -> tuple[str, ...]:
        """Return the behaviours shown in a situation, most frequent first."""
        answers = self._shown.get(situation, {})
        shown = [behaviour for behaviour, steps in answers.items() if steps]
        return tuple(sorted(shown, key=lambda behaviour: -len(answers[behaviour])))

    def called_right(self, situation: Situation, behaviour: str) -> bool:
        """Return whether a teacher has called a behaviour right in a situation."""
        said = self._settled.get(situation)
        return said is not None and behaviour in said.right

    def resolved(self, situation: Situation, right: tuple[str, ...], *, keep: bool) -> Resolution:
        """Return the resolution that makes these answers right.

        Args:
            situation: the situation.
            right: the right answers.
            keep: keep earlier right answers too, and set no step aside.
        """
        if keep:
            before = self._settled.get(situation)
            known = () if before is None else before.right
            return Resolution(situation, tuple(dict.fromkeys((*known, *right))), frozenset())
        answers = self._shown.get(situation, {})
        wrong = (s.step.id for b, steps in answers.items() if b not in right for s in steps)
        return Resolution(situation, right, frozenset(wrong))

    def take_back(self, demonstration: str, number: int) -> None:
        """Remove a step that was undone; its contradictions may be reported again."""
        for situation, answers in self._shown.items():
            for behaviour, steps in answers.items():
                kept = [s for s in steps if (s.demonstration, s.number) != (demonstration, number)]
                if len(kept) < len(steps):
                    answers[behaviour] = kept
                    self._told = {
                        (of, pair)
                        for of, pair in self._told
                        if of != situation or behaviour not in pair
                    }

    def _add(self, shown: DemonstratedStep) -> None:
        said = self._settled.get(shown.step.state.situation)
        if said is None or not said.sets_aside(shown.step):
            answers = self._shown.setdefault(shown.step.state.situation, {})
            answers.setdefault(shown.step.behaviour, []).append(shown)
