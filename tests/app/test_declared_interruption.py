"""A killed game by facts resumes with its facts, live and simulated."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime
from random import Random
from typing import Any, cast

import pytest

from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_client.declared_live_world import DeclaredLiveWorld
from tangy_hw.robot_client.fact_observation import FactObservation
from tangy_profiles.codec import decode, encode
from tangy_profiles.declared.acts import acts, raw
from tangy_profiles.declared.typed_observations import TypedObservation
from tangy_profiles.declared.vocabulary import YES
from tangy_profiles.declared.whom import first_addressee
from tangy_profiles.game_records import GameBeginning, GameChange, GameStep
from tangy_profiles.game_world import LIVE
from tangy_profiles.past_game import NotResumable, PastGame
from tangy_profiles.robot import load_robot
from tangy_profiles.room import load_room
from tangy_profiles.state import ActivityState
from tangy_sim.worlds.declared_world import DeclaredWorld
from tangy_tui.app.staff_view import StaffWatch
from tests.hw.links import FakeLink
from tests.support.declared import DECLARED, declared

PEOPLE = ("user1", "user2", "user3")
SEED = 4
LEFT = ((4, "user1"), (7, "user3"))
"""The number of steps after which each person left."""


def live(name: str, people: tuple[str, ...] = PEOPLE) -> DeclaredLiveWorld:
    return DeclaredLiveWorld(
        declared(name), people, cast(RobotLink, FakeLink(people)), load_robot(), load_room(),
        seed=SEED,
    )  # fmt: skip


def past_of(name: str, steps: list[GameStep]) -> PastGame:
    """Return the game as read from the log."""
    beginning = GameBeginning(game="g", number=1, activity=name, people=PEOPLE, world=LIVE)
    logged = tuple(decode(GameStep, encode(step)) for step in steps)
    return PastGame(beginning, datetime.now(UTC), logged)


def play(world: DeclaredWorld | DeclaredLiveWorld, steps: int, since: int = 0) -> list[GameStep]:
    """Play this many expected steps, and return their log entries."""
    done: list[GameStep] = []
    while not world.over and len(done) < steps:
        state, activity = world.observe(), world.activity
        behaviour = activity.behaviours[activity.expected[state.situation]]
        selector = activity.expected_selector(state.situation)
        whom = dict(state.whom).get(selector or "", first_addressee(behaviour, state))
        world.execute(activity.action(behaviour, whom, None))
        if isinstance(world, DeclaredLiveWorld):
            let_act(world, since + len(done))
        done.append(
            GameStep(
                game="g", behaviour=behaviour.name, target=whom, state=state,
                after=world.observe(),
                memory=world.memory if isinstance(world, DeclaredLiveWorld) else None,
            )
        )  # fmt: skip
    return done


def shown_by(world: DeclaredLiveWorld) -> list[dict[str, Any]]:
    """Return the pictures that the robot was asked to show."""
    done = cast(FakeLink, world.link).done
    return [what["picture"] for do, what in done if do == "perform"]


def let_act(world: DeclaredLiveWorld, step: int) -> None:
    """Let people act, the same at each step of every game."""
    for act in list(acts(world.game.copy(), drawn=Random(f"{step}").random)):
        said = raw(world.game, world.game.declaration.facts[act.fact], act.value)
        world.take(FactObservation(TypedObservation(act.fact, act.who, said), 1.0, "staff"))


def states(steps: list[GameStep]) -> list[tuple[str, str | None, ActivityState | None]]:
    return [(step.behaviour, step.target, step.after) for step in steps]


@pytest.mark.parametrize("name", DECLARED)
@pytest.mark.parametrize("killed_at", [1, 3, 8, 21])
def test_a_resumed_live_game_equals_an_uninterrupted_one(name: str, killed_at: int) -> None:
    whole = live(name)
    whole.begin()
    before = play(whole, killed_at)
    resumed = live(name)
    state = resumed.resume(past_of(name, before))
    assert state == before[-1].after
    assert resumed.game.__dict__.keys() == whole.game.__dict__.keys()
    assert resumed.memory == before[-1].memory == whole.memory
    rest = play(whole, 15, since=killed_at)
    assert rest and states(play(resumed, 15, since=killed_at)) == states(rest)


def test_a_question_that_was_open_is_on_the_chest_screen_and_told_after_a_resume() -> None:
    whole = live("trivia")
    whole.begin()
    before = play(whole, 2)
    question = whole.saying
    while whole.game.value("open", None) != YES:  # it was answered at once
        before += play(whole, 1, since=len(before))
        question = whole.saying
    resumed = live("trivia")
    resumed.resume(past_of("trivia", before))
    (shown,) = shown_by(resumed)
    assert question and resumed.said_before == question
    assert shown["asks"] and shown["text"] and shown in shown_by(whole)
    assert not resumed.saying and not cast(FakeLink, resumed.link).said, "it is not said again"
    play(resumed, 1, since=len(before))
    assert (resumed.said_before, bool(resumed.saying)) == ("", True)


def test_nothing_is_shown_after_a_resume_if_nothing_stayed_on_the_screen() -> None:
    whole = live("trivia")
    whole.begin()
    before = play(whole, 1)  # a welcome
    resumed = live("trivia")
    resumed.resume(past_of("trivia", before))
    assert (resumed.said_before, shown_by(resumed)) == ("", [])


@pytest.mark.parametrize("name", DECLARED)
def test_staff_see_the_same_visits_after_a_resume(name: str) -> None:
    world, watch, steps = live(name), StaffWatch(), list[GameStep]()
    world.begin()
    watch.begin(world.seconds)

    def visited(watch: StaffWatch) -> set[str]:
        view = watch.look(world.scene(), PEOPLE, world.seconds, world)
        return {one.id for one in view.people if one.unvisited is not None}

    seen = visited(watch)
    while not world.over and len(steps) < 12:
        steps += play(world, 1, since=len(steps))
        seen = visited(watch)
    resumed = StaffWatch()
    resumed.resume(world.seconds, past_of(name, steps), world.activity)
    assert any(step.target for step in steps) and visited(resumed) == seen


@pytest.mark.parametrize("name", DECLARED)
def test_a_resumed_simulated_game_equals_an_uninterrupted_one(name: str) -> None:
    whole = DeclaredWorld(declared(name), PEOPLE, seed=SEED)
    before = play(whole, 9)
    resumed = DeclaredWorld(declared(name), PEOPLE, seed=SEED)
    assert resumed.resume(past_of(name, before)) == before[-1].after
    assert states(play(resumed, 15)) == states(play(whole, 15))


@pytest.mark.parametrize("of", ["live", "simulated"])
def test_absent_people_stay_absent_after_a_resume(of: str) -> None:
    name, live_world = "trivia", of == "live"

    def made() -> DeclaredWorld | DeclaredLiveWorld:
        return live(name) if live_world else DeclaredWorld(declared(name), PEOPLE, seed=SEED)

    whole = made()
    whole.begin()
    left = [GameChange(game="g", steps=n, what="left", person=who) for n, who in LEFT]
    before = play(whole, 4)
    whole.change(left[0])
    before += play(whole, 3, since=4)
    whole.change(left[1])
    resumed = made()
    resumed.resume(replace(past_of(name, before), changes=tuple(left)))
    assert resumed.away == whole.away == {who for _, who in LEFT}
    assert resumed.game.here == whole.game.here == ("user2",)
    assert states(play(resumed, 9, since=7)) == states(play(whole, 9, since=7))


@pytest.mark.parametrize("name", [one for one in DECLARED if not declared(one).teams])
@pytest.mark.parametrize("place", [0, 2, None])
def test_a_person_joins_with_nothing_known_of_them(name: str, place: int | None) -> None:
    whole = live(name)
    whole.begin()
    past = past_of(name, play(whole, 6))
    past = past.joined_by("new", declared(name).unread, place)
    assert past == past.joined_by("new", declared(name).unread, place)
    people = past.beginning.people
    joined = live(name, people)
    state = joined.resume(past)
    game, before = joined.game, whole.game
    assert people.index("new") == (len(PEOPLE) if place is None else place)
    assert {*game.players} == {*people} == {user.id for user in state.users}
    assert game.players[game.turn] == before.players[before.turn]
    assert [one for one in game.players if one != "new"] == [*before.players]
    assert [one for one in game.circle if one != "new"] == [*before.circle]
    assert game.acts["new"] == 0 and not any(whose == "new" for _, whose in game.values)
    assert play(joined, 5, since=6)


def test_a_request_survives_a_kill_without_a_sign() -> None:
    world = live("trivia")
    world.begin()
    *_, step = play(world, 2)
    world.tell("user3", "asks")
    asked = replace(step, after=world.observe(), memory=world.memory)
    assert world.game.queue == ["user3"]
    resumed = live("trivia")
    resumed.resume(past_of("trivia", [asked]))
    resumed.commands.wait(10)
    assert [u.id for u in resumed.observe().users if u.request == "AR"] == ["user3"]


def test_a_request_of_staff_after_the_last_step_survives() -> None:
    world = live("trivia")
    world.begin()
    past = past_of("trivia", play(world, 3))
    resumed = live("trivia")
    resumed.resume(replace(past, asked_for=("user2",)))
    assert resumed.game.queue == ["user2"]


def test_a_log_without_facts_or_of_another_activity_is_not_resumed() -> None:
    world = live("trivia")
    world.begin()
    (step,) = play(world, 1)
    for name, last in (("trivia", replace(step, memory=None)), ("exercises", step)):
        with pytest.raises(NotResumable):
            live(name).resume(past_of(name, [last]))
