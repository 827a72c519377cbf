"""Persuasion (III-B-2): choose each person's strategy by their posteriors.

The paper's method is Thompson sampling over Beta posteriors; `methods` has others.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from random import Random

from tangy_profiles.beliefs import Beliefs, Beta
from tangy_profiles.state import Response
from tangy_tui.interaction.memory import (
    PersonModel,
    PersonModels,
    Responses,
    counted,
    days,
    unknown,
)
from tangy_tui.interaction.methods import Method


@dataclass(frozen=True, slots=True)
class StrategyChoice:
    """A strategy chosen for a person, and the reasons.

    `draws` is the score of every usable strategy (for the paper's method: the sample), `beliefs`
    the beliefs at that moment, `method` the method's name.
    """

    person: str
    strategy: str
    draws: Mapping[str, float]
    beliefs: Mapping[str, Beta] = field(default_factory=dict)
    method: str = ""


class Persuasion:
    """The posteriors of all participants, the choice of a strategy, and the update."""

    def __init__(
        self,
        people: Iterable[str],
        strategies: Sequence[str],
        rng: Random,
        *,
        counts: Responses | None = None,
        method: Method | None = None,
        memory: PersonModels | None = None,
        notices_drift: bool | None = None,
    ) -> None:
        """Start with the known responses.

        Args:
            people: the ids of the participants.
            strategies: the strategies to choose from.
            rng: the random generator.
            counts: (person, strategy) -> how often they complied, and did not.
            method: the method if there is no memory (default: the paper's).
            memory: reads each person's model, with the method chosen for them, from the log.
            notices_drift: forget responses before a detected change (default: if there is a
                memory).
        """
        self._memory = memory
        self._notices_drift = memory is not None if notices_drift is None else notices_drift
        self._rng = rng
        self._known: dict[str, PersonModel] = {}
        self._touched: dict[str, datetime] = {}
        self.beliefs: dict[str, Beliefs] = {}
        for person in people:
            if memory is not None:
                self.recall(person, counts)
                continue
            self._known[person] = start = unknown(strategies, method)
            self.beliefs[person] = counted(start.prior, person, counts or {})

    def recall(self, person: str, counts: Responses | None = None) -> Beliefs:
        """Read a person's model again, after a void, a late response or a switch."""
        if self._memory is not None:
            known = self._memory.recall(person, counts)
            self._known[person] = known
            self._touched[person] = self._memory.now()
            self.beliefs[person] = known.beliefs
        return self.beliefs[person]

    def choose(
        self, person: str, without: Collection[str] = (), *, again: str | None = None
    ) -> StrategyChoice:
        """Choose a strategy for a person, among those that are switched on.

        Args:
            person: the id of the person.
            without: strategies that are unsuitable now, even if switched on.
            again: the strategy that was just used for the same behaviour; another one is chosen if
                possible.
        """
        known = self._known[person]
        self._fade(person, known)
        beliefs = self.beliefs[person]
        usable = beliefs
        if known.off or without:  # perhaps none of the activity's strategies is left
            fitting = {s: b for s, b in beliefs.items() if s not in without} or beliefs
            usable = {s: b for s, b in fitting.items() if s not in known.off} or fitting
        if again in usable and len(usable) > 1:
            usable = {s: b for s, b in usable.items() if s != again}
        draws = known.method.scores(usable, self._rng)
        return StrategyChoice(person, self._highest(draws), draws, beliefs, known.method.words)

    def update(self, response: Response) -> Beta:
        """Update the beliefs by a response (Eq. 2); return the belief of its strategy."""
        person, strategy = response.person, response.strategy
        known = self._known[person]
        self._fade(person, known)
        beliefs = known.method.updated(
            self.beliefs[person], known.prior, strategy, response.complied
        )
        notices = self._notices_drift and not known.method.forgets
        if notices and known.watch.add(strategy, response.complied) is not None:
            beliefs = known.watch.forgotten(beliefs, known.prior)
        self.beliefs[person] = beliefs
        return beliefs[strategy]

    def _highest(self, draws: Mapping[str, float]) -> str:
        """Return the strategy with the highest score; break ties at random."""
        top = max(draws.values())
        best = [strategy for strategy, draw in draws.items() if draw == top]
        return best[0] if len(best) == 1 else self._rng.choice(best)

    def _fade(self, person: str, known: PersonModel) -> None:
        """Let beliefs decay by the time since the last update."""
        if self._memory is None or not known.method.forgets:
            return
        now = self._memory.now()
        passed = days(self._touched[person], now)
        self.beliefs[person] = known.method.faded(self.beliefs[person], known.prior, passed)
        self._touched[person] = now
