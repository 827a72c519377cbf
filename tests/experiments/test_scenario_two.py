"""Scenario 2: strategies converge as in the paper, and methods compare on the same draws."""

from __future__ import annotations

from pathlib import Path
from random import Random

import pytest

from tangy_profiles.errors import TangyError
from tangy_tui.experiments import algorithms, figures, other_choices, persuading, published
from tangy_tui.experiments.sweep import Where
from tangy_tui.interaction.methods import BayesUcb, Thompson
from tangy_tui.text.comparison import compare

SEED = 31
LANTERNS = Path(__file__).parent.parent / "lanterns.toml"


def test_the_first_ten_in_a_row_mean_convergence() -> None:
    count = persuading.suboptimal_before_convergence
    assert count([True] * 10) == 0
    assert count([False, True, False, *[True] * 10, False]) == 2
    assert count([True] * 9 + [False] + [True] * 9) is None
    assert count([], in_a_row=1) is None


@pytest.mark.slow
def test_suboptimal_strategies_before_convergence_match_the_paper() -> None:
    played = persuading.run("bingo", 4, 40, SEED, Where(jobs=1))
    before = played["suboptimal_before_convergence"]
    assert (before["n"], before["never"]) == (160, 0)
    assert before["mean"] == pytest.approx(10.8, abs=1.5)
    assert played["interactions_per_user_game"] == pytest.approx(1.1, abs=0.05)
    assert len({user["best"] for user in played["users"]}) == 4
    for user in played["users"]:
        shares = user["optimal_share"]
        assert len(shares) == len(user["one_run"]) == persuading.SHOWN
        assert shares[0] == pytest.approx(0.25, abs=0.2)
        assert sum(shares[-10:]) / 10 > 0.9


@pytest.mark.slow
def test_other_settings_give_other_figures() -> None:
    choices = other_choices.run("bingo", 60, SEED, Where(jobs=1))
    (used,) = (one for one in choices if one["used"])
    assert (used["preferred"], used["other"], used["in_a_row"]) == (0.9, 0.4, 10)
    means = [one["mean"] for one in choices]
    assert min(means) < 7 and max(means) > 20
    assert used["mean"] == pytest.approx(10.8, abs=3)


def test_a_group_gives_the_same_result_alone_and_among_others() -> None:
    settings = {"activity": "bingo", "users": 3}
    together = persuading.play(settings, (SEED, 3))
    assert persuading.play(settings, (SEED + 1, 1)) == together[1:2]


def test_an_activity_without_persuasion_is_refused_before_any_game(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mine = tmp_path / "mine.toml"
    text = LANTERNS.read_text(encoding="utf-8").replace("persuades = true", "persuades = false")
    mine.write_text(text, encoding="utf-8")
    monkeypatch.setattr(persuading, "group", None)
    with pytest.raises(TangyError, match="nothing that is expected persuades anybody"):
        persuading.run(str(mine), 2, 1, SEED, Where(jobs=1))
    persuading.check(str(LANTERNS))


@pytest.mark.slow
def test_people_who_never_converge_are_counted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(persuading, "LONGEST", 4)
    played = persuading.run("bingo", 4, 2, SEED, Where(jobs=1))
    assert all(0 < len(user["optimal_share"]) < persuading.SHOWN for user in played["users"])
    before = played["suboptimal_before_convergence"]
    assert (before["n"], before["mean"], before["never"]) == (0, None, 8)
    first, *_ = compare({**played, "experiment": 2, "paper": dict(published.SCENARIO_TWO)})
    assert "8 never converged" in first.here
    assert first.words.startswith("Nobody converged here, so there is nothing to compare.")
    assert figures.optimal_shares(played["users"]).startswith("<svg")
    document = {**played, "paper": dict(published.SCENARIO_TWO)}
    assert figures.before_convergence(document).startswith("<svg")


def test_a_run_without_persuasion_ends_with_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(persuading, "LONGEST", 0)
    with pytest.raises(TangyError, match="was never persuaded in 0 games of Bingo"):
        persuading.run("bingo", 4, 1, SEED, Where(jobs=1))


def test_every_method_gets_the_same_answers() -> None:
    crowd = algorithms.CROWDS["even"]
    runs = [
        algorithms.choices(crowd, method, 3, Random(chance), 4, SEED, 200)
        for method, chance in ((Thompson(), 1), (Thompson(), 2), (BayesUcb(), 3))
    ]
    answers: dict[tuple[int, int], bool] = {}
    shared = 0
    for run in runs:
        for time, place, complied in run:
            shared += (time, place) in answers
            assert answers.setdefault((time, place), complied) == complied
    assert shared > 100


@pytest.mark.slow
def test_bayes_ucb_has_less_regret_than_thompson_sampling() -> None:
    def rows(name: str) -> list[list[float]]:
        return algorithms.meet({"strategies": 4, "seed": SEED}, ("even", name, 0, 120))

    thompson, bayes = rows("thompson"), rows("bayes_ucb")
    mean = sum(row[1] for row in thompson) / 120
    assert mean == pytest.approx(6.2, abs=0.9)  # the standard error is .33
    assert sum(row[1] for row in bayes) / 120 <= 0.65 * mean


@pytest.mark.slow
def test_priors_help_for_similar_people_and_forgetting_for_changing_ones() -> None:
    settings = {"strategies": 4, "seed": SEED}

    def mean(crowd: str, name: str, column: int) -> float:
        rows = algorithms.meet(settings, (crowd, name, 0, 60))
        return sum(row[column] for row in rows) / len(rows)

    assert mean("uneven", "bayes_ucb_prior", 1) <= 0.5 * mean("uneven", "thompson", 1)
    after = len(algorithms.HORIZONS) + 1
    assert (
        mean("drifting", "thompson_forgetting", after) > mean("drifting", "thompson", after) + 0.2
    )


def test_every_known_method_is_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    assert list(algorithms.compared()) == list(algorithms.PUBLISHED_COMPARISON)
    monkeypatch.setattr(algorithms, "known_methods", lambda: ("thompson", "bayes-ucb", "turns"))
    assert list(algorithms.compared()) == [*algorithms.PUBLISHED_COMPARISON, "turns"]
    assert algorithms.compared()["turns"].method == "turns"


def test_earlier_people_are_reproducible() -> None:
    met = algorithms.earlier_people("uneven", 4, SEED)
    assert len(met) == algorithms.EARLIER
    assert all(sum(map(sum, counts.values())) == algorithms.MET for counts in met)
    algorithms.earlier_people.cache_clear()
    assert algorithms.earlier_people("uneven", 4, SEED) == met


def test_the_lai_robbins_bound_is_computed() -> None:
    assert algorithms.lai_robbins(0.9, [0.4] * 3) == pytest.approx(1.998, abs=0.001)
    assert algorithms.lai_robbins(0.5, [0.5]) == 0
    assert algorithms.lai_robbins(0.5, [0.0]) == pytest.approx(0.5 / 0.6931, abs=0.001)
