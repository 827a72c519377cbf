"""Posteriors: Beta(1, 1) as prior, Eq. 2 after each response, P(best) by integration."""

from __future__ import annotations

from math import isclose, sqrt
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.beliefs import Beta, leading, probability_best, settled, uniform_beliefs

counts = st.tuples(st.integers(0, 2000), st.integers(0, 2000))


def test_the_prior_is_uniform_for_every_strategy() -> None:
    beliefs = uniform_beliefs(["praise", "neutral", "scarcity"])
    assert set(beliefs.values()) == {Beta(1, 1)}
    assert all(isclose(p, 1 / 3) for p in probability_best(beliefs).values())
    assert Beta().density(5) == pytest.approx([1] * 5)
    assert Beta().trials == 0


@given(st.lists(st.booleans(), max_size=60))
def test_a_response_adds_one_to_alpha_or_to_beta(responses: list[bool]) -> None:
    belief = Beta()
    for complied in responses:
        before, belief = belief, belief.updated(complied)
        assert (belief.alpha - before.alpha, belief.beta - before.beta) == (
            (1, 0) if complied else (0, 1)
        )
    assert belief == Beta(1 + sum(responses), 1 + len(responses) - sum(responses))
    assert belief.trials == len(responses)
    assert belief.mean == (1 + sum(responses)) / (2 + len(responses))


def test_updating_returns_a_new_posterior() -> None:
    belief = Beta(2, 3)
    belief.updated(True)
    assert belief == Beta(2, 3)


@pytest.mark.slow
@given(counts)
def test_the_density_integrates_to_one_and_gives_the_mean(count: tuple[int, int]) -> None:
    belief = Beta(1 + count[0], 1 + count[1])
    points = 20_000
    density = belief.density(points)
    assert isclose(sum(density) / points, 1, rel_tol=1e-3)
    mean = sum((i + 0.5) / points * d for i, d in enumerate(density)) / points
    assert isclose(mean, belief.mean, abs_tol=1e-3)


@given(st.dictionaries(st.text(max_size=3), counts, min_size=1, max_size=6))
def test_the_probabilities_of_being_best_sum_to_one(profile: dict[str, tuple[int, int]]) -> None:
    best = probability_best({s: Beta(1 + a, 1 + b) for s, (a, b) in profile.items()})
    assert list(best) == list(profile)
    assert isclose(sum(best.values()), 1)
    assert all(0 <= p <= 1 for p in best.values())


@given(counts, st.permutations(["a", "b", "c"]))
def test_the_probability_of_being_best_ignores_the_order(
    count: tuple[int, int], order: list[str]
) -> None:
    beliefs = {"a": Beta(1 + count[0], 1 + count[1]), "b": Beta(4, 2), "c": Beta(2, 2)}
    shuffled = probability_best({name: beliefs[name] for name in order})
    assert shuffled == pytest.approx(probability_best(beliefs))


@given(counts)
def test_compliance_never_lowers_the_probability_of_being_best(count: tuple[int, int]) -> None:
    belief, others = Beta(1 + count[0], 1 + count[1]), {"b": Beta(9, 3), "c": Beta(2, 5)}
    now = probability_best({"a": belief, **others})["a"]
    assert probability_best({"a": belief.updated(True), **others})["a"] >= now - 1e-9
    assert probability_best({"a": belief.updated(False), **others})["a"] <= now + 1e-9


@pytest.mark.parametrize(
    "profile",
    [
        {"a": (1, 1), "b": (1, 1), "c": (1, 1), "d": (1, 1)},
        {"a": (5, 1), "b": (2, 3), "c": (1, 1), "d": (2, 2)},
        {"a": (20, 3), "b": (18, 4), "c": (6, 7), "d": (1, 2)},
        {"a": (200, 20), "b": (190, 20), "c": (2, 2), "d": (90, 120)},
        {"a": (1, 9), "b": (1, 1)},
    ],
)
def test_the_probability_of_being_best_matches_a_simulation(
    profile: dict[str, tuple[int, int]],
) -> None:
    beliefs = {s: Beta(a, b) for s, (a, b) in profile.items()}
    rng, draws = Random(11), 20_000
    won = dict.fromkeys(beliefs, 0)
    for _ in range(draws):
        drawn = {s: rng.betavariate(belief.alpha, belief.beta) for s, belief in beliefs.items()}
        won[max(drawn, key=drawn.__getitem__)] += 1
    for strategy, chance in probability_best(beliefs).items():
        sd = sqrt(chance * (1 - chance) / draws)
        assert abs(won[strategy] / draws - chance) < 4 * sd + 0.002


@given(st.integers(1, 60))
def test_quantiles_match_closed_forms(n: int) -> None:
    for share in (0.05, 0.5, 0.95):
        assert Beta(n, 1).quantile(share) == pytest.approx(share ** (1 / n))
        assert Beta(1, n).quantile(share) == pytest.approx(1 - (1 - share) ** (1 / n))


@pytest.mark.slow
@given(st.tuples(st.integers(0, 300), st.integers(0, 300)))
def test_the_interval_has_ninety_percent_of_the_probability(pair: tuple[int, int]) -> None:
    belief = Beta(1 + pair[0], 1 + pair[1])
    low, high = belief.interval()
    points = 20_000
    inside = sum(
        value / points
        for at, value in enumerate(belief.density(points))
        if low <= (at + 0.5) / points <= high
    )
    assert inside == pytest.approx(0.9, abs=0.01)


@given(st.lists(st.booleans(), max_size=60), st.floats(1, 5), st.floats(1, 5))
def test_counts_stay_exact_with_any_prior(responses: list[bool], alpha: float, beta: float) -> None:
    belief = Beta(alpha, beta, (0, 0))
    for complied in responses:
        belief = belief.updated(complied)
    assert belief.complied == responses.count(True)
    assert belief.trials == len(responses)
    assert belief.alpha == pytest.approx(alpha + responses.count(True))


def test_a_strategy_is_settled_at_ninety_percent() -> None:
    assert settled({"a": 0.9, "b": 0.1}) == "a"
    assert settled({"a": 0.899, "b": 0.101}) is None
    assert leading({"a": 0.6, "b": 0.4}) == "a"
    assert leading({"a": 0.4, "b": 0.4, "c": 0.2}) is None
    assert settled({}) is leading({}) is None
