"""Supervision: the actions of people on a game, and their limits."""

from __future__ import annotations

from dataclasses import replace
from unittest.mock import Mock

import pytest

from tangy_profiles.errors import StoreError, TangyError
from tangy_profiles.fault_file import load_faults
from tangy_profiles.faults import Remedy
from tangy_profiles.game_records import GameEnding
from tangy_profiles.robot import load_robot
from tangy_sim.worlds import faulty_world
from tangy_sim.worlds.devices import WELL
from tangy_sim.worlds.injection import KINDS
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import DoneOnce
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.accepted import read_accepted, take_back
from tangy_tui.monitoring.fault import read_faults
from tests.monitoring.conftest import Supervise
from tests.support.games import acts, codes, ended, moves, play, until, world_of
from tests.support.staff_lines import play_by_turns


def test_the_log_contains_no_names(
    supervise: Supervise, workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 0.0)
    for person in workspace.people:
        workspace.rename(person, f"Zoe{person.id[-1]}")
    kinds = ("never-complies", "card-out-of-sight", "request-stuck", "path-blocked", "no-effect")
    game = supervise(*kinds, seed=2, asks=False)
    game.recovery.name_of = lambda person: f"Zoe{person[-1]}"
    told: list[str] = []
    for expert in (True, False):
        play(game, expert=expert)
        told += [f.console + "".join(m.speech for m in f.moves) for f in game.faults]
    assert any("Zoe" in words for words in told)
    logged = "".join(str(event.body) for event in workspace.store.events())
    assert "Zoe" not in logged
    read = [f.console + "".join(m.speech for m in f.moves) for f in read_faults(workspace.store)]
    assert read == told


def test_a_failed_write_to_the_log_does_not_prevent_a_halt(
    supervise: Supervise, workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    game = supervise(seed=3)
    game.begin()
    game.step()
    done: list[str] = []
    world = world_of(game)
    recover = world.recover

    def told(remedy: Remedy) -> float:
        done.append(remedy.kind)
        return recover(remedy)

    monkeypatch.setattr(world, "recover", told)
    world.inject("emergency-stop")
    with monkeypatch.context() as full:
        full.setattr(workspace.store, "append", Mock(side_effect=StoreError("The disk is full.")))
        for _ in range(2):
            with pytest.raises(StoreError):
                game.step()
        assert set(done) == {"halt"}
        assert game.steps == 1
    assert codes(game.look()) == ["emergency-stop"]
    assert game.halted is not None


def test_a_fault_during_a_question_precedes_the_answer(
    supervise: Supervise,
) -> None:
    game = supervise("no-effect@1", seed=3)
    game.begin()
    until(game, lambda now: now.question)
    world_of(game).inject("emergency-stop")
    done = game.steps
    behaviour = next(iter(game.world.activity.behaviours.values()))
    assert codes(game.answer(behaviour, None, "Ada")) == ["emergency-stop"]
    assert game.steps == done
    assert game.halted is not None


def test_a_device_without_a_reading_is_silent(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch
) -> None:
    game = supervise("laser-disconnected@2", seed=3)
    game.begin()
    until(game, lambda now: now.halted)
    game.acknowledge("Ada")
    without = tuple(r for r in world_of(game).health() if r.device != "laser")
    monkeypatch.setattr(world_of(game), "health", lambda: without)
    assert moves(game.clear("Ada")) == ["still there"]
    monkeypatch.setattr(world_of(game), "health", lambda: ())
    assert codes(game.look()) == ["link-lost"]


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_an_invalid_age_is_silence(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch, value: float
) -> None:
    game = supervise(seed=3)
    game.begin()
    odd = tuple(r._replace(age=value) if r.device == "camera" else r for r in WELL)
    monkeypatch.setattr(world_of(game), "health", lambda: odd)
    assert codes(game.look()) == ["camera-disconnected"]


def test_a_measurement_of_nan_is_diagnosed_as_a_fault(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch
) -> None:
    game = supervise(seed=3)
    game.begin()
    facts = {"near_share": float("nan"), "variety": 0.3}
    odd = tuple(r._replace(facts=facts) if r.device == "laser" else r for r in WELL)
    monkeypatch.setattr(world_of(game), "health", lambda: odd)
    assert codes(game.look()) == ["laser-unusable"]


def test_an_unexplained_error_cannot_be_cleared_while_it_lasts(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch
) -> None:
    rules = load_faults(load_robot())
    left = tuple(rule for rule in rules.rules if rule.device != "camera")
    game = supervise(seed=3, asks=False)
    game.watch.book = replace(rules, rules=left)
    game.begin()
    odd = tuple(r._replace(state="ERROR") if r.device == "camera" else r for r in WELL)
    monkeypatch.setattr(world_of(game), "health", lambda: odd)
    until(game, lambda now: now.halted)
    assert game.faults[0].code == "unexplained"
    game.acknowledge("Ada")
    assert moves(game.clear("Ada")) == ["still there"]


def test_an_unmendable_fault_reaches_the_expert_and_ends_the_game(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 0.0)
    game = supervise("path-blocked~1", seed=2)
    events = play(game)
    assert {"asked", "halted", "cleared"} <= set(moves(events, "path-blocked"))
    assert len(acts(events)) < 150
    again = supervise("base-stuck~1", seed=2)
    stopped = ended(play(again)).stopped
    assert stopped is not None and stopped.endswith("It was cleared 5 times and came back.")


def test_a_fault_with_a_rule_cannot_be_accepted(supervise: Supervise) -> None:
    game = supervise("camera-frozen@1", seed=4)
    game.begin()
    until(game, lambda now: now.halted)
    assert game.faults[-1].code == "camera-frozen"
    assert not game.acceptable
    assert game.accept("Ada") == []


def test_no_event_is_logged_after_the_end_of_a_game(
    supervise: Supervise, workspace: Workspace
) -> None:
    length = len(acts(play(supervise(seed=3))))
    play(supervise(f"camera-frozen@{length}", f"voice-dead@{length}", seed=3))
    last = list(workspace.store.events())[-1]
    assert last.kind == GameEnding.KIND


@pytest.mark.parametrize("kind", sorted(name for name, kind in KINDS.items() if kind.stops))
def test_a_stopping_fault_interrupts_the_behaviour_and_is_noticed_at_once(
    supervise: Supervise, kind: str
) -> None:
    game = supervise(f"{kind}@1", seed=3)
    (act,) = acts(game.begin() + game.step())
    assert not act.outcome.completed
    assert act.outcome.seconds == faulty_world.NOTICED
    assert [fault.code for fault in game.faults] == [kind]  # and nothing is unexplained
    assert game.halted is game.faults[0]
    ages = [age for key, age in game.halted.evidence.items() if key.endswith(".age")]
    assert all(float(age) <= faulty_world.NOTICED for age in ages)


def test_an_answer_that_contradicts_demonstrations_holds_once(
    workspace: Workspace, learnt: Policy
) -> None:
    game = workspace.supervision(learnt, 3, asks=True, injections=["no-effect@1"])
    game.begin()
    until(game, lambda now: now.question)
    assert game.question is not None
    known = game.question.decision.behaviour
    other = next(b for name, b in game.world.activity.behaviours.items() if name != known)
    events = game.answer(other, None, "Ada")
    assert [e.instead for e in events if isinstance(e, DoneOnce)] == [known]
    assert moves(events)[0] == "taught"
    assert game.policy is learnt
    assert game.policy.decide(game.world.observe().situation).sure


def test_an_accepted_effect_can_be_revoked(workspace: Workspace, learnt: Policy) -> None:
    def unexpected() -> list[str]:
        return codes(play(workspace.supervision(learnt, 4, asks=True, injections=["no-effect@1"])))

    game = workspace.supervision(learnt, 3, asks=True, injections=["no-effect@1"])
    game.begin()
    until(game, lambda now: now.question)
    game.accept("Ada")
    (one,) = read_accepted(workspace.store, workspace.activity.name)
    assert (one.by, one.mismatches[0].variable) == ("Ada", "activity")
    assert unexpected() == []
    with pytest.raises(TangyError, match="choose from 1 to 1"):
        take_back(workspace.store, workspace.activity.name, 2)
    take_back(workspace.store, workspace.activity.name, 1)
    assert read_accepted(workspace.store, workspace.activity.name) == []
    assert unexpected() == ["unexplained"]


def test_excluding_conditions_are_not_shown_as_evidence(supervise: Supervise) -> None:
    game = supervise("camera-frozen@2", seed=3)
    game.begin()
    until(game, lambda now: now.halted)
    assert game.faults[0].why == "head camera: time without a new picture (s): 2 (limit 1)"


def test_no_game_begins_by_lines_after_an_uncleared_fault(supervise: Supervise) -> None:
    game = supervise("link-lost@3", seed=3)
    said = play_by_turns(game, "quit", games=2)
    assert "Tangy begins no other game: nobody has cleared 'Link to the robot lost'." in said
    assert "Game 2 begins." not in said


def test_stop_by_lines_during_a_halt_is_answered(supervise: Supervise) -> None:
    game = supervise("link-lost@3", seed=3)
    said = play_by_turns(game, "stop the bingo", "quit")
    assert any(line.startswith("Tangy stands still. Type: seen") for line in said)
    assert any(line.startswith("STOP: Tangy stands still.") for line in said)
    assert not any("I do not know" in line for line in said)


def test_a_one_time_answer_names_its_author(supervise: Supervise) -> None:
    game = supervise("no-effect@1", seed=3)
    said = play_by_turns(game, "call number", "y")
    (done,) = [line for line in said if line.startswith("2. ")]
    assert done.startswith("2. Call number, as Ada said.")
    assert any(line.startswith("   Done this once: ") for line in said)
