"""What Scenario 2 would have given, had what the paper does not say been chosen otherwise.

The paper names neither how often its simulated people comply nor what it counts as convergence.
Both were chosen here with its figure in view, so that it comes near is no result; how far other
choices move it is one.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from random import Random
from typing import Any

from tangy_profiles.state import Response
from tangy_sim.worlds.users import load_users
from tangy_tui.experiments.classroom import about, activity_of
from tangy_tui.experiments.estimates import summary
from tangy_tui.experiments.persuading import CONVERGED, suboptimal_before_convergence
from tangy_tui.experiments.sweep import Settings, Sweep, Where
from tangy_tui.interaction.persuasion import Persuasion

PREFERRED = (0.8, 0.9, 0.95)
"""Probabilities of complying with the strategy that a person prefers."""
OTHER = (0.2, 0.4, 0.6)
"""Probabilities of complying with any other."""
IN_A_ROW = (5, 10)
"""Optimal strategies in a row that may count as convergence."""

LONGEST = 1_500
"""Interactions after which a person who has not converged is counted as such, and left."""

ENOUGH = 200
"""People for each choice: with so many a mean is known to about one strategy."""


def meet(settings: Settings, case: Sequence[Any]) -> list[int | None]:
    """Meet people who comply at these rates; return how many sub-optimal strategies each took.

    `case` is (preferred, other, in a row). None: the person never converged.
    """
    preferred, other, in_a_row = case
    strategies = tuple(activity_of(settings["activity"]).strategies)
    found: list[int | None] = []
    for number in range(settings["people"]):
        name = f"{settings['seed']}/{case}/{number}"
        persuasion = Persuasion(("person",), strategies, Random(f"{name}/persuasion"))
        answers = Random(f"{name}/answers")
        best = strategies[number % len(strategies)]
        optimal: list[bool] = []
        count = None
        while count is None and len(optimal) < LONGEST:
            strategy = persuasion.choose("person").strategy
            optimal.append(strategy == best)
            complied = answers.random() < (preferred if strategy == best else other)
            persuasion.update(Response("person", strategy, complied, complied, 0.0))
            if all(optimal[-in_a_row:]):
                count = suboptimal_before_convergence(optimal, in_a_row)
        found.append(count)
    return found


def run(activity: str, people: int, seed: int, where: Where) -> list[dict[str, Any]]:
    """Try every choice with so many people each.

    Returns:
        For each choice `preferred`, `other`, `in_a_row`, whether it is the one that is `used`,
        the `mean` of sub-optimal strategies before convergence, and how many `never` converged.
    """
    cases = list(product(PREFERRED, OTHER, IN_A_ROW))
    settings = {**about(activity), "people": people, "seed": seed}
    model = load_users()
    used = (model.preferred, model.other, CONVERGED)
    return [
        {
            "preferred": case[0],
            "other": case[1],
            "in_a_row": case[2],
            "used": tuple(case) == used,
            "mean": summary([count for count in counts if count is not None])["mean"],
            "never": counts.count(None),
        }
        for case, counts in zip(
            cases, Sweep("other choices", meet, settings, cases).run(where), strict=True
        )
    ]
