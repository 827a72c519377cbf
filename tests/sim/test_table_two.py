"""A thousand simulated games add up to Table II of the paper (by the fitted user model)."""

from __future__ import annotations

from collections import Counter

import pytest

from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.state import FRONT
from tangy_sim.worlds.users import UserModel, load_users
from tangy_sim.worlds.world import SimulatedWorld

FITTED = {
    "greeting": 20, "joke": 29.3, "call number": 714, "celebrate": 20, "remove markers": 24.6,
    "mark numbers": 22.3, "encourage": 17.5, "move card closer": 22.3, "navigate to user": 69.2,
    "navigate to front": 37.0, "valediction": 20,
}  # fmt: skip
"""Instances per 20 games of the fitted user model."""

GAMES = 1000


class Totals:
    """Totals of many games of four people, played with the expected behaviours."""

    def __init__(self, activity: Activity, seed: int, users: UserModel) -> None:
        world = SimulatedWorld(activity, [f"user{n}" for n in range(1, 5)], seed=seed, users=users)
        self.done: Counter[str] = Counter()
        self.responses = self.readings = self.completed = 0
        for _ in range(GAMES):
            while not world.over:
                state = world.observe()
                behaviour = activity.behaviours[activity.expected[state.situation]]
                target = state.attended if behaviour.attends else None
                outcome = world.execute(activity.action(behaviour, target, None))
                self.done[behaviour.name] += 1
                self.completed += outcome.completed
                self.responses += outcome.response is not None
                self.readings += state.place != FRONT and state.situation.user_state != "occluded"
            world.begin()
        self.steps = sum(self.done.values())


@pytest.fixture(scope="module", params=[20260731, 99991, 123456789])
def live(request: pytest.FixtureRequest) -> Totals:
    return Totals(load_activity("bingo"), request.param, load_users())


@pytest.mark.xdist_group("table two")
def test_the_frequency_of_each_behaviour_matches_the_fitted_model(live: Totals) -> None:
    assert set(live.done) == set(FITTED)
    for behaviour, fitted in FITTED.items():
        assert live.done[behaviour] / GAMES * 20 == pytest.approx(fitted, rel=0.15), behaviour


@pytest.mark.xdist_group("table two")
def test_a_game_has_33_to_38_calls_and_47_to_53_behaviours(live: Totals) -> None:
    assert 33 <= live.done["call number"] / GAMES <= 38
    assert 47 <= live.steps / GAMES <= 53


@pytest.mark.xdist_group("table two")
def test_every_behaviour_succeeds_and_every_game_ends_once(live: Totals) -> None:
    assert live.completed == live.steps
    for once in ("greeting", "celebrate", "valediction"):
        assert live.done[once] == GAMES


@pytest.mark.xdist_group("table two")
def test_a_person_is_persuaded_about_once_a_game(live: Totals) -> None:
    assert live.responses / GAMES / 4 == pytest.approx(1.1, rel=0.1)


@pytest.mark.xdist_group("table two")
def test_visits_read_more_cards_than_there_are_visits(live: Totals) -> None:
    assert live.readings / live.done["navigate to user"] == pytest.approx(87 / 71, rel=0.1)


@pytest.mark.slow
def test_a_teaching_game_has_62_behaviours_like_the_paper(activity: Activity) -> None:
    totals = Totals(activity, 20260731, load_users().teaching())
    assert totals.steps / GAMES == pytest.approx(62, rel=0.03)
