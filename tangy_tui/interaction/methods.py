"""Methods to choose a strategy and to update beliefs, one small class each.

`Thompson` is the paper's method (III-B-2). `BayesUcb` scores differently, `EarlierPeople` has
another prior, and `Forgetting` discounts old responses. The last two wrap any method, so they
combine: `Forgetting(EarlierPeople(BayesUcb(), ...), 0.98)`. Beliefs are never changed in place.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from random import Random
from typing import Protocol, assert_never, cast

from tangy_profiles.beliefs import Beliefs, Beta, uniform_beliefs
from tangy_profiles.errors import ProfileError
from tangy_profiles.extensions import Extension, extensions
from tangy_profiles.persuading import PERSUASION_METHODS, PersuasionConfig
from tangy_profiles.reading import plain

Counts = Mapping[str, tuple[int, int]]
"""One person's responses: strategy -> how often they complied, and did not."""

MAX_PRIOR_WEIGHT = 4
"""The most weight of earlier people's prior, in responses per strategy.

A wrong prior of this weight costs 7 of 23 choices; one without a limit is never corrected.
"""

GRID_STEPS = 4
"""The prior is fitted in steps of a quarter response."""


class Method(Protocol):
    """Chooses a strategy for a person, and updates the beliefs about the person."""

    @property
    def words(self) -> str:
        """The name of the method for people."""
        ...

    @property
    def forgets(self) -> bool:
        """Whether the order and age of responses matter, not only their counts."""
        ...

    def prior(self, strategies: Iterable[str]) -> Beliefs:
        """Return the prior of a person."""
        ...

    def faded(self, beliefs: Beliefs, prior: Beliefs, days: float) -> Beliefs:
        """Return the beliefs after some days without a response."""
        ...

    def updated(self, beliefs: Beliefs, prior: Beliefs, strategy: str, complied: bool) -> Beliefs:
        """Return the beliefs after one more response to a strategy."""
        ...

    def scores(self, beliefs: Mapping[str, Beta], rng: Random) -> dict[str, float]:
        """Return a score for each strategy; the highest is used."""
        ...


METHOD_PARTS = ("words", "forgets", "prior", "faded", "updated", "scores")
"""The attributes of a method; `BetaBernoulliMethod` has all except `words` and `scores`."""


class BetaBernoulliMethod:
    """The paper's prior and update: Beta(1, 1), and Eq. 2 for each response."""

    forgets = False

    def prior(self, strategies: Iterable[str]) -> Beliefs:
        """Return Beta(1, 1) for every strategy (Eq. 1)."""
        return uniform_beliefs(strategies)

    def faded(self, beliefs: Beliefs, prior: Beliefs, days: float) -> Beliefs:
        """Return the beliefs unchanged, after any number of days."""
        return beliefs

    def updated(self, beliefs: Beliefs, prior: Beliefs, strategy: str, complied: bool) -> Beliefs:
        """Increment alpha or beta of the strategy (Eq. 2)."""
        return {**beliefs, strategy: beliefs[strategy].updated(complied)}


class Thompson(BetaBernoulliMethod):
    """Thompson sampling: sample every belief, use the strategy with the highest sample."""

    words = "Thompson sampling"

    def scores(self, beliefs: Mapping[str, Beta], rng: Random) -> dict[str, float]:
        """Return one sample per strategy, a probability."""
        draw = rng.betavariate
        return {strategy: draw(b.alpha, b.beta) for strategy, b in beliefs.items()}


class BayesUcb(BetaBernoulliMethod):
    """Use the strategy whose belief has the highest upper quantile.

    The quantile is 1 - 1/(t + 1) before the t-th response (Kaufmann, Cappe, Garivier 2012, with c =
    0). It is deterministic; the caller breaks ties.
    """

    words = "Bayes-UCB"

    def scores(self, beliefs: Mapping[str, Beta], rng: Random) -> dict[str, float]:
        """Return the upper quantile of each belief."""
        share = 1 - 1 / (2 + sum(belief.trials for belief in beliefs.values()))
        return {strategy: belief.quantile(share) for strategy, belief in beliefs.items()}


@dataclass(frozen=True)
class EarlierPeople:
    """Use a prior fitted to earlier people (empirical Bayes); otherwise like `inner`.

    `people` are the counts of everybody else. Without any, the prior is that of `inner`.
    """

    inner: Method
    people: Sequence[Counts]
    fitted: dict[str, Beta] = field(default_factory=dict, compare=False, repr=False)

    @property
    def words(self) -> str:
        """The name of the inner method, with the kind of prior."""
        return f"{self.inner.words} from earlier people"

    @property
    def forgets(self) -> bool:
        """Whether the inner method forgets."""
        return self.inner.forgets

    def prior(self, strategies: Iterable[str]) -> Beliefs:
        """Return a Beta for each strategy, fitted to the counts of people who met it."""
        prior = self.inner.prior(strategies)
        for strategy in prior:
            if strategy not in self.fitted:
                counts = (p[strategy] for p in self.people if strategy in p)
                self.fitted[strategy] = fit_beta_prior([c for c in counts if sum(c)])
            if self.fitted[strategy].counts is not None:
                prior[strategy] = self.fitted[strategy]
        return prior

    def faded(self, beliefs: Beliefs, prior: Beliefs, days: float) -> Beliefs:
        """As the inner method does."""
        return self.inner.faded(beliefs, prior, days)

    def updated(self, beliefs: Beliefs, prior: Beliefs, strategy: str, complied: bool) -> Beliefs:
        """As the inner method does."""
        return self.inner.updated(beliefs, prior, strategy, complied)

    def scores(self, beliefs: Mapping[str, Beta], rng: Random) -> dict[str, float]:
        """As the inner method does."""
        return self.inner.scores(beliefs, rng)


@dataclass(frozen=True)
class Forgetting:
    """Decay the posterior towards the prior, because people change; otherwise like `inner`.

    Args:
        keep: the share in (0, 1] of the evidence that is left after one interaction with the person
            (by any strategy), or after one day.
    """

    inner: Method
    keep: float
    daily: bool = False
    forgets = True

    @property
    def words(self) -> str:
        """The name of the inner method, with the rate of forgetting."""
        every = "a day" if self.daily else "an interaction"
        return f"{self.inner.words}, forgetting {100 * (1 - self.keep):.3g}% {every}"

    def prior(self, strategies: Iterable[str]) -> Beliefs:
        """As the inner method does."""
        return self.inner.prior(strategies)

    def faded(self, beliefs: Beliefs, prior: Beliefs, days: float) -> Beliefs:
        """Decay the beliefs by the days that passed."""
        beliefs = self.inner.faded(beliefs, prior, days)
        return _towards(prior, beliefs, self.keep**days) if self.daily and days > 0 else beliefs

    def updated(self, beliefs: Beliefs, prior: Beliefs, strategy: str, complied: bool) -> Beliefs:
        """Decay the beliefs about all strategies, then add the response."""
        if not self.daily:
            beliefs = _towards(prior, beliefs, self.keep)
        return self.inner.updated(beliefs, prior, strategy, complied)

    def scores(self, beliefs: Mapping[str, Beta], rng: Random) -> dict[str, float]:
        """As the inner method does."""
        return self.inner.scores(beliefs, rng)


def _plain(name: str) -> Method:
    own = next((method for method in PERSUASION_METHODS if method == name), None)
    if own is None:
        return added_method(extensions("methods")[name])
    match own:
        case "thompson":
            return Thompson()
        case "bayes-ucb":
            return BayesUcb()
        case forgotten:
            assert_never(forgotten)


def added_method(extension: Extension) -> Method:
    """Make the method of another package: call its entry point without arguments.

    Raises:
        ProfileError: it cannot be loaded, or lacks attributes of a `Method`.
    """
    made = extension.load()
    try:
        method = made()
    except Exception as error:
        raise ProfileError(plain(f"{extension}: {extension.value}() fails: {error}")) from None
    lacks = [name for name in METHOD_PARTS if not hasattr(method, name)]
    if lacks:
        raise ProfileError(plain(f"{extension}: {extension.value} has no {', '.join(lacks)}."))
    return cast(Method, method)


def method_of(chosen: PersuasionConfig, earlier: Sequence[Counts] = ()) -> Method:
    """Make the configured method; `earlier` are the counts of everybody else."""
    method = _plain(chosen.method)
    if chosen.prior == "people":
        method = EarlierPeople(method, earlier)
    if chosen.forgetting < 1:
        method = Forgetting(method, chosen.forgetting, chosen.forgetting_per == "day")
    return method


def others(counts: Mapping[tuple[str, str], tuple[int, int]], person: str) -> list[Counts]:
    """Group the counts of everybody but one person, from `Store.responses()`, by person."""
    grouped: dict[str, dict[str, tuple[int, int]]] = {}
    for (somebody, strategy), pair in counts.items():
        if somebody != person:
            grouped.setdefault(somebody, {})[strategy] = pair
    return list(grouped.values())


def fit_beta_prior(counts: Sequence[tuple[int, int]]) -> Beta:
    """Fit the prior of one strategy to earlier people's counts (complied, did not).

    It is Beta(1 + u, 1 + v): the uniform prior with u + v pseudo-responses. u and v maximise the
    beta-binomial likelihood of the counts, which is not biased by asking people more often with
    what worked. u + v is at most four, and at most the number of people, because one person says
    little about the next.
    """
    most = min(MAX_PRIOR_WEIGHT, len(counts)) * GRID_STEPS
    if not most:
        return Beta()
    grid = [n / GRID_STEPS for n in range(most + 1)]
    yes = _log_rising_factorials([y for y, _ in counts], [1 + u for u in grid])
    no = _log_rising_factorials([n for _, n in counts], [1 + v for v in grid])
    both = _log_rising_factorials([y + n for y, n in counts], [2 + w for w in grid])
    u, v = max(
        ((u, v) for u in range(most + 1) for v in range(most + 1 - u)),
        key=lambda pair: yes[pair[0]] + no[pair[1]] - both[pair[0] + pair[1]],
    )
    return Beta(1 + grid[u], 1 + grid[v], (0, 0))


def _log_rising_factorials(times: Sequence[int], starts: Sequence[float]) -> list[float]:
    """Return, for each start a, the log of the product over n in `times` of a (a+1) ... (a+n-1)."""
    return [sum(math.lgamma(a + n) for n in times) - len(times) * math.lgamma(a) for a in starts]


def _towards(prior: Beliefs, beliefs: Beliefs, keep: float) -> Beliefs:
    """Move beliefs towards the prior, keeping a share of the difference; the counts stay."""
    return {
        strategy: Beta(
            start.alpha + keep * (belief.alpha - start.alpha),
            start.beta + keep * (belief.beta - start.beta),
            (belief.complied, belief.trials - belief.complied),
        )
        for strategy, belief in beliefs.items()
        for start in (prior[strategy],)
    }
