"""Persuasion (III-B-2): choose each person's strategy by their posteriors.

The paper's method is Thompson sampling over Beta posteriors; `methods` has the others.
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
    """A strategy chosen for a person, and why.

    `draws` is the score of every strategy that could be used (for the paper's method: the number
    drawn from its belief), `beliefs` what was believed at that moment, `method` its name.
    """

    person: str
    strategy: str
    draws: Mapping[str, float]
    beliefs: Mapping[str, Beta] = field(default_factory=dict)
    method: str = ""


class Persuasion:
    """The posteriors of everybody present, the choice of a strategy, and the update."""

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
        """Begin with what is known already.

        Args:
            people: the ids of those who take part.
            strategies: what can be chosen.
            rng: the random generator.
            counts: (person, strategy) -> how often they complied, and did not.
            method: how to choose and to learn where there is no memory (default: as the paper).
            memory: recalls each person from the log, with the method that was chosen for them.
            notices_drift: whether what came before a change of what works with somebody is
                forgotten; by default where there is a memory.
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

    def known(self, person: str) -> PersonModel:
        """Return the method, prior and switches of a person as they were recalled last."""
        return self._known[person]

    def recall(self, person: str, counts: Responses | None = None) -> Beliefs:
        """Read again what the log says of a person, after a void, a late response or a switch."""
        if self._memory is not None:
            known = self._memory.recall(person, counts)
            self._known[person] = known
            self._touched[person] = self._memory.now()
            self.beliefs[person] = known.beliefs
        return self.beliefs[person]

    def choose(
        self, person: str, without: Collection[str] = (), *, again: str | None = None
    ) -> StrategyChoice:
        """Choose the strategy to persuade a person with, among those that are switched on.

        Args:
            person: who is to be persuaded.
            without: strategies that are out of place now, whatever is switched on.
            again: the strategy by which the very same was said last: another is taken, if any.
        """
        known = self._known[person]
        self._fade(person, known)
        beliefs = self.beliefs[person]
        usable = beliefs
        if known.off or without:  # an activity may share no strategy with those that are left on
            fitting = {s: b for s, b in beliefs.items() if s not in without} or beliefs
            usable = {s: b for s, b in fitting.items() if s not in known.off} or fitting
        if again in usable and len(usable) > 1:
            usable = {s: b for s, b in usable.items() if s != again}
        draws = known.method.scores(usable, self._rng)
        return StrategyChoice(person, self._highest(draws), draws, beliefs, known.method.words)

    def update(self, response: Response) -> Beta:
        """Learn from a response (Eq. 2); return the new belief in the strategy that was used."""
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
        """Return the strategy with the highest score; of several, one by chance."""
        top = max(draws.values())
        best = [strategy for strategy, draw in draws.items() if draw == top]
        return best[0] if len(best) == 1 else self._rng.choice(best)

    def _fade(self, person: str, known: PersonModel) -> None:
        """Let the time since a person was last thought of do what it does to their beliefs."""
        if self._memory is None or not known.method.forgets:
            return
        now = self._memory.now()
        passed = days(self._touched[person], now)
        self.beliefs[person] = known.method.faded(self.beliefs[person], known.prior, passed)
        self._touched[person] = now
