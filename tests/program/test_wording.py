"""Situations, steps, cards and devices in words that a newcomer can act on."""

from __future__ import annotations

import pytest

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Step
from tangy_profiles.health import OK, STALE
from tangy_profiles.robot import load_robot
from tangy_profiles.scene import CardView, Scene
from tangy_profiles.state import FRONT, ActivityState, Situation, UserState
from tangy_tui.monitoring.evidence import STATES, evidence_words
from tangy_tui.text.drills import device_words
from tangy_tui.text.faults import status_words
from tangy_tui.text.situations import addressed_step, card_words, state_words, step_words
from tests.support.declared import declared

NUMBERS = tuple(range(1, 26))


def name(person: str) -> str:
    return {"user1": "Rosa", "user2": "Ken"}.get(person, person)


def state(situation: Situation, place: str = FRONT, attended: str | None = None) -> ActivityState:
    users = (UserState("user1", "occluded", "ANR"), UserState("user2", "occluded", "AR"))
    return ActivityState(0, situation, place, attended, users)


def scene(place: str = FRONT, *requests: str, card: CardView | None = None) -> Scene:
    return Scene(place, requests, {}, (), card)


@pytest.mark.parametrize(
    ("situation", "words"),
    [
        (("start", "ANR", "occluded"), "the game has not begun"),
        (("navigate", "AR", "occluded"), "somebody asks for help"),
        (("help", "AR", "occluded"), "helping: card not in view"),
        (("help", "AR", "missing numbers"), "helping: missed numbers"),
        (("end", "AR", "occluded"), "somebody has won"),
    ],
)
def test_a_situation_is_described_by_its_stage_and_details(
    situation: tuple[str, str, str], words: str, activity: Activity
) -> None:
    triple = next(s for s in activity.situations if s == situation)
    assert activity.in_words(triple) == words


def test_a_step_names_its_behaviour_and_person(activity: Activity) -> None:
    begun = state(Situation("start", "ANR", "occluded"))
    asked = state(Situation("navigate", "AR", "occluded"), attended="user2")
    group = Step("greeting", None, begun, begun)
    one = Step("navigate to user", "user2", asked, asked)
    assert step_words(activity, group, name) == "the game has not begun -> greet everyone"
    assert step_words(activity, one, name) == "somebody asks for help -> go to the user (Ken)"


def test_the_state_lists_requests_in_order(activity: Activity) -> None:
    asked = state(Situation("navigate", "AR", "occluded"), attended="user2")
    assert state_words(activity, asked, scene(FRONT, "user2", "user1"), name) == (
        "Tangy is at the front. Asking for help: Ken, then Rosa."
    )
    nobody = state(Situation("facilitate", "ANR", "occluded"))
    assert state_words(activity, nobody, scene(), name) == (
        "Tangy is at the front. Nobody asks for help."
    )


def test_the_state_beside_a_person_describes_the_card(activity: Activity) -> None:
    beside = state(Situation("help", "AR", "missing numbers"), "user2", "user2")
    card = CardView("user2", NUMBERS, marked=0b0001, called=0b0110)
    told = state_words(activity, beside, scene("user2", "user2", card=card), name)
    assert told.startswith("Tangy is with Ken. Asking for help: Ken. ")
    assert "A called number is not marked." in told
    assert told.endswith("Wrong: B-1. Missed: B-2, B-3.")


def test_the_state_of_a_game_by_facts_uses_the_words_for_its_facts() -> None:
    trivia = declared("trivia")
    waiting = next(s for s in trivia.situations if "under 20 s" in trivia.in_words(s))
    asked = state(waiting)._replace(whom=(("whose turn", "user1"),))
    said = state_words(trivia, asked, scene(), name)
    assert "It is Rosa's turn. For under 20 s, no hint yet." in said
    assert "<" not in said and " is no" not in said


def test_a_correct_card_needs_no_words(activity: Activity) -> None:
    assert card_words(activity, CardView("user1", NUMBERS, 0b111, 0b111)) == ""
    assert card_words(activity, CardView("user1", NUMBERS, 0b101, 0b111)) == "Missed: B-2."
    assert card_words(activity, CardView("user1", NUMBERS, 0b111, 0b011)) == "Wrong: B-3."


def test_a_silent_device_has_the_same_words_everywhere() -> None:
    robot = load_robot()
    device = next(iter(robot.devices.values()))
    told = {
        "evidence": evidence_words({f"{device.name}.state": STALE}, (), robot),
        "status": status_words((STALE, device.label)),
        "drill": device_words([(device.label, STALE), ("another", OK)]),
    }
    assert [place for place, words in told.items() if STATES[STALE] not in words] == []


@pytest.mark.parametrize(
    ("words", "whom", "why", "told"),
    [
        ("go to the user", "Rosa", "", "go to Rosa"),
        (
            "encourage the user",
            "Rosa",
            "helping: all correct",
            "encourage Rosa (helping: all correct)",
        ),
        ("ask to mark numbers", "Rosa", "missed", "ask to mark numbers (Rosa; missed)"),
        ("go to the user", "", "", "go to the user"),
        ("give the player a hint", r"O\1", "", r"give O\1 a hint"),
    ],
)
def test_a_step_names_the_person_in_place_of_the_user(
    words: str, whom: str, why: str, told: str
) -> None:
    assert addressed_step(words, whom, why) == told
