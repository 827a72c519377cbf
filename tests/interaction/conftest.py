"""Fixtures of the tests of facilitation: a learnt policy, and games played with it."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

import pytest

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.person import Person
from tangy_profiles.store import Store
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.interaction.facilitation import Facilitation
from tangy_tui.interaction.game_events import Acted, GameEvent
from tangy_tui.interaction.persuasion import Persuasion
from tangy_tui.learning.policy import ForestSettings, Policy, learn_policy

FEW = ForestSettings(trees=5)


def play(facilitation: Facilitation, games: int = 1) -> list[GameEvent]:
    events: list[GameEvent] = []
    for _ in range(games):
        events += facilitation.begin()
        while not facilitation.over:
            events += facilitation.step()
    return events


def acts(events: list[GameEvent]) -> list[Acted]:
    return [event for event in events if isinstance(event, Acted)]


@pytest.fixture(scope="session")
def policy(
    activity: Activity, cover: Callable[[str, int, int], tuple[Demonstration, ...]]
) -> Policy:
    return learn_policy(activity, cover("bingo", 1, 4), settings=FEW)


@pytest.fixture
def facilitate(
    activity: Activity, policy: Policy, people: tuple[Person, ...], store: Store
) -> Callable[..., Facilitation]:
    """Make a facilitation: (seed, policy, activity) -> facilitation."""

    def make(
        seed: int = 1, policy: Policy = policy, activity: Activity = activity, users: int = 4
    ) -> Facilitation:
        present = people[:users]
        ids = [person.id for person in present]
        return Facilitation(
            SimulatedWorld(activity, ids, seed=seed),
            policy,
            Persuasion(ids, tuple(activity.strategies), Random(seed), counts=store.responses()),
            store,
            names={person.id: person.name for person in present},
            seed=seed,
        )

    return make
