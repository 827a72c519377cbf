"""Scoring of injected faults: each with its result, and totals with intervals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest

from tangy_profiles.fault_file import load_faults
from tangy_profiles.robot import load_robot
from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_sim.worlds.injection import KINDS
from tangy_sim.worlds.injection_log import Injected
from tangy_tui.monitoring.fault import Fault, RecoveryEvent
from tangy_tui.monitoring.scoring import GameScore, score_game, summary
from tests.monitoring.conftest import Supervise
from tests.support.games import play

BOOK = load_faults(load_robot())


def came(kind: str, step: int, shows: int | None = None) -> Injected:
    return Injected(KINDS[kind], step, 10.0 * step, step if shows is None else shows)


def fault(code: str, step: int, *moves: tuple[str, float]) -> Fault:
    told = Fault(
        id=f"{code}{step}", game="g", code=code, critical=False, recovery="continue", step=step,
        seconds=10.0 * step, behaviour="", person=None, called="", texts=("", ""), why="",
        evidence={}, mismatches=(),
    )  # fmt: skip
    for kind, seconds in moves:
        told.add(RecoveryEvent(kind, seconds))  # type: ignore[arg-type]
    return told


def scored(injected: Sequence[Injected], *faults: Fault) -> GameScore:
    return score_game(1, injected, faults, BOOK)


def test_a_correct_diagnosis_is_listed_with_its_times() -> None:
    told = scored([came("voice-dead", 3)], fault("voice-dead", 3, ("went on", 42.0)))
    (one,) = told.injections
    assert (one.step, one.could_show, one.seen, one.named) == (3, 3, 3, 3)
    assert (one.called, one.recovered) == ("voice-dead", 12.0)
    assert told.false_alarms == ()


def test_a_wrong_diagnosis_counts_as_detected_but_not_diagnosed() -> None:
    (one,) = scored([came("camera-frozen", 3)], fault("camera-disconnected", 4)).injections
    assert (one.seen, one.named, one.called) == (4, None, "camera-disconnected")


def test_a_late_correct_diagnosis_keeps_its_detection_time() -> None:
    told = scored([came("camera-frozen", 3)], fault("unexplained", 3), fault("camera-frozen", 5))
    assert (told.injections[0].seen, told.injections[0].named) == (3, 5)
    assert summary([told])["kinds"]["camera-frozen"]["precision"]["share"] == 0


def test_a_missed_fault_counts_only_if_it_could_show() -> None:
    hidden = Injected(KINDS["base-stuck"], 3, 30.0)
    told = summary([scored([came("base-stuck", 3)]), scored([hidden])])
    assert told["recall"]["n"] == 1 and told["recall"]["share"] == 0
    assert told["kinds"]["base-stuck"]["came"] == 2


def test_a_diagnosis_without_an_injection_is_a_false_alarm() -> None:
    told = scored([came("voice-dead", 9)], fault("link-lost", 3), fault("voice-dead", 9))
    assert told.false_alarms == ("link-lost",)
    assert summary([told])["precision"]["share"] == 0.5


def test_a_repeated_diagnosis_is_no_false_alarm() -> None:
    again = scored([came("never-complies", 3)], *(fault("never-complies", n) for n in (5, 9)))
    assert again.false_alarms == () and again.injections[0].named == 5


def test_a_combined_diagnosis_counts_for_both_injections() -> None:
    both = [came("voice-dead", 3), came("screen-dead", 3)]
    told = scored(both, fault("mute", 3))
    assert [one.named for one in told.injections] == [3, 3] and told.false_alarms == ()


def test_intervals_stay_in_range_and_widen_with_few_samples() -> None:
    few = summary([scored([came("voice-dead", 3)], fault("voice-dead", 3))])["recall"]
    many = [scored([came("voice-dead", 3)], fault("voice-dead", 3)) for _ in range(100)]
    low, high = few["interval"]
    assert 0 <= low < summary(many)["recall"]["interval"][0] < high == 1


@pytest.mark.parametrize("kind", sorted(set(KINDS) - {"request-withdrawn"}))
def test_every_injected_fault_is_listed(supervise: Supervise, kind: str) -> None:
    game = supervise(kind, seed=3)
    play(game)
    world = game.world
    assert isinstance(world, FaultyWorld)
    told = score_game(1, world.injection_log.all, game.faults, game.book)
    assert [one.kind for one in told.injections] == [name for _, name in world.came]
    assert all(one.named is not None for one in told.injections if one.could_show is not None)


def test_leaving_a_person_in_peace_about_a_fault_is_no_false_alarm() -> None:
    asked = replace(fault("card-out-of-sight", 3, ("asked", 32.0), ("left", 40.0)), person="user1")
    peace = replace(fault("never-complies", 4), person="user1")
    assert scored([came("card-out-of-sight", 3)], asked, peace).false_alarms == ()
    for other in (replace(peace, person="user2"), replace(peace, seconds=90.0)):
        told = scored([came("card-out-of-sight", 3)], asked, other)
        assert told.false_alarms == ("never-complies",)


@pytest.mark.parametrize(
    ("pair", "hidden"),
    [
        (("card-out-of-sight@4", "never-complies@4"), "card-out-of-sight"),
        (("requests-silent@9", "request-withdrawn@9"), "request-withdrawn"),
    ],
)
def test_a_fault_hidden_by_another_does_not_count_as_visible(
    supervise: Supervise, pair: tuple[str, str], hidden: str
) -> None:
    shown = 0
    for seed in range(1, 7):
        game = supervise(*pair, seed=seed)
        play(game)
        world = game.world
        assert isinstance(world, FaultyWorld)
        score = score_game(1, world.injection_log.all, game.faults, game.book)
        there = [one for one in score.injections if one.could_show is not None]
        assert all(one.named is not None for one in there)
        shown += any(one.kind != hidden for one in there)
    assert shown > 0
