"""Evidence from the execution of a behaviour: counts of refusals and of steps without progress."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tangy_profiles.activity import load_activity
from tangy_profiles.faults import Evidence
from tangy_profiles.health import Fact
from tangy_profiles.robot import load_robot
from tangy_profiles.state import ActivityState, Outcome, Response, Situation, UserState
from tangy_tui.interaction.game_events import Acted
from tangy_tui.learning.effects import Effects
from tangy_tui.learning.policy import Decision
from tangy_tui.monitoring.detection import Detector
from tangy_tui.monitoring.evidence import written

BINGO = load_activity("bingo")
ASKED = UserState("user1", "missing numbers", "AR")
IDLE = UserState("user2", "occluded", "ANR")
HELP = ActivityState(7, Situation("help", "AR", "missing numbers"), "user1", "user1", (ASKED, IDLE))
QUIET = ActivityState(
    7,
    Situation("facilitate", "ANR", "occluded"),
    "front",
    None,
    (UserState("user1", "occluded", "ANR"), IDLE),
)
SURE = Decision("mark numbers", 1.0, (), 1)


@pytest.fixture
def detector() -> Detector:
    return Detector(BINGO, load_robot(), Effects({}))


def acted(
    behaviour: str,
    state: ActivityState,
    response: Response | None = None,
    *,
    changed: bool = False,
    numbers: tuple[int, ...] = (),
    completed: bool = True,
) -> Acted:
    """Make a step: a behaviour in a state, and its outcome."""
    after = state._replace(step=state.step + 1)
    if changed:
        after = after._replace(place="front" if state.place != "front" else "user2")
    action = BINGO.action(BINGO.behaviours[behaviour], state.attended, None)
    outcome = Outcome(completed, 4.0, numbers, response)
    return Acted(1, state, SURE, None, action, outcome, after, "", "", True)


def did(person: str, *, followed: bool, complied: bool = False) -> Response:
    return Response(person, "praise", followed, complied, 3.0)


def evidence(detector: Detector, step: Acted) -> Evidence:
    return detector.compare(step)[0]


def test_consecutive_refusals_are_counted_until_a_success(detector: Detector) -> None:
    no = acted("mark numbers", HELP, did("user1", followed=False), changed=True)
    yes = acted("mark numbers", HELP, did("user1", followed=True, complied=True), changed=True)
    counted = [evidence(detector, step).get("person.refusals") for step in (no, no, yes, no)]
    assert counted == [1, 2, None, 1]


@pytest.mark.parametrize("leaves", ["not", "by itself", "by staff"])
def test_the_limit_of_a_visit_applies_until_the_robot_leaves(
    detector: Detector, leaves: str
) -> None:
    no = acted("mark numbers", HELP, did("user1", followed=False))
    yes = acted("mark numbers", HELP, did("user1", followed=True, complied=True))
    away = acted("navigate to front", HELP, changed=True)
    spent = [evidence(detector, step).get("person.spent") for step in (no, no, yes)]
    if leaves == "by itself":
        detector.compare(away)
    elif leaves == "by staff":
        detector.take_in(away.after)
    spent.append(evidence(detector, no).get("person.spent"))
    assert spent == [None, None, None, True if leaves == "not" else None]


def test_a_refusal_counts_only_for_the_attended_person(detector: Detector) -> None:
    detector.compare(acted("mark numbers", HELP, did("user1", followed=False), changed=True))
    users = (UserState("user1", "occluded", "ANR"), UserState("user2", "occluded", "AR"))
    other = HELP._replace(attended="user2", place="user2", users=users)
    for step in (acted("navigate to user", other), acted("joke", QUIET)):
        assert "person.refusals" not in evidence(detector, step)
    again = acted("navigate to user", HELP, changed=True)
    assert evidence(detector, again).get("person.refusals") == 1


@pytest.mark.parametrize("ends", ["a request is followed", "the game"])
def test_a_person_who_refused_in_a_visit_counts_as_refusing(ends: str) -> None:
    settles = Effects({"move card closer": {"what was asked about": frozenset({"settled"})}})
    detector = Detector(BINGO, load_robot(), settles)
    unseen = (UserState("user1", "occluded", "AR"), IDLE)
    state = HELP._replace(situation=Situation("help", "AR", "occluded"), users=unseen)
    hidden = acted("move card closer", state)

    def unexpected() -> bool:
        behaviour = hidden.action.behaviour
        found = detector.unexpected(behaviour, hidden.state, hidden.outcome, hidden.after)
        return any(one.variable == "what was asked about" for one in found)

    assert unexpected()
    for _ in range(BINGO.asking.visit):
        detector.compare(acted("mark numbers", HELP, did("user1", followed=False), changed=True))
    detector.forgive("user1")
    assert not unexpected()
    if ends == "the game":
        detector.begin()
    else:
        detector.compare(acted("mark numbers", HELP, did("user1", followed=True), changed=True))
    assert unexpected()


def test_a_successful_step_gives_no_evidence(detector: Detector) -> None:
    assert evidence(detector, acted("navigate to user", HELP, changed=True)) == {}


def test_steps_without_a_change_are_counted_until_a_change(detector: Detector) -> None:
    idle, moved = acted("joke", QUIET), acted("joke", QUIET, changed=True)
    steps = (idle, idle, idle, moved, idle)
    counted = [evidence(detector, step).get("visit.fruitless") for step in steps]
    assert counted == [1, 2, 3, None, 1]


def test_a_call_counts_as_progress_without_a_change_of_state(detector: Detector) -> None:
    called = acted("call number", QUIET, numbers=(5,))
    assert evidence(detector, acted("joke", QUIET))["visit.fruitless"] == 1
    assert "visit.fruitless" not in evidence(detector, called)
    assert evidence(detector, acted("joke", QUIET))["visit.fruitless"] == 1, "it begins anew"


def test_a_change_that_is_undone_at_once_counts_as_progress(detector: Detector) -> None:
    idle = acted("joke", QUIET)
    led = replace(idle, outcome=idle.outcome._replace(progress="on"))
    counted = [evidence(detector, step).get("visit.fruitless") for step in (idle, led, idle)]
    assert counted == [1, None, 1]


def test_waiting_for_a_timer_does_not_count_and_a_step_back_does(detector: Detector) -> None:
    moved = acted("joke", QUIET, changed=True)
    waits = replace(moved, outcome=moved.outcome._replace(progress="waits"))
    back = replace(moved, outcome=moved.outcome._replace(progress="back"))
    counted = [evidence(detector, one).get("visit.fruitless") for one in (waits, back, waits, back)]
    assert counted == [None, 1, 1, 2], "a step back counts, although it changed the state"


def test_requested_numbers_do_not_count_as_progress(detector: Detector) -> None:
    asked = acted("mark numbers", HELP, did("user1", followed=True), numbers=(5, 9))
    assert evidence(detector, asked)["visit.fruitless"] == 1


@pytest.mark.parametrize(
    ("response", "word"),
    [
        (None, "none"),
        (did("user1", followed=False), "not followed"),
        (did("user1", followed=True, complied=True), "complied"),
        (did("user1", followed=True), "late"),
    ],
)
def test_the_evidence_describes_the_response_in_a_word(
    detector: Detector, response: Response | None, word: str
) -> None:
    behaviour = "mark numbers" if response is not None else "navigate to user"
    told = evidence(detector, acted(behaviour, HELP, response, completed=response is not None))
    assert told["behaviour.response"] == word
    assert told["behaviour.name"] == behaviour
    assert told["behaviour.effect"] == BINGO.behaviours[behaviour].effect
    assert told["behaviour.completed"] is (response is not None)


def test_a_new_game_resets_the_counts(detector: Detector) -> None:
    refused = acted("mark numbers", HELP, did("user1", followed=False))
    first = evidence(detector, refused)
    assert (first["person.refusals"], first["visit.fruitless"]) == (1, 1)
    detector.begin()
    assert evidence(detector, refused) == first


def test_forgiving_a_person_resets_only_their_count(detector: Detector) -> None:
    one = acted("mark numbers", HELP, did("user1", followed=False), changed=True)
    users = (UserState("user1", "occluded", "ANR"), UserState("user2", "missing numbers", "AR"))
    other = HELP._replace(attended="user2", place="user2", users=users)
    detector.compare(one)
    detector.compare(acted("mark numbers", other, did("user2", followed=False), changed=True))
    detector.forgive("user1")
    detector.forgive(None)
    assert detector.refusals("user1") == {}
    assert detector.refusals("user2") == {"person.refusals": 1}


@pytest.mark.parametrize(
    ("value", "words"),
    [(0.264, "0.26"), (3.84, "3.8"), (25.4, "25"), (99.7, "100"), (3600.0, "3600"), (True, "yes")],
)
def test_a_measured_value_is_written_without_an_exponent(value: Fact, words: str) -> None:
    assert written(value) == words
