"""Persuasion (III-B-2): Thompson sampling over each person's Beta posteriors picks the strategy."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from random import Random
from typing import Protocol

from tangy_profiles.beliefs import Beliefs, Beta, uniform_beliefs
from tangy_profiles.state import Response


@dataclass(frozen=True, slots=True)
class Choice:
    """A strategy chosen for a person, with the number that was drawn for each of them."""

    person: str
    strategy: str
    draws: Mapping[str, float]


class Chooser(Protocol):
    """A way to choose a strategy from what is believed of a person."""

    def choose(self, beliefs: Mapping[str, Beta], rng: Random) -> Mapping[str, float]:
        """Return a score for each strategy; the highest is used."""
        ...


class ThompsonSampling:
    """Draw from every belief and use the strategy with the highest draw, as the paper does."""

    def choose(self, beliefs: Mapping[str, Beta], rng: Random) -> Mapping[str, float]:
        """Return one draw for each strategy."""
        return {strategy: belief.sample(rng) for strategy, belief in beliefs.items()}


class Persuasion:
    """What is believed of everybody present, how a strategy is chosen, and how beliefs grow."""

    def __init__(
        self,
        people: Iterable[str],
        strategies: Sequence[str],
        rng: Random,
        *,
        counts: Mapping[tuple[str, str], tuple[int, int]] | None = None,
        chooser: Chooser | None = None,
    ) -> None:
        """Begin with Beta(1, 1) plus the responses that are known already.

        Args:
            counts: (person, strategy) -> how often they complied, and did not.
        """
        self.beliefs: dict[str, Beliefs] = {p: uniform_beliefs(strategies) for p in people}
        for (person, strategy), (complied, refused) in (counts or {}).items():
            if person in self.beliefs and strategy in self.beliefs[person]:
                self.beliefs[person][strategy] = Beta(1 + complied, 1 + refused)
        self._rng = rng
        self._chooser = chooser or ThompsonSampling()

    def choose(self, person: str) -> Choice:
        """Choose the strategy to persuade a person with."""
        draws = self._chooser.choose(self.beliefs[person], self._rng)
        return Choice(person, max(draws, key=draws.__getitem__), draws)

    def update(self, response: Response) -> Beta:
        """Learn from a response (Eq. 2); return the new belief in the strategy that was used."""
        profile = self.beliefs[response.person]
        profile[response.strategy] = profile[response.strategy].updated(response.complied)
        return profile[response.strategy]
