"""Every kind of fault with every behaviour: noticed at once, with the right class and cause.

`tests/bench/faults.py` measures the same over many more seeds.
"""

from __future__ import annotations

import pytest

from tangy_profiles.fault_file import load_faults
from tangy_profiles.health import Fact
from tangy_profiles.robot import load_robot
from tangy_sim.worlds.injection import KINDS
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.interaction.game_events import Acted
from tangy_tui.monitoring.diagnosis import diagnose
from tests.bench import fault_games
from tests.monitoring.conftest import Supervise
from tests.support.games import world_of

WITH_MARKS = ("incorrectly marked", "missing numbers")


def test_a_kidnapped_robot_is_not_diagnosed_as_a_hidden_card() -> None:
    found: dict[str, Fact] = {
        "localisation.fit": 0.55,
        "localisation.spread": 1.6,
        "mismatch.card": "lost from view",
        "mismatch.request": "open",
        "behaviour.effect": "clear wrong marks",
    }
    (told,) = diagnose(load_faults(load_robot()), found)
    assert told.rule.code == "carried-off"


def test_a_closing_without_effect_on_a_correct_card_is_a_stuck_request(
    supervise: Supervise,
) -> None:
    game = supervise(seed=3)
    world, person = world_of(game), game.world.people[0]
    closing = next(b for b in world.activity.behaviours.values() if b.closes == "always")
    world.tracker.ask(person)
    world.tracker.arrive(person)
    world.tracker.seen = world.activity.card_states[-1].name
    action = world.activity.action(closing, person, None)
    assert world.can_show(KINDS["request-stuck"], action)
    assert not world.can_show(KINDS["no-effect"], action)


def test_a_refused_request_cannot_show_a_stuck_sign(
    supervise: Supervise,
) -> None:
    world = world_of(supervise(seed=3))
    person = world.people[0]
    player = world.players[person]
    player.called |= 1  # a number of the card was called, and not marked
    mending = next(
        behaviour
        for behaviour in world.activity.behaviours.values()
        if behaviour.closes == "when correct" and not behaviour.clears_marks
    )
    world.tracker.ask(person)
    world.tracker.arrive(person)
    world.tracker.seen = WITH_MARKS[0]
    action = world.activity.action(mending, person, None)
    assert world.can_show(KINDS["request-stuck"], action)
    world.inject("never-complies")
    world.execute(action)  # the world refuses it
    assert "never-complies" in world.present
    assert not world.can_show(KINDS["request-stuck"], action)


@pytest.mark.slow
def test_a_refusal_after_an_answer_teaches_no_effect(
    supervise: Supervise,
) -> None:
    game = supervise(seed=3)
    game.begin()
    while game.world.observe().situation.user_state not in WITH_MARKS:
        _ = game.begin() if game.over else game.step()
    world_of(game).inject("never-complies")
    game.game.ask("Something is wrong here.", "Say what to do.", "")
    acted = next(
        e for e in go_on_by_script(scripted_controller(game), expert=True) if isinstance(e, Acted)
    )
    assert acted.outcome.response is not None and not acted.outcome.response.followed
    known = game.effects_of(game.policy).values[acted.action.behaviour.name]
    assert known["what was asked about"] == {"settled"}


def test_a_stuck_request_is_diagnosed_beside_a_critical_fault() -> None:
    found: dict[str, Fact] = {
        "stop_button.latched": True,
        "mismatch.request": "open with nothing left",
        "mismatch.what was asked about": "unchanged",
    }
    told = diagnose(load_faults(load_robot()), found)
    assert [diagnosis.rule.code for diagnosis in told] == ["emergency-stop", "request-stuck"]


@pytest.mark.slow
def test_an_answer_teaches_effects_only_for_undemonstrated_behaviours(
    supervise: Supervise,
) -> None:
    game = supervise("request-stuck", seed=3)
    game.begin()
    world = world_of(game)
    while "request-stuck" not in world.present:
        _ = game.begin() if game.over else game.game.step()  # nobody looks
    game.game.ask("Something is wrong here.", "Say what to do.", "")
    go_on_by_script(scripted_controller(game), expert=True)
    known = game.effects_of(game.policy).values
    assert not any("open with nothing left" in one.get("request", ()) for one in known.values())


SETTINGS = {"activity": "bingo", "users": 4}


@pytest.mark.slow
def test_each_kind_of_fault_is_diagnosed_with_every_behaviour() -> None:
    rows = [row for kind in KINDS for row in fault_games.matrix(SETTINGS, (kind, 3, 1))]
    came = fault_games.added(rows, "came")
    assert came > 120, "fewer than half of the kinds and behaviours: the test would mean little"
    assert fault_games.added(rows, "detected") >= 0.99 * came
    assert fault_games.added(rows, "class") == came
    assert fault_games.added(rows, "cause") >= 0.95 * came
    assert fault_games.added(rows, "false") == 0
    assert {row["kind"] for row in rows if row.get("came")} == set(KINDS)


@pytest.mark.slow
def test_low_compliance_does_not_change_the_diagnoses() -> None:
    for kind in ("card-out-of-sight", "never-complies", "no-effect"):
        usual = fault_games.matrix(SETTINGS, (kind, 5, 2))
        assert fault_games.matrix({**SETTINGS, "complies": 0.6}, (kind, 5, 2)) == usual


@pytest.mark.parametrize(
    ("lesson", "games"),
    [(0, 60), (3, 60), *(pytest.param(n, 240, marks=pytest.mark.slow) for n in (0, 3))],
)
def test_correct_games_have_at_most_one_percent_false_alarms(lesson: int, games: int) -> None:
    told = fault_games.alarms({**SETTINGS, "complies": 0.6}, (lesson, 40, games))
    assert told["steps"] > 33 * games
    assert sum(told["codes"].values()) <= 0.01 * told["games"]


@pytest.mark.slow
def test_low_following_is_diagnosed_only_as_refusal() -> None:
    told = fault_games.alarms({**SETTINGS, "follows": 0.6}, (1, 9, 60))
    assert set(told["codes"]) == {"never-complies"}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("critical", "other"),
    [
        ("emergency-stop", "request-stuck"),
        ("link-lost", "requests-silent"),
        ("camera-disconnected", "card-out-of-sight"),
        ("base-stuck", "path-detour"),
        ("laser-disconnected", "no-effect"),
    ],
)
def test_the_critical_one_of_two_faults_is_handled_first(critical: str, other: str) -> None:
    row = fault_games.pairs(SETTINGS, (critical, other, 1, 3))
    assert row["came"] > 0
    assert row["came"] == row["diagnosed"] == row["first"] == row["ended"]


@pytest.mark.slow
def test_games_with_many_faults_end() -> None:
    played = fault_games.crowd(SETTINGS, (4, 20, 0.004))
    assert sum(game["came"] for game in played) >= 60
    assert all(game["ended"] == "to its end" or "halted" in game["ended"] for game in played)
