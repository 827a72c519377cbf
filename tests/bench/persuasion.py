"""Regret of every method of choosing a strategy beside the paper's, and decisions per second.

Run by hand: `python tests/bench/persuasion.py [PEOPLE]` (needs the extra [bench]). Everybody
answers the k-th use of a strategy the same way whichever method asks, so that methods, mabwiser's
among them, differ only by their choices. Regret is the expected loss of compliance:
the sum of the best strategy's rate less the chosen one's. The goals, at T = 60:
Bayes-UCB at most .65 x Thompson, with a prior at most .5 x on a population, Thompson 6.2 +- .4;
and a plain belief chooses and learns at least 10 x as often per second as mabwiser.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from math import sqrt
from random import Random
from statistics import mean, median, stdev
from time import perf_counter
from typing import Any, Protocol

from tangy_profiles.state import Response
from tangy_tui.interaction.methods import (
    BayesUcb,
    Counts,
    EarlierPeople,
    Forgetting,
    Method,
    Thompson,
)
from tangy_tui.interaction.persuasion import Persuasion

STRATEGIES = ("a", "b", "c", "d")
HORIZONS = (23, 60, 300)
EARLIER, MET = 40, 23  # people met before, and how often each: 20 games of the paper
CHANGE = 100  # the interaction after which the drifting people like the next strategy
KEEP = 0.98
ROUNDS, DECISIONS = 9, 3_000

Rates = Mapping[str, float]
Crowd = Callable[[object], Rates]
"""Returns a person's rates of compliance, by strategy, for the person's name."""


class Chooser(Protocol):
    """Chooses, and learns from the response."""

    def choose(self) -> str: ...

    def learn(self, strategy: str, complied: bool) -> None: ...


class Ours:
    """One of Tangy's methods with one person, as the program uses it."""

    def __init__(self, method: Method, seed: object, *, notices_drift: bool = False) -> None:
        self._persuasion = Persuasion(
            ("p",), STRATEGIES, Random(f"{seed}"), method=method, notices_drift=notices_drift
        )

    def choose(self) -> str:
        return self._persuasion.choose("p").strategy

    def learn(self, strategy: str, complied: bool) -> None:
        self._persuasion.update(Response("p", strategy, True, complied, 0.0))


class MabWiser:
    """mabwiser with one person; methods that cannot begin without data use every strategy once."""

    def __init__(self, policy: Any, seed: object, *, once_each: bool = False) -> None:
        from mabwiser.mab import MAB

        self._mab = MAB(list(STRATEGIES), policy, seed=Random(f"{seed}").getrandbits(30))
        self._mab.fit([], [])
        self._first = list(STRATEGIES) if once_each else []

    def choose(self) -> str:
        return self._first.pop() if self._first else str(self._mab.predict())

    def learn(self, strategy: str, complied: bool) -> None:
        self._mab.partial_fit([strategy], [int(complied)])


def liking(favourite: str) -> Rates:
    return {strategy: 0.9 if strategy == favourite else 0.4 for strategy in STRATEGIES}


def even(person: object) -> Rates:
    """Each strategy is the favourite of the same share of people."""
    return liking(Random(f"even/{person}").choice(STRATEGIES))


def shared(person: object) -> Rates:
    """Seven people in ten like the same strategy best."""
    chances = [0.7 if strategy == "b" else 0.1 for strategy in STRATEGIES]
    return liking(Random(f"shared/{person}").choices(STRATEGIES, chances)[0])


def uneven(person: object) -> Rates:
    """Rates are drawn around a mean for each strategy, with a concentration of 6."""
    draw = Random(f"uneven/{person}").betavariate
    means = zip(STRATEGIES, (0.8, 0.6, 0.45, 0.3), strict=True)
    return {strategy: draw(6 * m, 6 * (1 - m)) for strategy, m in means}


def meet(
    chooser: Chooser, rates: Rates, person: object, times: int, change: int = 0
) -> tuple[list[float], Counts]:
    """Run a method with one person.

    Returns:
        The regret after each interaction, and the counts of the responses. From the interaction
        `change` on (0: never), the person likes the next strategy instead.
    """
    answers = {s: Random(f"answer/{person}/{s}") for s in STRATEGIES}
    turned = dict(zip((*STRATEGIES[1:], STRATEGIES[0]), rates.values(), strict=True))
    regret, lost = [], 0.0
    counts = dict.fromkeys(STRATEGIES, (0, 0))
    for time in range(times):
        now = turned if change and time >= change else rates
        strategy = chooser.choose()
        complied = answers[strategy].random() < now[strategy]
        chooser.learn(strategy, complied)
        yes, no = counts[strategy]
        counts[strategy] = (yes + complied, no + (not complied))
        lost += max(now.values()) - now[strategy]
        regret.append(lost)
    return regret, counts


def met_before(crowd: Crowd, group: object) -> list[Counts]:
    """Return the counts of earlier people, with whom the paper's method was used."""
    people = [f"{group}/earlier/{n}" for n in range(EARLIER)]
    return [meet(Ours(Thompson(), p), crowd(p), p, MET)[1] for p in people]


def regrets(
    make: Callable[[Sequence[Counts], object], Chooser],
    crowd: Crowd,
    people: int,
    times: int,
    *,
    earlier: bool = False,
    change: int = 0,
) -> list[list[float]]:
    """Return each person's regrets; each ten people have a new group of earlier people."""
    before: list[Counts] = []
    found = []
    for person in range(people):
        if earlier and person % 10 == 0:
            before = met_before(crowd, person)
        found.append(meet(make(before, person), crowd(person), person, times, change)[0])
    return found


def thompson(before: Sequence[Counts], seed: object) -> Chooser:
    return Ours(Thompson(), seed)


def bayes_ucb(before: Sequence[Counts], seed: object) -> Chooser:
    return Ours(BayesUcb(), seed)


def thompson_prior(before: Sequence[Counts], seed: object) -> Chooser:
    return Ours(EarlierPeople(Thompson(), before), seed)


def bayes_ucb_prior(before: Sequence[Counts], seed: object) -> Chooser:
    return Ours(EarlierPeople(BayesUcb(), before), seed)


def thompson_forgetting(before: Sequence[Counts], seed: object) -> Chooser:
    return Ours(Forgetting(Thompson(), KEEP), seed)


def bayes_ucb_forgetting(before: Sequence[Counts], seed: object) -> Chooser:
    return Ours(Forgetting(BayesUcb(), KEEP), seed)


def thompson_noticing_drift(before: Sequence[Counts], seed: object) -> Chooser:
    return Ours(Thompson(), seed, notices_drift=True)


def bayes_ucb_noticing_drift(before: Sequence[Counts], seed: object) -> Chooser:
    return Ours(BayesUcb(), seed, notices_drift=True)


def mabwiser_thompson(before: Sequence[Counts], seed: object) -> Chooser:
    from mabwiser.mab import LearningPolicy

    return MabWiser(LearningPolicy.ThompsonSampling(), seed)


def mabwiser_ucb(before: Sequence[Counts], seed: object) -> Chooser:
    from mabwiser.mab import LearningPolicy

    return MabWiser(LearningPolicy.UCB1(alpha=1), seed, once_each=True)


PLAIN = (thompson, bayes_ucb, mabwiser_thompson, mabwiser_ucb)
PRIOR = (thompson_prior, bayes_ucb_prior)
FORGETTING = (thompson_forgetting, bayes_ucb_forgetting)
NOTICING = (thompson_noticing_drift, bayes_ucb_noticing_drift)


def table(title: str, crowd: Crowd, people: int, drifting: bool = False) -> None:
    """Print the regrets of all methods with one crowd, and their ratio to the paper's at T = 60."""
    print(f"\n{title} ({people} people)")
    print(f"  {'regret at T =':24}" + "".join(f"{t:>14}" for t in HORIZONS) + "   ratio at 60")
    yardstick = 0.0
    extra = (*FORGETTING, *NOTICING) if drifting or crowd is even else ()
    for make in (*PLAIN, *(PRIOR if crowd is not even else ()), *extra):
        change = CHANGE if drifting else 0
        found = regrets(make, crowd, people, HORIZONS[-1], earlier=make in PRIOR, change=change)
        cells = []
        for time in HORIZONS:
            values = [regret[time - 1] for regret in found]
            cells.append(f"{mean(values):8.2f} ±{1.96 * stdev(values) / sqrt(people):4.2f}")
        at_60 = mean(regret[59] for regret in found)
        yardstick = yardstick or at_60
        name = make.__name__.replace("_", " ")
        print(f"  {name:24}{''.join(cells)}{at_60 / yardstick:14.2f}", flush=True)


def per_second(chooser: Chooser, learn: bool) -> float:
    begun = perf_counter()
    for time in range(DECISIONS):
        strategy = chooser.choose()
        if learn:
            chooser.learn(strategy, time % 3 != 0)
    return DECISIONS / (perf_counter() - begun)


def bare_per_second(learn: bool) -> float:
    """Return decisions per second from a belief alone, without the program's records."""
    method, rng = Thompson(), Random(1)
    beliefs = prior = method.prior(STRATEGIES)
    begun = perf_counter()
    for time in range(DECISIONS):
        scores = method.scores(beliefs, rng)
        strategy = max(scores, key=scores.__getitem__)
        if learn:
            beliefs = method.updated(beliefs, prior, strategy, time % 3 != 0)
    return DECISIONS / (perf_counter() - begun)


def speeds(learn: bool) -> tuple[float, float, float]:
    """Return the medians of decisions per second: a plain belief, the program, mabwiser.

    They take turns, so that load on the machine affects all alike. With `learn` each decision is
    followed by its response, as in a game: mabwiser spends most of its time there.
    """
    rounds = [
        (
            bare_per_second(learn),
            per_second(thompson((), 1), learn),
            per_second(mabwiser_thompson((), 1), learn),
        )
        for _ in range(ROUNDS)
    ]
    plain, program, mabwiser = (median(turn[n] for turn in rounds) for n in range(3))
    return plain, program, mabwiser


def main() -> None:
    """Print all tables."""
    people = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000
    print(f"{people} people with each crowd; seeds are their numbers")
    table("Favourites shared out evenly: .9, the others .4", even, people)
    table("Seven in ten share a favourite: .9, the others .4", shared, people)
    table("Rates around .8, .6, .45, .3", uneven, people)
    table(f"Even, and everybody changes after {CHANGE}", even, people, drifting=True)
    print(f"\ndecisions per second, median of {ROUNDS} turns of {DECISIONS:,}")
    print(f"  {'':28}{'plain belief':>14}{'program':>14}{'mabwiser':>14}      ratios")
    for learn, what in ((True, "chosen and learnt from"), (False, "chosen only")):
        plain, program, mabwiser = speeds(learn)
        ratios = f"{plain / mabwiser:8.1f}{program / mabwiser:8.1f}"
        print(f"  {what:28}{plain:14,.0f}{program:14,.0f}{mabwiser:14,.0f}{ratios}")


if __name__ == "__main__":
    main()
