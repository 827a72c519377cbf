"""Simulated people always follow, and comply in time by their hidden preferences."""

from __future__ import annotations

from collections import Counter
from importlib.resources import files
from math import sqrt
from pathlib import Path
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.activity import Activity
from tangy_profiles.errors import ProfileError
from tangy_sim.worlds.compliance import preferences_in_turn, respond
from tangy_sim.worlds.users import UserModel, load_users, waiting_calls, waiting_time
from tangy_sim.worlds.world import SimulatedWorld

STRATEGIES = ("neutral", "praise", "suggestion", "scarcity")


class Counted(Random):
    """A generator that counts its draws."""

    drawn = 0

    def random(self) -> float:
        self.drawn += 1
        return super().random()


def test_the_user_model_is_the_fitted_one() -> None:
    assert load_users() == UserModel(
        miss=0.101, slip=0.0369, ask=0.0074, ask_with_error=1.47, occluded=0.324,
        call_seconds=31.0, away_calls=3.42, preferred=0.9, other=0.4, teaching_factor=2.3,
    )  # fmt: skip
    assert load_users().occluded == pytest.approx(23 / 71, abs=5e-4)


def test_people_in_a_teaching_game_only_ask_more_often() -> None:
    users, teaching = load_users(), load_users().teaching()
    assert teaching.ask == pytest.approx(2.3 * 0.0074)
    assert teaching.miss == users.miss


def test_preferred_strategies_are_assigned_in_turn() -> None:
    people = [f"user{n}" for n in range(1, 9)]
    hidden = preferences_in_turn(people, STRATEGIES, load_users())
    assert list(hidden) == people
    liked = [max(p, key=p.__getitem__) for p in hidden.values()]
    assert liked == [*STRATEGIES, *STRATEGIES]
    for person in people:
        assert Counter(hidden[person].values()) == {0.9: 1, 0.4: 3}
    assert preferences_in_turn(people[:2], STRATEGIES, load_users()) == {
        person: hidden[person] for person in people[:2]
    }


@given(st.floats(0, 1), st.floats(1, 60), st.integers())
def test_a_response_is_always_followed_and_complied_within_the_window_or_late(
    chance: float, patience: float, seed: int
) -> None:
    rng = Counted(seed)
    response = respond({"a": {"s": chance}}, "a", "s", patience, rng)
    assert rng.drawn == 2, "two draws whatever the response, so that later ones do not shift"
    assert response.followed
    assert (response.person, response.strategy) == ("a", "s")
    if response.complied:
        assert 0 < response.seconds <= patience
    else:
        assert patience <= response.seconds <= 2 * patience


@pytest.mark.parametrize("chance", [0.0, 0.4, 0.9, 1.0])
def test_the_compliance_rate_equals_the_preference(chance: float) -> None:
    rng = Random(3)
    complied = sum(respond({"a": {"s": chance}}, "a", "s", 10, rng).complied for _ in range(4000))
    assert abs(complied / 4000 - chance) <= 4 * sqrt(chance * (1 - chance) / 4000)


def test_people_in_games_comply_with_their_preferred_strategy(
    activity: Activity, ids: tuple[str, ...]
) -> None:
    for strategy in STRATEGIES:
        world = SimulatedWorld(activity, ids, seed=21)
        tried: Counter[str] = Counter()
        complied: Counter[str] = Counter()
        for _ in range(60):
            while not world.over:
                state = world.observe()
                behaviour = activity.behaviours[activity.expected[state.situation]]
                target = state.attended if behaviour.attends else None
                outcome = world.execute(activity.action(behaviour, target, strategy))
                assert (outcome.response is not None) == behaviour.persuades
                if outcome.response is not None:
                    assert outcome.response.person == target
                    tried[str(target)] += 1
                    complied[str(target)] += outcome.response.complied
            world.begin()
        for person in ids:
            chance = world.preferences[person][strategy]
            sd = sqrt(chance * (1 - chance) / tried[person])
            assert abs(complied[person] / tried[person] - chance) < 4 * sd


@given(st.integers(), st.floats(0.01, 0.99))
def test_waiting_is_at_least_a_call(seed: int, chance: float) -> None:
    assert waiting_calls(Random(seed).random, chance) >= 1
    assert waiting_time(Random(seed).random, chance) > 0


def test_waiting_times_match_the_probability_or_rate() -> None:
    uniform = Random(5).random
    calls = [waiting_calls(uniform, 0.1) for _ in range(8000)]
    assert sum(calls) / 8000 == pytest.approx(10, rel=0.05)
    assert calls.count(1) / 8000 == pytest.approx(0.1, rel=0.15)
    assert sum(waiting_time(uniform, 0.25) for _ in range(8000)) / 8000 == pytest.approx(
        4, rel=0.05
    )


def test_impossible_events_never_come_and_certain_ones_at_once() -> None:
    uniform = Random(5).random
    assert waiting_calls(uniform, 0) > 1e8
    assert waiting_calls(uniform, 1) == 1
    assert waiting_time(uniform, 0) > 1e17


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("miss = 0.101", "miss = 1.01", ("play.miss = 1.01", "0 to 1")),
        ("slip = 0.0369", "slips = 0.0369", ("play.slip", "missing")),
        ("ask = 0.0074", "ask = nan", ("play.ask = nan",)),
        ("preferred = 0.9", "preferred = '.9'", ("compliance.preferred = '.9'",)),
        ("other = 0.4", "other = 0.4\nothers = 1", ("compliance.others", "'other'?")),
        ("[teaching]", "[teeching]", ("teaching: is missing",)),
    ],
)
def test_a_mistake_in_the_user_model_is_reported_in_one_line(
    tmp_path: Path, old: str, new: str, said: tuple[str, ...]
) -> None:
    text = (Path(str(files("tangy_sim.worlds"))) / "users.toml").read_text(encoding="utf-8")
    assert old in text
    path = tmp_path / "mine.toml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ProfileError) as caught:
        load_users(path)
    for words in ("mine.toml: ", *said):
        assert words in str(caught.value)
