"""Compliance of simulated people: each has a hidden preference for one persuasive strategy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from random import Random

from tangy_profiles.state import Response
from tangy_sim.worlds.users import UserModel

Preferences = Mapping[str, Mapping[str, float]]
"""Person -> strategy -> probability of complying within the patience window."""


def preferences_in_turn(
    people: Sequence[str], strategies: Sequence[str], model: UserModel
) -> dict[str, dict[str, float]]:
    """Assign preferences (probabilities) to people, cycling through the strategies.

    They do not depend on the seed, so that a person whom Tangy knows stays the same.
    """
    return {
        person: {
            strategy: model.preferred if rank == place % len(strategies) else model.other
            for rank, strategy in enumerate(strategies)
        }
        for place, person in enumerate(people)
    }


def respond(
    preferences: Preferences, person: str, strategy: str, patience: float, rng: Random
) -> Response:
    """Simulate a person's response: always follow, and comply in time by their preference.

    Args:
        preferences: each person's probability of complying with each strategy.
        person: id of the person.
        strategy: strategy of the request.
        patience: the activity's window in s; a late response comes within two windows.
        rng: random stream for compliance only; exactly two numbers are drawn.
    """
    complied = rng.random() < preferences[person][strategy]
    share = rng.random()
    seconds = patience * (0.2 + 0.8 * share) if complied else patience * (1 + share)
    return Response(person, strategy, followed=True, complied=complied, seconds=seconds)
