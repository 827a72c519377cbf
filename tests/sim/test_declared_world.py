"""Unclear answers of simulated people: asked again, and never judged."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from tangy_profiles.declared.activity import read_declared
from tangy_profiles.declared.checking import expected_moves
from tangy_profiles.declared.judging import CERTAIN
from tangy_profiles.declared.vocabulary import ASKING, YES
from tangy_profiles.state import Outcome
from tangy_sim.worlds.declared_world import DeclaredWorld
from tests.support.declared import DECLARED, declared
from tests.support.media import guess_the_sound, make_sound

PEOPLE = ("user1", "user2", "user3")


def games(unclear: float, count: int) -> tuple[list[Outcome], int]:
    """Play games as the file expects; return the outcome of each step, and how many games ended."""
    activity, taught = declared("trivia"), expected_moves(declared("trivia"))
    world = DeclaredWorld(activity, PEOPLE, seed=4, unclear=unclear)
    found, ended = list[Outcome](), 0
    for number in range(count):
        if number:
            world.begin()
        while not world.over and len(found) < 400 * count:
            move = taught.move(world.game)
            assert move is not None
            action = activity.action(activity.behaviours[move[0]], move[1], None)
            found.append(world.execute(action))
        ended += world.over
    return found, ended


def test_a_sound_takes_its_duration(tmp_path: Path) -> None:
    activity = read_declared(guess_the_sound(tmp_path))
    seconds = []
    for long in (0.5, 60.5):
        for sound in tmp_path.glob("*.wav"):
            make_sound(sound, long)
        activity = read_declared(tmp_path / activity.source)
        world = DeclaredWorld(activity, PEOPLE, seed=1)
        seconds.append(
            world.execute(
                activity.action(activity.behaviour("play a sound"), PEOPLE[0], None)
            ).seconds
        )
    assert seconds[1] - seconds[0] == pytest.approx(60.0)


@pytest.mark.parametrize("name", DECLARED)
def test_the_spoken_texts_rotate_in_order(name: str) -> None:
    activity, taught = declared(name), expected_moves(declared(name))
    world = DeclaredWorld(activity, activity.teams or PEOPLE, seed=2)
    times, told = Counter[str](), set[str]()
    for _ in range(6):
        world.begin()
        times.clear()
        while not world.over:
            move = taught.move(world.game)
            assert move is not None
            behaviour, whom = move
            done = world.execute(activity.action(activity.behaviours[behaviour], whom, None))
            text = activity.text_in_turn(
                behaviour, activity.plain_strategy, times[behaviour], personal=whom is not None
            )
            times[behaviour] += done.completed
            if said := activity.fill(text, f"\x02{whom}\x03", ()):
                assert said == done.speech
                told.add(text)
    assert len(told) > 3


def test_unclear_answers_are_asked_again_and_games_end() -> None:
    found, ended = games(unclear=0.4, count=10)
    unclear = [one for outcome in found for one in outcome.unclear]
    assert ended == 10
    assert len(unclear) > 10
    assert all(0.0 <= one.certainty < CERTAIN for one in unclear)
    most = declared("trivia").asking.visit
    for outcome in found:
        asked = Counter(one.person for one in outcome.unclear if one.asked_again)
        assert all(times <= most for times in asked.values())


def test_nobody_is_shown_as_asking_after_the_game() -> None:
    world = DeclaredWorld(declared("trivia"), PEOPLE, seed=4)
    world.game.observe(ASKING, PEOPLE[1], YES)
    assert world.scene().requests == (PEOPLE[1],)
    assert world.scene().doing[PEOPLE[1]] == "asks for help"
    world.over = True
    assert world.scene().requests == ()
    assert world.scene().doing[PEOPLE[1]] == "watches"


def test_an_unclear_answer_is_never_judged() -> None:
    activity = declared("trivia")
    world = DeclaredWorld(activity, PEOPLE, seed=4, unclear=1.0)
    taught = expected_moves(activity)
    for _ in range(60):
        move = taught.move(world.game)
        assert move is not None
        world.execute(activity.action(activity.behaviours[move[0]], move[1], None))
        assert not any(fact == "answer" for fact, _ in world.game.values)


def test_clear_answers_give_the_same_games() -> None:
    activity = declared("trivia")
    usual = DeclaredWorld(activity, PEOPLE, seed=4)
    taught = expected_moves(activity)
    found, _ = games(unclear=0.0, count=1)
    for outcome in found:
        move = taught.move(usual.game)
        assert move is not None
        action = activity.action(activity.behaviours[move[0]], move[1], None)
        assert usual.execute(action) == outcome


def test_several_actions_of_a_person_after_a_behaviour_are_listed() -> None:
    activity, several = declared("exercises"), 0
    taught = expected_moves(activity)
    for seed in range(12):
        world = DeclaredWorld(activity, PEOPLE, seed=seed)
        while not world.over:
            move = taught.move(world.game)
            assert move is not None
            before = world.game.copy()
            world.execute(activity.action(activity.behaviours[move[0]], move[1], None))
            for person, did in world.happened.items():
                several += len(did) > 1
                assert world.game.acts[person] - before.acts[person] <= len(did)
                doing = world.scene().doing[person]
                assert all(world.words_of(act) in doing for act in did)
    assert several > 0
