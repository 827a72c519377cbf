"""Sensitivity of Scenario 2 to the parameters that the paper does not state.

The paper states neither the compliance rates of its simulated people nor its criterion of
convergence. Both were chosen here to come near its figure, so the agreement is no result; the
effect of other choices is.
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
"""Probabilities of complying with the preferred strategy."""
OTHER = (0.2, 0.4, 0.6)
"""Probabilities of complying with any other strategy."""
IN_A_ROW = (5, 10)
"""Optimal strategies in a row that may count as convergence."""

LONGEST = 1_500
"""Interactions after which a person counts as not converged."""

ENOUGH = 200
"""People for each choice; they give the mean to within about one strategy."""


def meet(settings: Settings, case: Sequence[Any]) -> list[int | None]:
    """Simulate people with these rates; return each person's number of sub-optimal strategies.

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
    """Run every choice with this many people each.

    Returns:
        For each choice `preferred`, `other`, `in_a_row`, whether it is the one `used` here, the
        `mean` of sub-optimal strategies before convergence, and how many `never` converged.
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
