"""Silent people are asked again in the file's words: in the simulator and live alike."""

from __future__ import annotations

from pathlib import Path
from typing import cast

import pytest

from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_client.declared_live_world import LOOK_SECONDS, DeclaredLiveWorld
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.model import PAUSE_SECONDS
from tangy_profiles.declared.silence import SILENCE
from tangy_profiles.errors import ProfileError
from tangy_profiles.person import Person
from tangy_profiles.robot import load_robot
from tangy_profiles.room import load_room
from tangy_profiles.state import Outcome
from tangy_sim.device_simulator.declared_reception import DeclaredReception
from tangy_sim.worlds.declared_world import DeclaredWorld
from tests.hw.links import FakeLink
from tests.support.changed import AGAIN, changed_trivia

PEOPLE = ("user1", "user2")
NAMES = {"user1": "Ann", "user2": "Ben"}
OWN = 'again = ["{name}, do you know it?", "A small hint, {name}: {hint}"]\n'
NEVER = ('turn is yes"], chance = 0.4', 'turn is yes"], chance = 0.0')
ALWAYS = ('turn is yes"], chance = 0.4', 'turn is yes"], chance = 1.0')


@pytest.fixture
def activity(tmp_path: Path) -> DeclaredActivity:
    return changed_trivia(tmp_path, (AGAIN, OWN), NEVER)


def live(activity: DeclaredActivity, link: FakeLink) -> DeclaredLiveWorld:
    named = {"seed": 1, "names": NAMES}
    robot = cast(RobotLink, link)
    world = DeclaredLiveWorld(activity, PEOPLE, robot, load_robot(), load_room(), **named)
    world.begin()
    return world


def ask(world: DeclaredLiveWorld | DeclaredWorld) -> Outcome:
    question = world.activity.behaviour("ask question")
    return world.execute(world.activity.action(question, "user1", None))


def test_a_robot_asks_a_silent_person_again_in_the_words_of_the_file(
    activity: DeclaredActivity,
) -> None:
    link = FakeLink(PEOPLE)
    world = live(activity, link)
    done = ask(world)
    hint = activity.declaration.items.value(world.game.row, "hint")
    assert link.said[-2:] == ["Ann, do you know it?", f"A small hint, Ann: {hint}"]
    assert [(one.person, one.source, one.said) for one in done.unclear] == [
        ("user1", SILENCE, "")
    ] * 2
    more = [ask(world).unclear for _ in range(2)]
    asked = [one.asked_again for unclear in (done.unclear, *more) for one in unclear]
    assert asked == [True] * activity.asking.visit + [False, False]


def test_a_repeated_question_allows_the_whole_pause_at_any_time(
    activity: DeclaredActivity,
) -> None:
    link = FakeLink(PEOPLE)
    world = live(activity, link)
    seen: list[tuple[int, float]] = []  # how many lines Tangy has said, and when
    link.meanwhile = lambda what, time: seen.append((len(link.said), time))
    before = world.observe()
    ask(world)
    last = [time for said, time in seen if said == len(link.said)]
    assert last[-1] - last[0] >= PAUSE_SECONDS - LOOK_SECONDS
    after = dict(world.observe().facts)
    assert dict(before.facts) != after and after["clock"] == ">=20"  # the clock went on meanwhile


def test_a_robot_does_not_ask_a_person_again_after_an_answer(activity: DeclaredActivity) -> None:
    link = FakeLink(PEOPLE)
    world = live(activity, link)

    def answers(what: str, time: float) -> None:
        if what == "wait" and link.said[-1].endswith("?"):
            world.tell("user1", "a")

    link.meanwhile = answers
    assert ask(world).unclear == ()
    assert "do you know it" not in " ".join(link.said)


def test_simulated_people_who_say_nothing_are_asked_again(
    activity: DeclaredActivity, tmp_path: Path
) -> None:
    silent = DeclaredWorld(activity, PEOPLE, seed=1)
    found = [one.asked_again for _ in range(4) for one in ask(silent).unclear]
    assert found == [True] * activity.asking.visit + [False] * 3
    talks = DeclaredWorld(changed_trivia(tmp_path, (AGAIN, OWN), ALWAYS), PEOPLE, seed=1)
    assert ask(talks).unclear == () and talks.game.value("answer", "user1") != "none"


def test_people_on_the_bench_understand_a_repeated_question(
    activity: DeclaredActivity,
) -> None:
    hint = activity.declaration.items.value(0, "hint")
    ears = DeclaredReception(activity, (Person("user1", "Ann"),))
    assert ears.hear("A small hint, Ann: something else") is None
    heard = ears.hear(f"A small hint, Ann: {hint}")
    assert heard is not None and heard.again and heard.person == "user1"


@pytest.mark.parametrize(
    ("again", "problem"),
    [
        ('again = ["{name}, do you now {hnt}?"]', "hint"),
        ('again = ["The next one is for {name}. {ask} {a}, {b} or {c}?"]', "other words"),
    ],
)
def test_an_invalid_wording_for_asking_again_is_refused(
    tmp_path: Path, again: str, problem: str
) -> None:
    with pytest.raises(ProfileError, match=problem):
        changed_trivia(tmp_path, (AGAIN, f"{again}\n"))


def test_a_question_to_the_group_cannot_be_repeated(tmp_path: Path) -> None:
    says = '[behaviours."allow time"]\n'
    with pytest.raises(ProfileError, match="needs a person"):
        changed_trivia(tmp_path, (says, f'{says}again = ["Still there?"]\n'))
