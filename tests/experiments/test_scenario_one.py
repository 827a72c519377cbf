"""Scenario 1: demonstrations needed, styles of teaching, and mistakes of teachers."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from itertools import islice
from random import Random

import pytest

from tangy_profiles.state import FRONT
from tangy_tui.experiments import incremental, mistakes, teachers
from tangy_tui.experiments.classroom import GUIDED, RANDOM, SEED_SPACE, Course, activity_of, taught
from tangy_tui.experiments.estimates import share_interval, summary
from tangy_tui.experiments.styles import STYLES, StyledTeacher, anybody, by_seat, last_come, nearest
from tangy_tui.learning.teaching_session import TeachingSession

SETTINGS = {"activity": "bingo", "most": incremental.MOST_GAMES}
SEATS = ("a", "b", "c", "d")


@pytest.mark.parametrize("users", range(1, 9))
def test_one_guided_demonstration_is_enough_for_one_to_eight_people(users: int) -> None:
    done = incremental.until_exact(SETTINGS, (GUIDED, users, 7000 + users))
    assert done["games"] == 1
    assert done["flags"] == [[0, 0, 11, 0]]


@pytest.mark.slow
def test_random_games_need_a_few_demonstrations_and_flag_wrong_decisions() -> None:
    done = [incremental.until_exact(SETTINGS, (RANDOM, 4, 7000 + seed)) for seed in range(8)]
    games = [one["games"] for one in done]
    assert all(games)
    assert 1 < max(games) <= 6
    for one in done:
        assert len(one["behaviours"]) == len(one["flags"]) == one["games"]
        assert one["flags"][-1] == [0, 0, 11, 0]
        assert all(wrong == flagged for wrong, flagged, _, _ in one["flags"])
    flags = incremental.flagged_shares([flag for one in done for flag in one["flags"]])
    assert flags["wrong"] > 0
    assert flags["wrong_flagged"] == 1
    assert flags["right_flagged"] <= 0.01


@pytest.mark.slow
def test_a_repeated_run_gives_the_same_result() -> None:
    case = (RANDOM, 4, 7100)
    assert incremental.until_exact(SETTINGS, case) == incremental.until_exact(SETTINGS, case)
    taught_again = [teachers.teach(SETTINGS, (4, 7100)) for _ in range(2)]
    assert taught_again[0] == taught_again[1]


@pytest.mark.slow
@pytest.mark.parametrize("place", ["commonest", "rarest", "anywhere"])
def test_wrong_answers_are_found_and_resolved(place: str) -> None:
    for seed in range(3):
        done = mistakes.with_mistakes(SETTINGS, (0.03, place, 7200 + seed))
        assert done["wrong"] == round(0.03 * done["steps"])
        assert done["found"] == done["contradicted"] > 0
        wrong, flagged, _, _ = done["flags_before"]
        if not done["silent"]:
            assert wrong == flagged
            assert done["wrong_in_conflict"] == done["wrong"]
            assert done["exact_after"]
            assert done["flags_after"] == [0, 0, 11, 0]
    if place != "anywhere":
        assert not done["silent"]


def test_wrong_answers_are_placed_as_specified() -> None:
    activity = activity_of("bingo")
    shown = list(islice(taught(Course("bingo", 4, RANDOM, 7300)), 3))
    steps = {step.id: step for one in shown for step in one.steps}
    often = Counter(step.state.situation for step in steps.values())
    ((commonest, _),) = often.most_common(1)
    chosen = mistakes.places(activity, shown, 0.03, "commonest", Random(1))
    assert {steps[id].state.situation for id in chosen} == {commonest}
    chosen = mistakes.places(activity, shown, 0.03, "rarest", Random(1))
    assert len(chosen) == round(0.03 * len(steps))
    spoilt = Counter(steps[id].state.situation for id in chosen)
    assert all(count < often[situation] for situation, count in spoilt.items())
    assert commonest not in spoilt


# ---------------------------------------------------------------------------------- teachers


def test_each_style_of_teaching_chooses_whom_to_visit_first() -> None:
    asking, rng = ("c", "a", "d"), Random(1)
    assert last_come(asking, SEATS, FRONT, rng) == "d"
    assert by_seat(asking, SEATS, FRONT, rng) == "a"
    assert nearest(asking, SEATS, FRONT, rng) == "c"
    assert nearest(asking, SEATS, "b", rng) == "a"
    assert {anybody(asking, SEATS, FRONT, rng) for _ in range(50)} == set(asking)


def test_no_two_parts_and_no_two_seeds_share_a_game(monkeypatch: pytest.MonkeyPatch) -> None:
    class Begun(Exception):
        """Raised instead of teaching a course."""

    def begin(course: Course, *_: object) -> None:
        raise Begun(course.seed)

    for module in (incremental, mistakes, teachers):
        monkeypatch.setattr(module, "taught", begin)
    courses = []
    for seed in (s * SEED_SPACE + n for s in (0, 1, 25, 100) for n in (0, 1, 9, SEED_SPACE - 1)):
        for piece, case in (
            (incremental.until_exact, (RANDOM, 4, seed)),
            (mistakes.with_mistakes, (0.01, "anywhere", seed)),
            *((teachers.teach, (place, seed)) for place in range(len(STYLES))),
        ):
            with pytest.raises(Begun) as begun:
                piece(SETTINGS, case)
            courses.append(begun.value.args[0])
    assert len(courses) == len(set(courses)) == 16 * 7


@pytest.mark.slow
def test_different_styles_of_teaching_give_the_same_policy() -> None:
    done = [teachers.teach(SETTINGS, (place, 7400)) for place in range(len(STYLES))]
    assert len({tuple(one["behaviours"]) for one in done}) == len(STYLES)
    assert {one["end"]["policy"] for one in done} == {done[0]["end"]["policy"]}
    assert all(one["end"]["exact"] for one in done)
    hasty = done[-1]["mistakes"]
    assert hasty["made"] > hasty["noticed"] + hasty["mended"] >= 1
    assert done[0]["mistakes"] == {"made": 0, "noticed": 0, "mended": 0, "kept": 0}


def test_a_noticed_mistake_leaves_no_trace() -> None:
    careful = replace(STYLES[1], mistakes=0.2, mends=1.0)
    made: list[StyledTeacher] = []

    def make(teaching: TeachingSession) -> StyledTeacher:
        made.append(StyledTeacher(careful, teaching, 7500))
        return made[0]

    activity = activity_of("bingo")
    shown = list(islice(taught(Course("bingo", 4, RANDOM, 7500), make), 3))
    assert made[0].made > 0
    assert teachers.wrong_steps(activity, shown) == 0


# --------------------------------------------------------------------------------- estimates


def test_estimates_include_their_uncertainty() -> None:
    assert summary([1, 2, 3]) == {"n": 3, "mean": 2, "sd": 1, "se": pytest.approx(3**-0.5)}
    assert summary([])["mean"] is None
    low, high = share_interval(0.95, 100)
    assert [low, high] == pytest.approx([0.888, 0.978], abs=0.002)
    for n in range(1, 200):
        assert share_interval(1.0, n)[1] == 1
        assert share_interval(0.0, n)[0] == 0
