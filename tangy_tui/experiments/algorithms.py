"""Comparison of all methods to choose a strategy, on the same random draws and without games.

Person i at interaction t would answer strategy s the same way for every method, so methods differ
only by their choices. Regret is the expected loss of compliance: the sum, over interactions, of the
best strategy's rate minus the chosen one's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from math import log
from random import Random
from typing import Any

from tangy_profiles.errors import ProfileError
from tangy_profiles.extensions import extensions
from tangy_profiles.persuading import PersuasionConfig, known_methods
from tangy_sim.worlds.users import load_users
from tangy_tui.experiments.estimates import summary
from tangy_tui.experiments.sweep import Case, Settings, Sweep, Where
from tangy_tui.interaction.methods import Counts, Method, Thompson, method_of

HORIZONS = (23, 60, 300)
"""Interactions after which regret is reported; 20 games of the paper have 23."""

KEEP = 0.98
"""The share of evidence that the forgetting methods keep per interaction."""

EARLIER = 40
"""People met before, for the methods with an empirical prior."""

MET = 23
"""Interactions with each of them."""

CHANGE = 100
"""The interaction after which everybody's preference changes, in the drifting crowd."""

A_PIECE = 100
"""People in one piece of work."""

Rates = tuple[float, ...]
"""One person's probability of complying with each strategy."""

PUBLISHED_COMPARISON: Mapping[str, PersuasionConfig] = {
    "thompson": PersuasionConfig(),
    "bayes_ucb": PersuasionConfig("bayes-ucb"),
    "thompson_prior": PersuasionConfig(prior="people"),
    "bayes_ucb_prior": PersuasionConfig("bayes-ucb", prior="people"),
    "thompson_forgetting": PersuasionConfig(forgetting=KEEP),
    "bayes_ucb_forgetting": PersuasionConfig("bayes-ucb", forgetting=KEEP),
}
"""The published comparison, by its names in the document; `compared` adds other methods."""


def compared() -> dict[str, PersuasionConfig]:
    """Return the published comparison, and all other known methods by their own names."""
    there = {chosen.method for chosen in PUBLISHED_COMPARISON.values()}
    others = [name for name in known_methods() if name not in there]
    return {**PUBLISHED_COMPARISON, **{name: PersuasionConfig(name) for name in others}}


@dataclass(frozen=True)
class Crowd:
    """A population of simulated people.

    `alike` is how much they have in common: 0 for preferences distributed evenly over the
    strategies, else the concentration of each strategy's rate around its mean in `means`. `drift`
    is the interaction after which preferences move on to the next strategy (0: never).
    """

    name: str
    words: str
    means: Rates = ()
    alike: float = 0.0
    drift: int = 0

    def rates(self, person: int, strategies: int, seed: int) -> Rates:
        """Return one person's rates (probabilities of complying)."""
        if not self.means:
            users = load_users()
            return tuple(
                users.preferred if place == person % strategies else users.other
                for place in range(strategies)
            )
        draw = Random(f"{seed}/{self.name}/{person}").betavariate
        means = [self.means[place % len(self.means)] for place in range(strategies)]
        return tuple(draw(self.alike * mean, self.alike * (1 - mean)) for mean in means)

    def at(self, rates: Rates, time: int) -> Rates:
        """Return a person's rates (probabilities) at an interaction (from 0)."""
        return rates[-1:] + rates[:-1] if self.drift and time >= self.drift else rates


CROWDS = {
    crowd.name: crowd
    for crowd in (
        Crowd("even", "each strategy is the best for as many people; nobody changes"),
        Crowd(
            "uneven",
            "most people like the same; rates are drawn around a mean for each strategy",
            means=(0.8, 0.6, 0.45, 0.3),
            alike=6.0,
        ),
        Crowd("drifting", "even, until everybody changes at once", drift=CHANGE),
    )
}


def meet(settings: Settings, case: Case) -> list[list[float]]:
    """Let a method interact with people: a case is (crowd, method, first person, count).

    Returns:
        For each person: the regret at each of HORIZONS, the share of optimal choices overall, and
            the share of optimal choices in the CHANGE interactions after CHANGE.
    """
    crowd, name, first, count = case
    strategies, seed = settings["strategies"], settings["seed"]
    chosen = compared()[name]
    earlier = earlier_people(crowd, strategies, seed) if chosen.prior == "people" else ()
    method = method_of(chosen, earlier)
    return [
        _met(CROWDS[crowd], method, person, Random(f"{seed}/{name}/{person}"), strategies, seed)
        for person in range(first, first + count)
    ]


def _met(
    crowd: Crowd, method: Method, person: int, rng: Random, strategies: int, seed: int
) -> list[float]:
    regret, optimal, marks = 0.0, [], []
    rates = crowd.rates(person, strategies, seed)
    best, loss = _stakes(crowd, rates)
    for time, chosen, _ in choices(crowd, method, person, rng, strategies, seed, HORIZONS[-1]):
        late = bool(crowd.drift) and time >= crowd.drift
        regret += loss[late][chosen]
        optimal.append(chosen == best[late])
        if time + 1 in HORIZONS:
            marks.append(regret)
    after = optimal[CHANGE : 2 * CHANGE]
    return [*marks, sum(optimal) / len(optimal), sum(after) / len(after)]


def _stakes(crowd: Crowd, rates: Rates) -> tuple[list[int], list[list[float]]]:
    """Return the best strategy and each strategy's loss, before and after a change."""
    both = [rates, crowd.at(rates, crowd.drift)]
    best = [max(range(len(now)), key=now.__getitem__) for now in both]
    return best, [[now[b] - rate for rate in now] for now, b in zip(both, best, strict=True)]


def choices(
    crowd: Crowd,
    method: Method,
    person: int,
    rng: Random,
    strategies: int,
    seed: int,
    times: int,
) -> list[tuple[int, int, bool]]:
    """Simulate interactions with one person; return (time, chosen strategy, complied) for each.

    Args:
        crowd: the population of the person.
        method: the method of choice.
        person: the person's number.
        rng: the method's random generator; the person's answers do not depend on it.
        strategies: the number of strategies.
        seed: seed of the random generators.
        times: the number of interactions.
    """
    names = [str(place) for place in range(strategies)]
    answers = Random(f"{seed}/answers/{person}").random
    rates = crowd.rates(person, strategies, seed)
    prior = method.prior(names)
    beliefs = prior
    met: list[tuple[int, int, bool]] = []
    for time in range(times):
        scores = method.scores(beliefs, rng)
        most = max(scores.values())
        leading = [name for name in names if scores[name] == most]
        chosen = leading[0] if len(leading) == 1 else leading[int(rng.random() * len(leading))]
        place = int(chosen)
        would = [answers() for _ in names]
        complied = would[place] < crowd.at(rates, time)[place]
        beliefs = method.updated(beliefs, prior, chosen, complied)
        met.append((time, place, complied))
    return met


@cache
def earlier_people(crowd: str, strategies: int, seed: int) -> tuple[Counts, ...]:
    """Simulate EARLIER people of a crowd with Thompson sampling, and return their counts.

    They are different from the people of the comparison.
    """
    found: list[Counts] = []
    for person in range(-EARLIER, 0):
        counts: dict[str, tuple[int, int]] = {}
        rng = Random(f"{seed}/earlier/{person}")
        met = choices(CROWDS[crowd], Thompson(), person, rng, strategies, seed, MET)
        for _, place, complied in met:
            yes, no = counts.get(str(place), (0, 0))
            counts[str(place)] = (yes + complied, no + (not complied))
        found.append(counts)
    return tuple(found)


def lai_robbins(best: float, others: Sequence[float]) -> float:
    """Return the Lai-Robbins factor of log T in the regret (in responses) of a consistent method.

    It is the sum over the other strategies of (best - p) / KL(p, best) (Lai and Robbins 1985). It
    is asymptotic, and no bound for small T.
    """

    def divergence(p: float, q: float) -> float:
        return sum(a * log(a / b) for a, b in ((p, q), (1 - p, 1 - q)) if a > 0)

    return sum((best - p) / divergence(p, best) for p in others if p < best)


def run(strategies: int, people: int, seed: int, where: Where) -> dict[str, Any]:
    """Run every method on every crowd; the even crowd in full, the others with a quarter.

    A method of another package that cannot be made is left out, and listed with its problem.
    """
    methods, problems = compared(), dict[str, str]()
    for name in tuple(methods):
        try:
            method_of(methods[name])
        except ProfileError as problem:
            problems[name] = str(problem)
            del methods[name]
    settings: dict[str, Any] = {"strategies": strategies, "seed": seed}
    added = {name: extensions("methods")[name].package for name in methods if _is_added(name)}
    if added:  # their code is no part of the sweep's digest
        settings["packages"] = added
    many = {"even": people, "uneven": -(-people // 4), "drifting": -(-people // 4)}
    cases = [
        (crowd, name, first, min(A_PIECE, many[crowd] - first))
        for crowd in CROWDS
        for name in methods
        for first in range(0, many[crowd], A_PIECE)
    ]
    results = Sweep("algorithms", meet, settings, cases).run(where)
    met: dict[tuple[str, str], list[list[float]]] = {}
    for (crowd, name, _, _), rows in zip(cases, results, strict=True):
        met.setdefault((crowd, name), []).extend(rows)
    rows = {
        crowd: {
            name: {"method": chosen.method, **_row(met[crowd, name])}
            for name, chosen in methods.items()
        }
        for crowd in CROWDS
    }
    users = load_users()
    factor = lai_robbins(users.preferred, [users.other] * (strategies - 1))
    return {
        "algorithms": rows["even"],
        "uneven": rows["uneven"],
        "drifting": rows["drifting"],
        "not_compared": problems,
        "lai_robbins": {
            "factor": factor,
            "regret": {str(horizon): factor * log(horizon) for horizon in HORIZONS},
        },
        "crowds": {
            crowd.name: {"words": crowd.words, "means": crowd.means} for crowd in CROWDS.values()
        },
        "keep": KEEP,
        "earlier_people": EARLIER,
        "change": CHANGE,
    }


def _is_added(name: str) -> bool:
    return name in extensions("methods") and name not in PUBLISHED_COMPARISON


def _row(people: Sequence[Sequence[float]]) -> dict[str, Any]:
    columns = list(zip(*people, strict=True))
    regrets = {str(h): summary(columns[place]) for place, h in enumerate(HORIZONS)}
    return {
        "n": len(people),
        "regret": {horizon: regret["mean"] for horizon, regret in regrets.items()},
        "regret_se": {horizon: regret["se"] for horizon, regret in regrets.items()},
        "optimal_share": summary(columns[len(HORIZONS)])["mean"],
        "optimal_share_after_change": summary(columns[len(HORIZONS) + 1])["mean"],
    }
