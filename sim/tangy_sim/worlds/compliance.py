"""Whether simulated people comply: each has a hidden preference for one persuasive strategy."""

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
    """Give the people different preferences (probabilities), strategy by strategy in turn.

    They do not depend on the seed: a person whom Tangy has got to know stays the same person.
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
    """Let a person respond: always follow, and comply in time as their preference has it.

    Args:
        preferences: of each person, how probably they comply with each strategy.
        person: the id of the person.
        strategy: how the person was asked.
        patience: the activity's window in seconds; a late response comes within two windows.
        rng: the stream of compliance alone; two numbers are drawn, whatever the response.
    """
    complied = rng.random() < preferences[person][strategy]
    share = rng.random()
    seconds = patience * (0.2 + 0.8 * share) if complied else patience * (1 + share)
    return Response(person, strategy, followed=True, complied=complied, seconds=seconds)
