"""The bench's people follow a game declared by facts from the robot's speech."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_profiles.declared.judging import CERTAIN
from tangy_profiles.declared.speech import with_names
from tangy_profiles.declared.whom import first_addressee
from tangy_profiles.defaults import ASK_AGAIN
from tangy_profiles.person import load_people
from tangy_sim.device_simulator.declared_people import DeclaredPeople
from tangy_sim.device_simulator.declared_reception import DeclaredReception
from tangy_sim.device_simulator.faults import Faults
from tangy_sim.worlds.declared_world import DeclaredWorld
from tests.support.changed import changed_trivia
from tests.support.declared import DECLARED, declared

PEOPLE = load_people(3)
QUESTION = "Which planet do we live on? Mars, Earth or Saturn?"
NAMES = {person.id: person.name for person in PEOPLE}


@pytest.mark.parametrize("name", DECLARED)
@pytest.mark.parametrize("seed", range(3))
def test_people_understand_every_sentence_and_its_item(name: str, seed: int) -> None:
    activity = declared(name)
    world = DeclaredWorld(activity, tuple(NAMES), seed=seed)
    ears = DeclaredReception(activity, PEOPLE)
    heard = 0
    while not world.over:
        state = world.observe()
        behaviour = activity.behaviours[activity.expected[state.situation]]
        selector = activity.expected_selector(state.situation)
        whom = dict(state.whom).get(selector or "", first_addressee(behaviour, state))
        outcome = world.execute(activity.action(behaviour, whom, None))
        found = ears.hear(with_names(outcome.speech, lambda id: NAMES[id]))
        assert found is not None and found.behaviour == behaviour
        assert not found.rows or world.game.row in found.rows
        assert found.person in ("", whom)
        heard += len(found.rows) == 1
    assert heard


def test_people_hold_up_the_letter_of_their_answer_until_the_next_sentence() -> None:
    activity = declared("trivia")
    people = DeclaredPeople(activity, PEOPLE, Faults(), seed=2)
    ears = DeclaredReception(activity, PEOPLE)
    letters, up = set[str](), 0
    for _ in range(30):
        people.begin(people.now)
        assert people.shown == {}
        for text in ("Welcome to the quiz!", f"User 1, question 1: {QUESTION}"):
            found = ears.hear(text)
            assert found is not None
            people.hear(found)
        for _ in range(48):
            people.step(people.now + 0.25)
            assert set(people.shown) <= {"user1"}
            letters.update(people.shown.values())
            up += bool(people.shown)
        found = ears.hear("Take your time.")
        assert found is not None
        people.hear(found)
        people.step(people.now + 1.3)
        assert people.shown == {} and all(sure < CERTAIN for *_, sure in people.game.acts)
    assert letters == {"a", "b"} or letters == {"a", "b", "c"}
    assert up > 100


def test_people_act_only_if_the_game_gives_them_a_reason(tmp_path: Path) -> None:
    by_voice = ('from = ["sign", "speech", "button"]', 'from = ["speech"]')
    activity = changed_trivia(tmp_path, by_voice)
    people = DeclaredPeople(activity, PEOPLE, Faults(), seed=1)
    ears = DeclaredReception(activity, PEOPLE)
    sentences = ("Welcome to the quiz!", QUESTION)
    answered = unclear = 0
    for _ in range(50):
        people.begin(people.now)
        for text in (sentences[0], f"User 1, question 1: {sentences[1]}"):
            assert not people.game.acts
            found = ears.hear(text)
            assert found is not None
            people.hear(found)
            people.step(people.now + 20)
        assert {act[:2] for act in people.game.acts} <= {("answer", "user1")}
        answered += len(people.game.acts)
        clear = [sure for *_, sure in people.game.acts if sure >= CERTAIN]
        assert len(clear) <= 1
        unclear += len(people.game.acts) - len(clear)
        if people.game.acts and not clear:
            asked = ears.hear(ASK_AGAIN[0].replace("{name}", "User 1"))
            assert asked is not None and (asked.again, asked.person) == (True, "user1")
            people.hear(asked)
            people.step(people.now + 20)
            assert len(people.game.acts) == 2
    assert unclear
    assert 5 < answered < 45
