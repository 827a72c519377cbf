"""A live game declared by facts counts who acts, the answers, and the robot's actions."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_client.declared_live_world import DeclaredLiveWorld
from tangy_hw.robot_client.fact_observation import FactObservation
from tangy_profiles.declared.activity import DeclaredActivity, read_declared
from tangy_profiles.declared.acts import Act, acts, raw
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.model import PAUSE_SECONDS
from tangy_profiles.declared.typed_observations import TypedObservation
from tangy_profiles.defaults import ASK_AGAIN
from tangy_profiles.game_records import GameChange
from tangy_profiles.robot import load_robot
from tangy_profiles.room import load_room
from tangy_profiles.state import Outcome
from tangy_sim.worlds.declared_world import DeclaredWorld
from tests.hw.links import SECONDS, FakeLink
from tests.support.changed import changed_trivia, patient_trivia
from tests.support.declared import DECLARED, declared
from tests.support.media import guess_the_sound

PEOPLE = ("user1", "user2", "user3")
NAMES = {"user1": "Ann", "user2": "Ben", "user3": "Cleo"}


def world_with(activity: DeclaredActivity, link: FakeLink) -> DeclaredLiveWorld:
    robot = cast(RobotLink, link)
    world = DeclaredLiveWorld(
        activity, PEOPLE, robot, load_robot(), load_room(), seed=1, names=NAMES
    )
    world.begin()
    return world


def world_of(link: FakeLink, name: str = "trivia") -> DeclaredLiveWorld:
    return world_with(declared(name), link)


@pytest.fixture
def link() -> FakeLink:
    return FakeLink(PEOPLE)


@pytest.fixture
def world(link: FakeLink) -> DeclaredLiveWorld:
    return world_of(link)


def do(world: DeclaredLiveWorld, name: str, target: str | None = None) -> Outcome:
    activity = world.activity
    return world.execute(activity.action(activity.behaviour(name), target, None))


def asked(world: DeclaredLiveWorld) -> DeclaredLiveWorld:
    do(world, "welcome everyone")
    do(world, "ask question", "user1")
    return world


def right(world: DeclaredLiveWorld) -> str:
    items = world.activity.declaration.items
    return items.value(world.game.row, "right")


def test_people_are_spoken_to_by_their_names(world: DeclaredLiveWorld, link: FakeLink) -> None:
    asked(world)
    assert [text[: text.index(":")] for text in link.said[1:]] == [
        "Ann, question 1",
        "What do you think, Ann",
    ]
    picture, again = [w["picture"] for d, w in link.done if d == "perform" and "Ann" in w["text"]]
    assert again["asks"] == "Seat 1" and "Seat 1" in again["text"]
    assert right(world) in picture["text"] and picture["asks"] == "Seat 1"
    assert "Ann" not in picture["text"]


def test_the_robot_gets_the_picture_and_the_sound_of_an_item(
    link: FakeLink, tmp_path: Path
) -> None:
    activity = read_declared(guess_the_sound(tmp_path))
    world = world_with(activity, link)
    do(world, "play a sound", "user1")
    items, row = activity.declaration.items, world.game.row
    performed = [what for done, what in link.done if done == "perform"]
    assert performed[-1]["sound"] == str(tmp_path / items.value(row, "clip"))
    assert performed[-1]["picture"]["file"] == ""
    do(world, "show what it was", "user1")
    shown = [what for done, what in link.done if done == "perform"][-1]["picture"]
    photo = items.value(row, "photo")
    assert shown["file"] == (str(tmp_path / photo) if photo else "")


def test_a_reported_answer_counts_at_the_next_observation(world: DeclaredLiveWorld) -> None:
    asked(world)
    assert world.tell(None, right(world))
    assert world.observe().stage == "judge"
    assert dict(world.observe().facts)["answer"] == "right"


def test_an_answer_counts_that_staff_report_while_the_question_is_spoken(
    world: DeclaredLiveWorld, link: FakeLink
) -> None:
    do(world, "welcome everyone")
    seen: list[tuple[str, str, bool]] = []

    def answer(what: str, time: float) -> None:
        if what == "perform" and not seen:
            row = world.ahead.row
            said = world.activity.declaration.items.value(row, "right")
            told = world.tell(None, said)
            seen.append((world.saying, world.ahead.stage()[0].name, told is not None))

    link.meanwhile = answer
    do(world, "ask question", "user1")
    ((saying, stage, taken),) = seen
    assert "question 1" in saying, "staff read the question while it is spoken"
    assert stage == "listen", "and not that none is open"
    assert taken
    assert dict(world.observe().facts)["answer"] == "right"
    assert world.ahead is world.game


def test_a_question_that_was_broken_off_is_not_open(
    world: DeclaredLiveWorld, link: FakeLink
) -> None:
    do(world, "welcome everyone")
    link.breaks["perform"] = "stopped"
    do(world, "ask question", "user1")
    assert world.ahead.stage()[0].name == "next"
    assert not world.tell(None, "the right one")


def test_the_scene_words_what_people_do_as_the_file_does(world: DeclaredLiveWorld) -> None:
    asked(world)
    world.tell("user1", right(world))
    world.tell("user2", "help")
    world.observe()
    assert world.scene().doing["user1"] == "it is right"
    assert world.scene().doing["user2"] == "asks for help"


def test_who_got_no_visit_is_shown_as_asking_after_the_game(world: DeclaredLiveWorld) -> None:
    asked(world)
    world.tell("user2", "help")
    world.observe()
    assert world.scene().requests == ("user2",)
    world.over = True
    assert world.scene().requests == ("user2",)
    world.change(GameChange(game="g", steps=0, what="left", person="user2"))
    assert world.scene().requests == ()


def test_an_unknown_answer_is_refused(world: DeclaredLiveWorld) -> None:
    asked(world)
    assert not world.tell("user1", "something else")
    assert world.observe().stage == "listen"


def test_an_uncertain_answer_is_not_judged(world: DeclaredLiveWorld) -> None:
    asked(world)
    world.tell("user1", right(world), certainty=0.5, source="speech")
    assert world.observe().stage == "listen"
    assert world.unsure is not None and world.unsure.told.who == "user1"


def test_an_unclear_answer_is_asked_again_up_to_the_limit(
    world: DeclaredLiveWorld, link: FakeLink
) -> None:
    asked(world)
    left = world.activity.asking.visit - 1  # she left the question itself unanswered

    def meanwhile(what: str, time: float) -> None:
        if what == "wait" and not world.unsure:
            world.tell("user1", right(world), certainty=0.5, source="speech")

    link.meanwhile = meanwhile
    unclear = [one for _ in range(4) for one in do(world, "allow time").unclear]
    assert [one.asked_again for one in unclear].count(True) == left
    assert not unclear[-1].asked_again
    assert {(one.person, one.certainty, one.source) for one in unclear} == {
        ("user1", 0.5, "speech")
    }
    again = [text for text in link.said if text in {one.format(name="Ann") for one in ASK_AGAIN}]
    assert len(again) == left
    pictures = [what["picture"] for done, what in link.done if done == "perform"]
    assert not [one for one in pictures if "Ann" in (one["text"] + one["asks"])], "seats, no names"
    assert not world.may_ask_again("user1") and world.observe().stage == "listen"
    link.meanwhile = lambda what, time: None
    world.tell("user1", right(world))
    assert world.observe().stage == "judge"
    assert world.may_ask_again("user1")


def test_the_pause_ends_with_an_answer(link: FakeLink, tmp_path: Path) -> None:
    world = world_with(patient_trivia(tmp_path), link)
    asked(world)
    began = link.time
    do(world, "allow time")
    assert link.time - began >= PAUSE_SECONDS

    def meanwhile(what: str, time: float) -> None:
        if what == "wait" and world.game.value("answer", "user1") != "right":
            world.tell("user1", right(world))

    link.meanwhile, began = meanwhile, link.time
    do(world, "allow time")
    assert link.time - began < PAUSE_SECONDS


def test_the_pause_is_as_long_as_the_file_says(link: FakeLink, tmp_path: Path) -> None:
    longer = ('[behaviours."allow time"]\n', '[behaviours."allow time"]\npause = 45\n')
    activity = changed_trivia(tmp_path, longer)
    world = world_with(activity, link)
    simulated = DeclaredWorld(activity, PEOPLE, seed=1)
    for name, pause in (("welcome everyone", PAUSE_SECONDS), ("allow time", 45.0)):
        action = activity.action(activity.behaviour(name), None, None)
        words = len(activity.behaviours[name].speech["plain"].split())
        assert world.execute(action).seconds - SECONDS["perform"] == pytest.approx(pause, abs=0.5)
        assert simulated.execute(action).seconds == pytest.approx(1.0 + 0.4 * words + pause)


def test_a_held_up_letter_counts_as_one_answer(world: DeclaredLiveWorld, link: FakeLink) -> None:
    asked(world)
    items, row = world.activity.declaration.items, world.game.row
    letter = next(one for one in "abc" if items.value(row, one) == right(world))
    link.state = replace(link.state, shows=((1, letter, link.time, 0.9),))
    assert dict(world.observe().facts)["answer"] == "right"
    world.game.execute("give hint", "user1")  # withdraws it, while the sign is still up
    assert world.observe().stage == "listen"
    link.state = replace(link.state, shows=())
    world.observe()
    link.state = replace(link.state, shows=((1, letter, link.time, 0.9),))
    assert world.observe().stage == "judge"


def test_an_uncertain_letter_is_asked_again(world: DeclaredLiveWorld, link: FakeLink) -> None:
    asked(world)
    link.state = replace(link.state, shows=((1, "b", link.time, 0.5), (9, "b", link.time, 1.0)))
    assert world.observe().stage == "listen"
    done = do(world, "allow time")
    first = done.unclear[0]
    assert (first.person, first.source, first.asked_again) == ("user1", "sign", True)
    ((seat, letter, since, _), other) = link.state.shows
    link.state = replace(link.state, shows=((seat, letter, since, 0.9), other))
    assert world.observe().stage == "judge"  # now it can be read


def test_letters_count_only_if_the_file_accepts_signs(link: FakeLink, tmp_path: Path) -> None:
    by_voice = ('from = ["sign", "speech", "button"]', 'from = ["speech"]')
    world = asked(world_with(changed_trivia(tmp_path, by_voice), link))
    link.state = replace(link.state, shows=((1, "b", link.time, 1.0),))
    assert world.observe().stage == "listen"


def test_a_raised_sign_is_a_request_until_it_is_answered(
    world: DeclaredLiveWorld, link: FakeLink
) -> None:
    asked(world)
    link.sign(3)
    state = world.observe()
    assert (state.stage, state.attended) == ("repeat", "user3")

    def meanwhile(what: str, time: float) -> None:
        if what == "answered":
            link.sign()

    link.meanwhile = meanwhile
    do(world, "repeat question", "user3")
    assert world.observe().stage == "listen" and world.observe().closed == "user3"


def test_an_interrupted_behaviour_changes_no_fact(world: DeclaredLiveWorld, link: FakeLink) -> None:
    do(world, "welcome everyone")
    before = world.observe()
    link.breaks["perform"] = "emergency stop is pressed"
    outcome = do(world, "ask question", "user1")
    assert not outcome.completed and world.broken
    after = world.observe()
    assert (after.facts, after.situation) == (before.facts, before.situation)
    assert after.step == before.step + 1


def test_a_person_who_joins_after_an_invitation_has_complied(link: FakeLink) -> None:
    world = world_of(link, "exercises")
    do(world, "welcome everyone")
    do(world, "show movement")

    def meanwhile(what: str, time: float) -> None:
        if what == "wait":
            world.tell("user2", "joins")

    link.meanwhile = meanwhile
    response = do(world, "encourage person", "user2").response
    assert response is not None and response.complied and response.person == "user2"


def test_silence_after_an_invitation_is_no_response(link: FakeLink) -> None:
    world = world_of(link, "exercises")
    do(world, "welcome everyone")
    do(world, "show movement")
    assert do(world, "encourage person", "user2").response is None


@pytest.mark.slow
@pytest.mark.parametrize("name", DECLARED)
@given(data=st.data())
def test_the_same_observations_give_the_same_facts_as_in_the_simulated_room(
    name: str, data: Any
) -> None:
    world = world_of(FakeLink(PEOPLE), name)
    game = DeclaredGame(world.activity.declaration, PEOPLE, world.game.order)
    for _ in range(data.draw(st.integers(1, 8), "steps")):
        behaviours = [b for b in world.activity.behaviours if b in game.declaration.behaviours]
        chosen = data.draw(st.sampled_from(behaviours), "behaviour")
        selector = data.draw(st.sampled_from((None, *PEOPLE)), "whom")
        do(world, chosen, selector)
        game.execute(chosen, selector)
        game.now = world.game.now
        if data.draw(st.booleans(), "moves"):
            who, here = data.draw(st.sampled_from(PEOPLE), "who"), data.draw(st.booleans(), "here")
            world.change(GameChange(game="g", steps=0, what="came" if here else "left", person=who))
            game.observe("here", who, "yes" if here else "no")
        could = list(acts(game.copy()))
        if could and not world.over:
            act: Act = data.draw(st.sampled_from(could), "act")
            said = raw(game, game.declaration.facts[act.fact], act.value)
            game.observe(act.fact, act.who, said)
            world.take(FactObservation(TypedObservation(act.fact, act.who, said), 1.0, "staff"))
        world.observe()
        assert (world.game.values, world.game.seen()) == (game.values, game.seen())
        assert (world.game.queue, world.game.here) == (game.queue, game.here)
