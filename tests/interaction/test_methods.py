"""The laws of each method of persuasion; the default is exactly the paper's."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from random import Random
from statistics import mean

import pytest
from hypothesis import given
from hypothesis import settings as examples
from hypothesis import strategies as st

from tangy_profiles.beliefs import Beliefs, Beta, uniform_beliefs
from tangy_profiles.codec import InvalidValue, decode, encode
from tangy_profiles.errors import ProfileError
from tangy_profiles.persuading import (
    PAPER,
    PERSUASION_METHODS,
    PersuasionConfig,
    read_persuading,
    spoken_persuading,
)
from tangy_profiles.reading import Table
from tangy_tui.interaction.memory import counted
from tangy_tui.interaction.methods import (
    MAX_PRIOR_WEIGHT,
    BayesUcb,
    EarlierPeople,
    Forgetting,
    Method,
    Thompson,
    fit_beta_prior,
    method_of,
    others,
)
from tests.bench import persuasion as bench

STRATEGIES = ("plain", "warm", "brisk")

a_count = st.tuples(st.integers(0, 40), st.integers(0, 40))
some_counts = st.lists(a_count, max_size=12)
responses = st.lists(st.tuples(st.sampled_from(STRATEGIES), st.booleans()), max_size=40)
methods: st.SearchStrategy[Method] = st.builds(
    method_of,
    st.builds(
        PersuasionConfig,
        st.sampled_from(["thompson", "bayes-ucb"]),
        st.sampled_from(["uniform", "people"]),
        st.sampled_from([1.0, 0.98, 0.6]),
        st.sampled_from(["interaction", "day"]),
    ),
    st.lists(st.fixed_dictionaries(dict.fromkeys(STRATEGIES, a_count)), max_size=5),
)


def learn(method: Method, told: Sequence[tuple[str, bool]]) -> Beliefs:
    beliefs = prior = method.prior(STRATEGIES)
    for strategy, complied in told:
        beliefs = method.updated(beliefs, prior, strategy, complied)
    return beliefs


# ------------------------------------------------------------------------------- the paper's


@given(responses, st.integers())
def test_the_default_method_draws_from_the_beta_posterior(
    told: list[tuple[str, bool]], seed: int
) -> None:
    method = method_of(PAPER)
    beliefs = learn(method, told)
    ours, direct = Random(seed), Random(seed)
    expected = {}
    for strategy in STRATEGIES:
        yes = told.count((strategy, True))
        no = told.count((strategy, False))
        assert beliefs[strategy] == Beta(1 + yes, 1 + no)
        expected[strategy] = direct.betavariate(1 + yes, 1 + no)
    assert method.scores(beliefs, ours) == expected
    assert ours.getstate() == direct.getstate()
    assert not method.forgets
    assert type(method) is Thompson


# ------------------------------------------------------------------------ laws of every method


@given(methods, responses)
def test_counts_match_the_responses_for_any_method(
    method: Method, told: list[tuple[str, bool]]
) -> None:
    beliefs = learn(method, told)
    for strategy in STRATEGIES:
        belief = beliefs[strategy]
        assert belief.complied == told.count((strategy, True))
        assert belief.trials - belief.complied == told.count((strategy, False))
        assert belief.alpha >= 1
        assert belief.beta >= 1


@given(methods, responses)
def test_learning_does_not_modify_its_arguments(
    method: Method, told: list[tuple[str, bool]]
) -> None:
    prior = method.prior(STRATEGIES)
    before = dict(prior)
    beliefs = method.updated(prior, prior, STRATEGIES[0], True)
    method.faded(beliefs, prior, 3.0)
    assert prior == before == method.prior(STRATEGIES)


@given(methods, responses, st.integers())
def test_every_strategy_has_a_score_that_is_a_probability(
    method: Method, told: list[tuple[str, bool]], seed: int
) -> None:
    scores = method.scores(learn(method, told), Random(seed))
    assert tuple(scores) == STRATEGIES
    assert all(0 <= score <= 1 for score in scores.values())


@given(methods, responses, st.randoms(use_true_random=False))
def test_the_order_does_not_matter_without_forgetting(
    method: Method, told: list[tuple[str, bool]], rng: Random
) -> None:
    if method.forgets:
        return
    shuffled = list(told)
    rng.shuffle(shuffled)
    counts = {("p", s): (told.count((s, True)), told.count((s, False))) for s in STRATEGIES}
    assert learn(method, told) == learn(method, shuffled)
    assert learn(method, told) == counted(method.prior(STRATEGIES), "p", counts)


# ------------------------------------------------------------------------------------ Bayes-UCB


@given(responses)
def test_bayes_ucb_scores_with_the_quantile_one_less_one_in_t_plus_one(
    told: list[tuple[str, bool]],
) -> None:
    beliefs = learn(BayesUcb(), told)
    t = len(told) + 1
    for strategy, score in BayesUcb().scores(beliefs, Random(1)).items():
        assert score == pytest.approx(beliefs[strategy].quantile(1 - 1 / (t + 1)))


def test_bayes_ucb_uses_no_random_numbers() -> None:
    rng = Random(4)
    before = rng.getstate()
    BayesUcb().scores(uniform_beliefs(STRATEGIES), rng)
    assert rng.getstate() == before


# --------------------------------------------------------------------------- earlier people


@given(some_counts)
def test_the_prior_from_earlier_people_is_worth_at_most_four_responses(
    counts: list[tuple[int, int]],
) -> None:
    prior = fit_beta_prior(counts)
    worth = prior.alpha + prior.beta - 2
    assert 0 <= worth <= min(MAX_PRIOR_WEIGHT, len(counts))
    assert prior.alpha >= 1
    assert prior.beta >= 1
    assert prior.trials == 0


def test_the_prior_without_earlier_people_is_uniform() -> None:
    assert fit_beta_prior([]) == Beta()
    for people in ([], [{"plain": (0, 0)}], [{"unheard of": (3, 1)}]):
        assert EarlierPeople(Thompson(), people).prior(STRATEGIES) == uniform_beliefs(STRATEGIES)


@examples(max_examples=30)
@given(some_counts.filter(bool))
def test_the_lent_prior_maximises_the_likelihood_of_the_counts(
    counts: list[tuple[int, int]],
) -> None:
    def likelihood(alpha: float, beta: float) -> float:
        def log_beta(a: float, b: float) -> float:
            return math.lgamma(a) + math.lgamma(b) - math.lgamma(a + b)

        return sum(log_beta(alpha + y, beta + n) - log_beta(alpha, beta) for y, n in counts)

    prior, most = fit_beta_prior(counts), 4 * min(MAX_PRIOR_WEIGHT, len(counts))
    best = max(
        likelihood(1 + u / 4, 1 + v / 4) for u in range(most + 1) for v in range(most + 1 - u)
    )
    assert likelihood(prior.alpha, prior.beta) == pytest.approx(best, abs=1e-6)


def test_a_strategy_that_worked_with_everybody_has_a_high_prior() -> None:
    people = [{"warm": (9, 1), "plain": (1, 3)} for _ in range(12)]
    prior = EarlierPeople(BayesUcb(), people).prior(STRATEGIES)
    assert prior["warm"].mean > 0.7
    assert prior["plain"].mean < 0.45
    assert prior["brisk"] == Beta()
    assert prior["warm"].alpha + prior["warm"].beta == 2 + MAX_PRIOR_WEIGHT


def test_five_own_responses_outweigh_any_prior() -> None:
    prior = fit_beta_prior([(50, 0)] * 40)
    for _ in range(5):
        prior = prior.updated(False)
    assert prior.mean < 0.5


def test_the_prior_excludes_the_persons_own_responses() -> None:
    counts = {("p", "warm"): (9, 0), ("q", "warm"): (1, 2), ("q", "plain"): (0, 1)}
    assert others(counts, "p") == [{"warm": (1, 2), "plain": (0, 1)}]
    assert others(counts, "q") == [{"warm": (9, 0)}]


# ------------------------------------------------------------------------------- forgetting


@given(responses)
def test_forgetting_with_factor_one_keeps_everything(told: list[tuple[str, bool]]) -> None:
    kept, plain = learn(Forgetting(Thompson(), 1.0), told), learn(Thompson(), told)
    for strategy in STRATEGIES:
        assert kept[strategy].alpha == pytest.approx(plain[strategy].alpha)
        assert kept[strategy].beta == pytest.approx(plain[strategy].beta)


@given(responses, st.floats(0.5, 0.99))
def test_responses_decay_with_each_later_interaction(
    told: list[tuple[str, bool]], keep: float
) -> None:
    beliefs = learn(Forgetting(Thompson(), keep), told)
    for strategy in STRATEGIES:
        yes = sum(
            keep ** (len(told) - 1 - at)
            for at, (used, complied) in enumerate(told)
            if used == strategy and complied
        )
        assert beliefs[strategy].alpha == pytest.approx(1 + yes)


@given(st.floats(0, 500), st.floats(0, 500), st.floats(0.5, 0.99))
def test_decay_over_days_is_additive(one: float, other: float, keep: float) -> None:
    method = Forgetting(Thompson(), keep, daily=True)
    prior = method.prior(STRATEGIES)
    beliefs = learn(method, [("warm", True)] * 6 + [("warm", False)] * 2)
    assert beliefs["warm"].alpha == 7
    once = method.faded(beliefs, prior, one + other)["warm"]
    twice = method.faded(method.faded(beliefs, prior, one), prior, other)["warm"]
    assert once.alpha == pytest.approx(twice.alpha)
    assert once.alpha == pytest.approx(1 + 6 * keep ** (one + other))
    assert (once.complied, once.trials) == (6, 8)


def test_long_decay_leaves_only_the_prior() -> None:
    people = [{"warm": (9, 1)} for _ in range(12)]
    method = Forgetting(EarlierPeople(Thompson(), people), 0.9, daily=True)
    prior = method.prior(STRATEGIES)
    beliefs = method.updated(prior, prior, "warm", False)
    faded = method.faded(beliefs, prior, 1000)["warm"]
    assert (faded.alpha, faded.beta) == pytest.approx((prior["warm"].alpha, prior["warm"].beta))


# ------------------------------------------------------------------------------------- regret


def regret(make: object, crowd: bench.Crowd, people: int, **about: bool) -> float:
    assert callable(make)
    return mean(found[-1] for found in bench.regrets(make, crowd, people, 60, **about))


@pytest.mark.slow
def test_the_regret_of_bayes_ucb_is_at_most_65_hundredths_of_thompsons() -> None:
    thompson = regret(bench.thompson, bench.even, 1000)
    assert thompson == pytest.approx(6.2, abs=0.4)
    assert regret(bench.bayes_ucb, bench.even, 1000) <= 0.65 * thompson


@pytest.mark.slow
def test_the_regret_with_a_prior_from_people_is_at_most_half_of_thompsons() -> None:
    thompson = regret(bench.thompson, bench.shared, 150)
    assert regret(bench.bayes_ucb_prior, bench.shared, 150, earlier=True) <= 0.5 * thompson


# ---------------------------------------------------------------------------------- in words


@pytest.mark.parametrize(
    ("words", "chosen"),
    [
        ("thompson", PAPER),
        ("bayes-ucb", PersuasionConfig("bayes-ucb")),
        ("people", PersuasionConfig(prior="people")),
        ("day 0.9 people Bayes-UCB", PersuasionConfig("bayes-ucb", "people", 0.9, "day")),
        (".98", PersuasionConfig(forgetting=0.98)),
    ],
)
def test_a_method_is_read_from_words_in_any_order(words: str, chosen: PersuasionConfig) -> None:
    assert spoken_persuading(words.split()) == chosen
    assert decode(PersuasionConfig, json.loads(json.dumps(encode(chosen)))) == chosen


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("bayes", "There is no method 'bayes': did you mean 'bayes-ucb'?"),
        ("thompson bayes-ucb", "'bayes-ucb' says again what another word has said."),
        ("0.2", "The share that is kept must be from 0.5 to 1, not 0.2."),
        ("nan", "The share that is kept must be from 0.5 to 1, not nan."),
        ("day", "'day' needs the share that is kept, for example 0.98."),
    ],
)
def test_other_words_are_refused_in_one_sentence(words: str, said: str) -> None:
    with pytest.raises(ProfileError) as refused:
        spoken_persuading(words.split())
    assert str(refused.value) == said


def test_an_activity_can_set_its_method() -> None:
    assert read_persuading(Table({}, "x.toml")) == PAPER
    table = {"method": "bayes-ucb", "prior": "people", "forgetting": 0.9, "forgetting_per": "day"}
    assert read_persuading(Table(table, "x.toml")) == PersuasionConfig(
        "bayes-ucb", "people", 0.9, "day"
    )
    with pytest.raises(ProfileError, match=r"x\.toml: persuasion\.method = 'tomson'.*'thompson'"):
        read_persuading(Table({"method": "tomson"}, "x.toml", "persuasion."))
    with pytest.raises(ProfileError, match="is not a key here; did you mean 'forgetting'"):
        read_persuading(Table({"forgeting": 0.9}, "x.toml"))


def test_each_method_has_an_implementation_and_words() -> None:
    from tangy_tui.text import people

    assert set(people.METHOD_TITLES) == set(PERSUASION_METHODS)
    made = {method_of(PersuasionConfig(name)).words for name in PERSUASION_METHODS}
    assert len(made) == len(PERSUASION_METHODS), "two methods have the same words"
    assert {"Thompson sampling", "Bayes-UCB"} <= made


def test_an_unknown_method_is_refused() -> None:
    with pytest.raises(InvalidValue, match=r"has 'method' that is 'thomson' .did you mean"):
        decode(PersuasionConfig, {"method": "thomson"})
