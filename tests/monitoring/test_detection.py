"""Detection: unexpected effects are noticed at once; a refusal is no fault; old data is stale."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tangy_profiles.activity import load_activity
from tangy_profiles.behaviour import Behaviour
from tangy_profiles.errors import TangyError
from tangy_profiles.faults import Evidence
from tangy_profiles.health import OK, STALE, DeviceState, Reading
from tangy_profiles.robot import load_robot
from tangy_profiles.state import Outcome
from tangy_sim.worlds.devices import WELL
from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_sim.worlds.injection import KINDS, read_injection
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.effects import Effects
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.detection import LATE, Detector, device_evidence, symptoms
from tests.monitoring.conftest import Supervise
from tests.support.games import acts, codes, moves, play, until, world_of


@pytest.fixture
def detector(workspace: Workspace) -> Detector:
    return Detector(workspace.activity, workspace.robot, Effects({}))


def test_a_hidden_card_counts_as_a_refusal_only_after_a_refused_visit(
    workspace: Workspace, supervise: Supervise
) -> None:
    settles = {"what was asked about": frozenset({"settled"})}
    effects = Effects({"move card closer": settles, "encourage": settles})
    detector = Detector(workspace.activity, workspace.robot, effects)
    game = supervise(seed=1)
    game.begin()
    game.step()
    game.step()  # a number was called: the game has begun
    world = world_of(game)
    person, closer = world.people[0], workspace.activity.behaviours["move card closer"]
    world.tracker.ask(person)
    world.tracker.arrive(person)
    hidden = world.observe()
    still_hidden = Outcome(True, 1.0, (), None)

    def told(behaviour: Behaviour = closer) -> bool:
        found = detector.unexpected(behaviour, hidden, still_hidden, hidden)
        return any(one.variable == "what was asked about" for one in found)

    assert told()
    for _ in range(2 * workspace.activity.asking.visit):
        detector.refused(person)
        detector.forgive(person)
    assert told(), "once a visit is no refusal of a whole visit"
    for _ in range(workspace.activity.asking.visit):
        detector.refused(person)
    assert not told()
    detector.forgive(person)  # Tangy gave up on the request
    assert not told()
    encourage = workspace.activity.behaviours["encourage"]
    assert told(encourage), "a refusal explains no behaviour that asks for nothing"


def test_requests_in_a_visit_count_although_one_between_was_followed(
    workspace: Workspace, detector: Detector
) -> None:
    most = workspace.activity.asking.visit
    for _ in range(most - 1):
        detector.refused("user1")
    detector.forgive("user1")  # its card could be seen again
    detector.refused("user2")
    assert "person.spent" not in detector.refusals("user2")
    assert detector.refused("user1") == 1
    assert detector.refusals("user1")["person.spent"]
    detector.forgive("user1")  # left in peace
    detector.refused("user1")
    assert "person.spent" not in detector.refusals("user1")


@pytest.mark.parametrize("device", sorted(load_robot().devices))
def test_a_device_is_stale_above_its_maximum_age(detector: Detector, device: str) -> None:
    allowed = load_robot().devices[device].stale_after
    assert detector.state(Reading(device, allowed)) == "OK"
    assert detector.state(Reading(device, allowed * 1.01)) == "STALE"


def test_an_error_of_a_device_takes_precedence_over_its_age(detector: Detector) -> None:
    assert detector.state(Reading("voice", 60.0, "ERROR")) == "ERROR"


def test_equal_readings_are_evaluated_once(detector: Detector) -> None:
    assert detector.watch(WELL) is detector.watch(WELL)
    assert not symptoms(detector.watch(WELL))


def test_the_worst_state_names_its_cause(detector: Detector) -> None:
    silent = Reading("camera", 9.0)
    assert detector.worst(WELL) == ("OK", "")
    assert detector.worst((*WELL[:6], silent, *WELL[7:])) == ("STALE", "head camera")
    failed = Reading("voice", 0.1, "ERROR")
    assert detector.worst((silent, failed)) == ("ERROR", "voice")


def test_a_faulty_world_without_faults_equals_the_simulated_world(workspace: Workspace) -> None:
    people = [person.id for person in workspace.people]
    plain = SimulatedWorld(workspace.activity, people, seed=5)
    faulty = FaultyWorld(workspace.activity, people, seed=5)
    for _ in range(3):
        while not plain.over:
            state = plain.observe()
            assert faulty.observe() == state
            behaviour = workspace.activity.behaviours[workspace.activity.expected[state.situation]]
            action = workspace.activity.action(behaviour, state.attended, None)
            assert faulty.execute(action) == plain.execute(action)
        plain.begin()
        faulty.begin()


@pytest.mark.slow
def test_correct_games_have_no_fault(supervise: Supervise) -> None:
    game = supervise(seed=11)
    for _ in range(40):
        assert not codes(play(game))
        assert game.status == ("OK", "")


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_every_kind_of_fault_is_noticed_in_its_first_visible_step(
    supervise: Supervise, kind: str
) -> None:
    game = supervise(kind, seed=2)
    play(game)
    assert world_of(game).came, "it never came about"
    step, _ = world_of(game).came[0]
    first = game.faults[0]
    assert first.code == KINDS[kind].code
    assert first.step == step + (2 if kind == "never-complies" else 0)  # after the third refusal


def test_a_single_refusal_is_no_fault(supervise: Supervise) -> None:
    game = supervise("never-complies", seed=2)
    game.begin()
    events = until(game, lambda now: now.faults)
    refused = [a for a in acts(events) if a.outcome.response and not a.outcome.response.followed]
    assert len(refused) == 3
    assert game.faults[0].person == refused[0].state.attended
    assert moves(events, "never-complies") == []
    assert moves(game.step(), "never-complies") == ["remedied", "recovered"]
    assert world_of(game).observe().user(str(game.faults[0].person)).request == "ANR"


def test_a_mismatch_names_variable_expected_and_observed_value(supervise: Supervise) -> None:
    game = supervise("base-stuck", seed=2)
    game.begin()
    until(game, lambda now: now.halted)
    (mismatch, *_) = game.faults[0].mismatches
    assert mismatch.variable == "robot's place"
    assert (mismatch.expected, mismatch.seen) == (("with the person who asked",), "front")
    assert "it is at the front, and should be with the person who asked" in game.faults[0].why


def test_an_injected_fault_is_noticed_at_the_next_look(supervise: Supervise) -> None:
    game = supervise(seed=2)
    game.begin()
    game.step()
    assert game.look() == []
    world_of(game).inject("camera-disconnected")
    assert codes(game.look()) == ["camera-disconnected"]
    assert game.look() == []
    assert game.halted is game.faults[0]


def test_undemonstrated_behaviours_have_no_unexpected_effects(
    workspace: Workspace, learnt: Policy, supervise: Supervise
) -> None:
    game = supervise(seed=2)
    game.detector.effects = Effects({})
    assert not codes(play(game))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("base-stuk", "did you mean 'base-stuck'?"),
        ("base-stuck@0", "a step from 1 on"),
        ("base-stuck@soon", "a step from 1 on"),
        ("base-stuck~2", "a probability above 0"),
        ("base-stuck~nan", "a probability above 0"),
        ("base-stuck~", "a probability above 0"),
        ("", "There is no fault ''"),
        ("\x1b[2J", "There is no fault"),
        ("camera", "choose one of: camera-disconnected, camera-occluded"),
        ("voice", "did you mean 'voice-dead'?"),
    ],
)
def test_an_invalid_injection_is_refused_with_the_reason(text: str, says: str) -> None:
    with pytest.raises(TangyError) as wrong:
        read_injection(text)
    assert says in str(wrong.value)
    assert str(wrong.value).isprintable()


@pytest.mark.parametrize(
    "text", ["base-stuck", "voice-dead@12", "arm-failed~0.25", "voice-dead@recovery"]
)
def test_an_injection_is_written_back_unchanged(text: str) -> None:
    assert str(read_injection(text)) == text


def test_a_game_without_progress_asks_the_teacher(supervise: Supervise) -> None:
    """A policy that tells jokes when it should call numbers: they change no state."""
    game = supervise(seed=2)
    policy = game.policy
    joke = next(b for b in policy.table.values() if b.behaviour == "joke")
    always = {
        situation: joke if decision.behaviour == "call number" else decision
        for situation, decision in policy.table.items()
    }
    game.game.policy = replace(policy, table=always)
    game.begin()
    until(game, lambda now: now.question, most=40)
    assert game.faults[-1].code == "no-progress"
    assert game.steps < 12


def test_names_of_faults_are_read_in_any_case() -> None:
    assert read_injection("Base-Stuck@3").kind is KINDS["base-stuck"]


def test_a_device_silent_just_before_the_link_is_not_blamed() -> None:
    robot = load_robot()

    def of(link: float, laser: float, camera: float = 0.01) -> Evidence:
        ages = {"link": link, "laser": laser, "camera": camera}
        health = tuple(Reading(name, ages.get(name, 0.01)) for name in robot.devices)
        return device_evidence(robot, health)

    lost = robot.devices["link"].lost_after
    assert lost == robot.devices["laser"].lost_after == robot.devices["camera"].lost_after
    assert of(0.03, lost + 0.05)["laser.state"] == STALE  # only the scanner is stale
    assert of(lost - 0.05, lost + 0.05)["laser.state"] != STALE  # its fault comes in a moment
    assert of(0.3, 0.3, lost + 0.25)["camera.state"] == OK  # recent enough at its last report
    assert of(0.3, 0.3, lost + 0.35)["camera.state"] == STALE  # lost before the link was quiet
    assert of(lost - 0.4, lost - 0.4, lost + 0.01)["camera.state"] != STALE  # an older picture
    both = of(lost + 0.01, lost + 0.09)
    assert both["link.state"] == both["laser.state"] == STALE


def test_a_device_that_reports_stale_data_is_believed_on_a_quiet_link() -> None:
    robot = load_robot()
    ages = {"link": robot.devices["link"].lost_after - 0.05}
    health = tuple(
        Reading(name, ages.get(name, 0.01), STALE if name == "laser" else OK)
        for name in robot.devices
    )
    assert device_evidence(robot, health)["laser.state"] == STALE


def test_late_data_is_reported_but_no_symptom() -> None:
    robot = load_robot()
    detector = Detector(load_activity("bingo"), robot, Effects({}))

    def laser(age: float, state: DeviceState = OK) -> tuple[object, tuple[str, str]]:
        health = tuple(
            Reading(name, age if name == "laser" else 0.01, state if name == "laser" else OK)
            for name in robot.devices
        )
        return device_evidence(robot, health)["laser.state"], detector.worst(health)

    assert laser(0.2) == (OK, (OK, ""))
    assert laser(0.3) == laser(0.3, STALE) == (OK, (LATE, "laser scanner"))
    assert laser(1.4) == (OK, (LATE, "laser scanner"))
    assert laser(1.6) == (STALE, (STALE, "laser scanner"))
    assert laser(0.05, STALE) == (STALE, (STALE, "laser scanner"))  # it reports this itself
