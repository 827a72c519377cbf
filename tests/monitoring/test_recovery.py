"""Recovery: step by step, bounded, the most critical fault first; nothing moves during a halt."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from shutil import copytree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.game_records import (
    EffectAccepted,
    FaultDiagnosed,
    FaultMove,
    GameBeginning,
    GameEnding,
    GameStep,
)
from tangy_profiles.store import Store
from tangy_sim.worlds import faulty_world
from tangy_sim.worlds.injection import KINDS
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Taught
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policy import ForestSettings, Policy, learn_policy
from tangy_tui.monitoring.fault import ENDINGS, OVER, read_faults
from tangy_tui.monitoring.supervision import Supervision
from tests.monitoring.conftest import Supervise
from tests.support.games import acts, codes, ended, moves, play, until, world_of

CRITICAL = ("emergency-stop", "link-lost", "laser-disconnected", "camera-frozen", "base-failed")
EASY = ("voice-dead", "arm-failed", "requests-silent", "laser-occluded", "camera-occluded")


# --------------------------------------------------------------------------------------- halts


@pytest.mark.parametrize("kind", CRITICAL)
def test_a_critical_fault_halts_at_once_and_staff_clear_it(supervise: Supervise, kind: str) -> None:
    game = supervise(f"{kind}@5", seed=3)
    events = game.begin() + until(game, lambda now: now.halted)
    assert len(acts(events)) == 5
    assert game.status == ("HALTED", game.faults[0].name)
    assert game.step() == game.step() == []
    assert game.clear("Ada") == []  # nobody has seen it yet
    assert moves(game.acknowledge("Ada")) == ["acknowledged"]
    assert game.acknowledge("Ada") == []
    assert moves(game.clear("Ada")) == ["still there"]
    assert game.step() == []
    assert moves(game.call_expert("Ada")) == ["expert called"]
    assert moves(game.clear("Ada")) == ["cleared"]
    assert game.halted is None
    assert acts(game.step())
    assert game.faults[0].status == OVER


def test_a_fault_mended_without_the_expert_can_be_cleared(supervise: Supervise) -> None:
    game = supervise("emergency-stop@2", seed=3)
    game.begin()
    until(game, lambda now: now.halted)
    game.acknowledge("Ada")
    world_of(game).lift("emergency-stop")
    assert moves(game.clear("Ada")) == ["cleared"]


def test_an_abandoned_halted_game_gives_its_reason(supervise: Supervise) -> None:
    game = supervise("camera-disconnected@7", seed=3)
    events = play(game, expert=False)
    stopped = ended(events).stopped
    assert stopped is not None and stopped.startswith("Tangy was halted. Head camera silent: ")
    assert game.faults[0].status != OVER
    assert moves(events)[-1] == "given up"


def test_a_fault_in_the_last_step_does_not_delay_the_end(supervise: Supervise) -> None:
    length = len(acts(play(supervise(seed=3))))
    game = supervise(f"voice-dead@{length}", seed=3)
    events = play(game)
    assert codes(events) == ["voice-dead"]
    assert moves(events) == ["left open"]
    assert ended(events).stopped is None
    assert game.halted is None


# ----------------------------------------------------------------------------- the ladder


def test_a_fault_ends_when_a_user_helps(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 1.0)
    game = supervise("path-blocked", seed=3)
    events = play(game)
    assert moves(events) == ["asked", "recovered"]
    asked = game.faults[0].moves[0]
    assert asked.speech == "I cannot get through. Could somebody please move what stands in my way?"
    assert asked.image == "Please move the obstacle"


def test_users_who_do_not_help_are_asked_three_times_before_the_expert(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 0.0)
    game = supervise("path-blocked", seed=3)
    events = play(game)
    assert moves(events) == [
        "asked", "asked", "asked", "escalated",
        "halted", "acknowledged", "expert called", "cleared",
    ]  # fmt: skip
    assert [move.attempt for move in game.faults[0].moves[:3]] == [1, 2, 3]
    assert game.faults[0].ladder == ("user", "expert")


def test_a_stuck_request_is_finally_set_aside(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 0.0)
    game = supervise("request-stuck", seed=2)
    assert moves(play(game)) == ["asked", "asked", "escalated", "remedied", "recovered"]
    assert game.faults[0].ladder == ("user", "continue")


def test_a_tolerated_fault_is_reported_once_until_it_ends(supervise: Supervise) -> None:
    game = supervise("requests-silent@4", seed=3)
    game.begin()
    until(game, lambda now: now.faults and now.faults[0].status == "borne")
    assert game.status == ("WARN", "Request sensor silent")
    told = [event for _ in range(10) for event in game.step()]
    assert not codes(told)
    assert acts(told)
    world_of(game).lift("requests-silent")
    assert moves(game.look()) == ["ended"]
    assert game.status == ("OK", "")


def test_spoken_requests_work_while_the_request_sensor_is_silent(supervise: Supervise) -> None:
    visits = sum(a.action.behaviour.visits for a in acts(play(supervise(seed=3))))
    silent = acts(play(supervise("requests-silent@3", seed=3)))
    assert visits
    assert sum(act.action.behaviour.visits for act in silent) >= visits - 1


def test_the_expert_is_asked_without_a_teacher(supervise: Supervise) -> None:
    game = supervise("no-effect", seed=3, asks=False)
    assert moves(play(game)) == [
        "escalated", "halted", "acknowledged", "expert called", "cleared",
    ]  # fmt: skip


def test_a_repeated_fault_is_not_asked_for_ever(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 1.0)
    game = supervise("card-out-of-sight~1", seed=3)
    asked: list[str] = []
    events = game.begin()
    while not game.over and len(events) < 2_000:
        asked += moves(events)
        events = game.give_up() if game.halted or game.question else game.step()
    assert game.over
    person = [fault.person for fault in game.faults]
    assert max(person.count(one) for one in person) <= 4


# ---------------------------------------------------------------------- two faults at once


@pytest.mark.parametrize("other", EASY)
@pytest.mark.parametrize("critical", CRITICAL[::2])
def test_a_critical_fault_is_handled_before_a_simultaneous_one(
    supervise: Supervise, critical: str, other: str
) -> None:
    hidden = critical == "link-lost" or {critical, other} == {
        "laser-disconnected",
        "laser-occluded",
    }
    game = supervise(f"{other}@6", f"{critical}@6", seed=3)
    game.begin()
    until(game, lambda now: now.halted)
    assert game.halted is not None and game.halted.code == critical
    kept = [fault for fault in game.faults if fault is not game.halted]
    assert [fault.code for fault in kept] == ([] if hidden else [other])
    assert all([move.kind for move in fault.moves] == ["kept"] for fault in kept)
    events = game.call_expert("Ada") + game.clear("Ada")
    assert "cleared" in moves(events, critical)
    until(game, lambda now: all(fault.status != "open" for fault in now.faults) or now.halted)
    assert other in [fault.code for fault in game.faults]


def test_a_critical_fault_during_the_recovery_of_another_comes_first(
    supervise: Supervise, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(faulty_world, "HELPS", 0.0)
    game = supervise("path-blocked", "laser-disconnected@recovery", seed=3)
    game.begin()
    until(game, lambda now: now.halted)
    assert game.halted is not None and game.halted.code == "laser-disconnected"
    assert [move.kind for move in game.faults[0].moves] == ["asked", "kept"]
    game.call_expert("Ada")
    game.clear("Ada")
    assert moves(game.step(), "path-blocked") == ["asked"]


def test_a_critical_fault_interrupts_a_question_to_the_teacher(supervise: Supervise) -> None:
    game = supervise("no-effect", seed=3)
    game.begin()
    until(game, lambda now: now.question)
    world_of(game).inject("emergency-stop")
    assert codes(game.look()) == ["emergency-stop"]
    assert game.question is None and game.halted is not None
    game.call_expert("Ada")
    game.clear("Ada")
    until(game, lambda now: now.question)
    assert game.question is not None


# ------------------------------------------------------------------------------ the teacher


def test_an_answer_of_the_teacher_resumes_the_game(workspace: Workspace, learnt: Policy) -> None:
    game = workspace.supervision(learnt, 3, asks=True, injections=["no-effect@1"])
    events = play(game)
    assert moves(events) == ["teacher asked", "taught"]
    assert any(isinstance(event, Taught) for event in events)
    assert game.policy.digest != learnt.digest
    assert ended(events).stopped is None


def test_an_effect_accepted_by_the_teacher_is_expected_afterwards(
    workspace: Workspace, learnt: Policy
) -> None:
    game = workspace.supervision(learnt, 3, asks=True, injections=["no-effect@1"])
    game.begin()
    until(game, lambda now: now.question)
    assert game.acceptable
    assert moves(game.accept("Ada")) == ["accepted"]
    assert game.question is None
    assert game.policy.digest == learnt.digest
    assert next(workspace.store.events(EffectAccepted)).body["by"] == "Ada"
    again = workspace.supervision(learnt, 4, asks=True, injections=["no-effect@1"])
    assert not codes(play(again))


def test_an_explained_fault_cannot_be_accepted(supervise: Supervise) -> None:
    game = supervise("base-stuck", seed=3)
    game.begin()
    until(game, lambda now: now.halted)
    assert not game.acceptable
    assert game.accept("Ada") == []


# ----------------------------------------------------------------------------------- laws


def check_log(store: Store) -> None:
    """Nothing is executed between a halt and its end; every game ends; attempts are few."""
    halted: set[str] = set()
    going: set[str] = set()
    for event in store.events(GameBeginning, GameStep, GameEnding, FaultDiagnosed, FaultMove):
        game = event.body["game"]
        if event.kind == GameBeginning.KIND:
            going.add(game)
        else:
            assert game in going, "something was logged of a game after its end"
        if event.kind == GameEnding.KIND:
            going.discard(game)
            halted.discard(game)
        elif event.kind == GameStep.KIND:
            assert game in going
            assert game not in halted, "a step after a halt that nobody cleared"
        elif event.kind == FaultMove.KIND and event.body["kind"] == "halted":
            halted.add(game)
        elif event.kind == FaultMove.KIND and event.body["kind"] == "cleared":
            halted.discard(game)
    assert not going
    for fault in read_faults(store):
        kinds = [move.kind for move in fault.moves]
        assert len(kinds) <= 25
        assert sum(kind in ENDINGS for kind in kinds) <= 1
        assert kinds.count("escalated") <= 2
        assert all(move.attempt <= 3 for move in fault.moves)
        times = [fault.seconds, *(move.seconds for move in fault.moves)]
        assert times == sorted(times)


@pytest.fixture(scope="module")
def small_policy(_taught: Path, tmp_path_factory: pytest.TempPathFactory) -> Policy:
    """The same demonstrations, learnt by few trees, so that answers are learnt at once."""
    workspace = Workspace(Path(copytree(_taught, tmp_path_factory.mktemp("small") / "data")))
    with closing(workspace):
        shown = read_library(workspace.store, workspace.activity.name).finished
        return learn_policy(workspace.activity, shown, settings=ForestSettings(trees=5))


injections = st.lists(
    st.builds(
        lambda kind, when: f"{kind}{when}",
        st.sampled_from(sorted(KINDS)),
        st.one_of(
            st.integers(1, 70).map(lambda step: f"@{step}"),
            st.just(""),
            st.just("@recovery"),
            st.sampled_from(["~0.02", "~0.2", "~1"]),
        ),
    ),
    max_size=8,
)


@pytest.mark.slow
@given(injections, st.integers(0, 10_000), st.booleans(), st.booleans())
def test_every_game_ends_and_no_behaviour_runs_during_a_halt(
    small_policy: Policy,
    _taught: Path,
    tmp_path_factory: pytest.TempPathFactory,
    injected: list[str],
    seed: int,
    asks: bool,
    expert: bool,
) -> None:
    workspace = Workspace(Path(copytree(_taught, tmp_path_factory.mktemp("law") / "data")))
    policy = small_policy
    with closing(workspace), workspace.store.transaction():
        game = workspace.supervision(policy, seed, asks=asks, injections=injected)
        events = play(game, expert=expert)
        stopped = ended(events).stopped
        last = acts(events)[-1].action.behaviour if acts(events) else None
        assert stopped or (last is not None and last.ends)
        told = [fault.document() for fault in game.faults]
        kept = [f.document() for f in read_faults(workspace.store, game.game.game)]
        assert kept == told  # the log is the truth
        check_log(workspace.store)


@pytest.mark.slow
def test_twenty_games_full_of_faults_all_end(supervise: Supervise, workspace: Workspace) -> None:
    game: Supervision = supervise(*(f"{kind}~0.004" for kind in sorted(KINDS)), seed=8)
    faults = 0
    for _ in range(20):
        events = play(game)
        faults += len(codes(events))
        assert ended(events).stopped is None or "halted" in str(ended(events).stopped)
    assert faults >= 60
    check_log(workspace.store)


def closing_step(supervise: Supervise) -> tuple[int, int]:
    """Return a seed, and a step of its game that closes a request without a need."""
    for seed in range(20):
        for done in acts(play(supervise(seed=seed))):
            if done.action.behaviour.name == "encourage":
                return seed, done.number
    raise AssertionError("Nobody was encouraged.")


@pytest.mark.slow
@pytest.mark.parametrize("kind", [kind.name for kind in KINDS.values() if kind.stops])
def test_an_interrupting_fault_explains_the_missing_effect(supervise: Supervise, kind: str) -> None:
    seed, step = closing_step(supervise)
    told = play(supervise(f"{kind}@{step}", seed=seed))
    assert codes(told) == [KINDS[kind].code]
    assert ended(told).stopped is None


def waiting(supervise: Supervise, some: int) -> Supervision:
    """Play until some people wait for help, and Tangy is with none of them."""
    for seed in range(60):
        game = supervise(seed=seed)
        game.begin()
        tracker = world_of(game).tracker
        while not game.over and (len(tracker.queue) < some or tracker.place in tracker.queue):
            game.step()
        if not game.over:
            return game
    raise AssertionError(f"Never did {some} people wait.")


def test_a_withdrawn_request_is_noted_and_the_game_continues(
    supervise: Supervise, workspace: Workspace
) -> None:
    game = waiting(supervise, 2)
    person = world_of(game).tracker.queue.pop()
    told = game.step()
    assert codes(told) == ["request-withdrawn"] and moves(told) == ["recovered"]
    assert (game.question, game.halted, game.waiting) == (None, None, [])
    (kept,) = [one for one in read_faults(workspace.store) if one.code == "request-withdrawn"]
    assert (kept.person, kept.status) == (person, OVER)
    assert not any(move.speech for move in kept.moves)
    assert game.detector.refusals(person) == {}


def test_the_only_waiting_person_may_withdraw(supervise: Supervise) -> None:
    game = waiting(supervise, 1)
    tracker = world_of(game).tracker
    (person,) = tracker.queue
    tracker.queue.clear()
    assert codes(game.step()) == ["request-withdrawn"]
    assert game.faults[-1].person == person and game.question is None


def test_staff_are_asked_if_all_requests_vanish_at_once(supervise: Supervise) -> None:
    game = waiting(supervise, 2)
    world_of(game).tracker.queue.clear()
    assert codes(game.step()) == ["unexplained"]
    assert game.faults[-1].person is None
    game.step()
    assert game.question is not None
