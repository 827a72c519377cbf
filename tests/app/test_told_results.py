"""Staff read what became of their report about a person."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_hw.robot_client.declared_live_world import DeclaredLiveWorld
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_tui.app.game_commands import AskFor, Tell
from tangy_tui.app.robot_controls import RobotControls
from tangy_tui.app.staff_notes import DoneKind, StaffNote
from tangy_tui.app.workspace import Workspace
from tangy_tui.text.control import noted_words
from tests.app.test_declared_interruption import live
from tests.app.test_interruption import Robot

NAMES = {"user1": "Rosa", "user2": "Ben", "user3": "Ann"}


@pytest.fixture
def world() -> DeclaredLiveWorld:
    world = live("trivia")
    world.begin()
    return world


@pytest.fixture
def controls(world: DeclaredLiveWorld) -> RobotControls:
    return RobotControls(world, lambda did, **_: None, lambda: False, paced=False)


def _told(controls: RobotControls, person: str | None, words: str) -> str:
    return noted_words(controls.do(Tell(person, words)), NAMES.__getitem__)


def _ask(world: DeclaredLiveWorld) -> None:
    for name, target in (("welcome everyone", None), ("ask question", "user1")):
        world.execute(world.activity.action(world.activity.behaviour(name), target, None))


def test_the_note_says_as_what_an_answer_counts(
    world: DeclaredLiveWorld, controls: RobotControls
) -> None:
    _ask(world)
    assert _told(controls, "user1", "right") == "Rosa: right."
    assert _told(controls, "user1", "answer wrong") == "Rosa: wrong."
    assert _told(controls, "user1", "b").startswith("Rosa: b. That counts as ")
    assert _told(controls, "user1", "b?") == "Rosa: b, but you are not sure. Tangy asks Rosa again."


def test_an_answer_that_nobody_asked_for_is_refused_and_sets_no_fact(
    world: DeclaredLiveWorld, controls: RobotControls
) -> None:
    early = "Tangy is not asking Rosa now, so this does not count: right."
    assert _told(controls, "user1", "right") == early
    _ask(world)
    assert _told(controls, "user2", "right").startswith("Tangy is not asking Ben now")
    assert dict(world.observe().facts)["answer"] == "none"
    assert world.observe().stage == "listen"


def test_a_report_without_a_name_asks_whose_it_is() -> None:
    world = live("exercises")
    world.begin()
    controls = RobotControls(world, lambda did, **_: None, lambda: False, paced=False)
    said = _told(controls, None, "tired")
    assert said == "Who is it? Begin with the name, for example Rosa: tired"
    assert _told(controls, "user2", "tired") == "Ben: tired. Noted."


@pytest.mark.parametrize(
    ("activity", "kind"), [("trivia", "asked to help"), ("bingo", "asked for")]
)
def test_tangy_goes_to_whom_staff_ask_for_only_if_it_visits_people(
    activity: str, kind: DoneKind, taught: Path
) -> None:
    robot: LiveWorld = live("trivia") if activity == "trivia" else Robot(Workspace(taught)).world
    robot.begin()
    controls = RobotControls(robot, lambda did, **_: None, lambda: False, paced=False)
    assert controls.do(AskFor("user2")) == StaffNote(kind, "user2")
