"""mabwiser beside the experiment's selection methods, on the same draws as `tangy experiment 2`.

Run by hand: `python tests/bench/algorithms.py [PEOPLE]` (needs the extra [bench]). Each person's
answer to strategy s at interaction t is fixed, for every method; the tables show mean regret
with its standard error at 23, 60 and 300 interactions, and decisions per second.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial
from math import sqrt
from random import Random
from statistics import mean, stdev
from time import perf_counter
from typing import Any

from tangy_tui.experiments.algorithms import CROWDS, HORIZONS, compared, meet

CROWD, STRATEGIES, SEED = "even", 4, 0


def mabwiser_policies() -> dict[str, Callable[[int], Any]]:
    """Return factories of mabwiser's bandits by name; each takes a seed."""
    from mabwiser.mab import MAB, LearningPolicy

    arms = list(range(STRATEGIES))
    kinds = {
        "mabwiser Thompson": LearningPolicy.ThompsonSampling(),
        "mabwiser UCB1": LearningPolicy.UCB1(alpha=1),
        "mabwiser epsilon .1": LearningPolicy.EpsilonGreedy(epsilon=0.1),
    }
    return {name: partial(_bandit, MAB, arms, policy) for name, policy in kinds.items()}


def _bandit(mab: Any, arms: list[int], policy: Any, seed: int) -> Any:
    return mab(arms, policy, seed=seed)


def met_by(make: Callable[[int], Any], person: int) -> list[float]:
    """Run one of mabwiser's bandits with a person; return the regret at each horizon."""
    crowd = CROWDS[CROWD]
    rates = crowd.rates(person, STRATEGIES, SEED)
    answers = Random(f"{SEED}/answers/{person}").random
    bandit = make(person)
    regret, marks = 0.0, []
    for time in range(HORIZONS[-1]):
        chosen = (
            bandit.predict() if time else Random(person).randrange(STRATEGIES)
        )  # mabwiser must be fitted first
        would = [answers() for _ in range(STRATEGIES)]
        complied = int(would[chosen] < rates[chosen])
        (bandit.partial_fit if time else bandit.fit)([chosen], [complied])
        regret += max(rates) - rates[chosen]
        if time + 1 in HORIZONS:
            marks.append(regret)
    return marks


def _all_met_by(make: Callable[[int], Any], people: int) -> list[list[float]]:
    return [met_by(make, person) for person in range(people)]


def main() -> None:
    """Print the table."""
    people = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    print(f"{'':24}" + "".join(f"{f'T = {horizon}':>14}" for horizon in HORIZONS) + "  decisions/s")
    settings = {"strategies": STRATEGIES, "seed": SEED}
    rows: dict[str, Callable[[], list[list[float]]]] = {
        name: partial(meet, settings, (CROWD, name, 0, people)) for name in compared()
    }
    for name, make in mabwiser_policies().items():
        rows[name] = partial(_all_met_by, make, people)
    for name, run in rows.items():
        begun = perf_counter()
        regrets = run()
        rate = people * HORIZONS[-1] / (perf_counter() - begun)
        columns = list(zip(*regrets, strict=True))[: len(HORIZONS)]
        cells = [f"{mean(c):7.2f} +- {stdev(c) / sqrt(people):.2f}" for c in columns]
        print(f"{name:24}" + "".join(f"{cell:>14}" for cell in cells) + f"{rate:13,.0f}")


if __name__ == "__main__":
    main()
