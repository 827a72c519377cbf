"""Beliefs about a person's compliance: a Beta posterior for each strategy (Eq. 1, 2)."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

GRID = 400
"""Intervals of the midpoint rule on [0, 1] that integrates P(best)."""


SETTLED = 0.9
"""The P(best) from which a person's best strategy is considered known."""

SURE = 0.9
"""The probability of the displayed credible interval."""


@dataclass(frozen=True, slots=True)
class Beta:
    """A Beta(alpha, beta) belief about the probability that a person complies with a strategy.

    `counts` are the responses behind it, (complied, did not), if alpha and beta differ from these
    because of a prior from earlier people or of forgetting. None if they are alpha - 1 and beta -
    1, as in the paper.
    """

    alpha: float = 1.0
    beta: float = 1.0
    counts: tuple[int, int] | None = None

    @property
    def mean(self) -> float:
        """The expected probability of compliance."""
        return self.alpha / (self.alpha + self.beta)

    @property
    def complied(self) -> int:
        """The number of responses that were compliance."""
        return round(self.alpha - 1) if self.counts is None else self.counts[0]

    @property
    def trials(self) -> int:
        """The number of responses, without those of the prior."""
        return round(self.alpha + self.beta - 2) if self.counts is None else sum(self.counts)

    def updated(self, complied: bool) -> Beta:
        """Return the belief after one more response (Eq. 2)."""
        a, b = (1, 0) if complied else (0, 1)
        if self.counts is None:
            return Beta(self.alpha + a, self.beta + b)
        yes, no = self.counts
        return Beta(self.alpha + a, self.beta + b, (yes + a, no + b))

    def quantile(self, share: float) -> float:
        """Return the quantile of the belief at the probability `share`."""
        from scipy.special import betaincinv

        return float(betaincinv(self.alpha, self.beta, share))

    def interval(self, sure: float = SURE) -> tuple[float, float]:
        """Return the equal-tailed credible interval with probability `sure`."""
        return self.quantile((1 - sure) / 2), self.quantile((1 + sure) / 2)

    def density(self, points: int) -> list[float]:
        """Return the probability density of Eq. 1 at the midpoints of `points` parts of [0, 1]."""
        a, b = self.alpha, self.beta
        scale = math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b)
        mids = ((i + 0.5) / points for i in range(points))
        return [math.exp(scale + (a - 1) * math.log(x) + (b - 1) * math.log(1 - x)) for x in mids]


UNIFORM = Beta()

Beliefs = dict[str, Beta]
"""One person's persuasive strategy profile M: strategy -> belief."""


def uniform_beliefs(strategies: Iterable[str]) -> Beliefs:
    """Return the profile M of an unknown person: Beta(1, 1) for every strategy."""
    return dict.fromkeys(strategies, UNIFORM)


def probability_best(beliefs: Mapping[str, Beta]) -> dict[str, float]:
    """Return, for each strategy, the probability that the person complies with it most.

    P(best = i) is the integral of f_i(x) times the product of the other strategies' F_j(x).
    """
    mass: dict[str, list[float]] = {}
    cumulative: dict[str, list[float]] = {}
    for strategy, belief in beliefs.items():
        density = belief.density(GRID)
        total = sum(density)
        mass[strategy] = [value / total for value in density]
        running = 0.0
        cumulative[strategy] = []
        for share in mass[strategy]:
            cumulative[strategy].append(running + share / 2)
            running += share
    raw = {
        one: sum(
            mass[one][i] * math.prod(cumulative[other][i] for other in beliefs if other != one)
            for i in range(GRID)
        )
        for one in beliefs
    }
    whole = sum(raw.values())
    return {strategy: value / whole for strategy, value in raw.items()}


def leading(best: Mapping[str, float]) -> str | None:
    """Return the strategy with the highest probability of being best; None if tied."""
    top = max(best.values(), default=0.0)
    leaders = [strategy for strategy, share in best.items() if share > top - 1e-9]
    return leaders[0] if len(leaders) == 1 else None


def settled(best: Mapping[str, float]) -> str | None:
    """Return the strategy with a P(best) of at least SETTLED, or None."""
    first = leading(best)
    return first if first is not None and best[first] >= SETTLED else None
