"""Who or what is next, in one or two sentences."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from tangy_tui.app.game_moment import game_moment
from tangy_tui.app.inquiry_grammar import AsksNext, read_question
from tangy_tui.app.workspace import Workspace
from tangy_tui.text import next_up
from tangy_tui.text.answers import answer_to
from tangy_tui.text.decisions import teachers_words
from tangy_tui.text.whose_turn import now_lines
from tests.app.test_interruption import Robot

NAMES = {"user1": "Carl", "user2": "Ida", "user3": "Berta", "user4": "Otto"}


@pytest.fixture
def robot(taught: Path) -> Iterator[Robot]:
    workspace = Workspace(taught)
    for person, name in NAMES.items():
        workspace.rename(workspace.find_person(person), name)
    yield Robot(workspace)
    workspace.close()


def ask(robot: Robot, *people: str) -> None:
    robot.link.sign(*(int(one[-1]) for one in people))
    robot.world.observe()


def answer(robot: Robot) -> list[str]:
    return answer_to(AsksNext(), robot.control, robot.workspace.name).lines


@pytest.mark.parametrize(
    "words",
    [
        *("who is next?", "who's next", "Who comes next", "what happens next?", "what next"),
        *("whose turn is it", "who gets help next", "what does Tangy do next"),
    ],
)
def test_who_is_next_is_a_question_of_its_own(words: str) -> None:
    assert read_question(words, str) == AsksNext()


def test_if_nobody_waits_a_number_is_next(robot: Robot) -> None:
    robot.next(2)
    assert answer(robot) == ["Nobody waits. Tangy calls the next number."]


def test_while_a_number_is_called_nobody_else_is_meant(robot: Robot) -> None:
    robot.next(2)
    moment = replace(game_moment(robot.control), calling="B-9")
    assert next_up.next_lines(robot.world.activity, moment, robot.workspace.name) == [
        "Tangy is calling B-9.",
        "Nobody waits. After that, Tangy calls the next number.",
    ]


def test_the_first_who_waits_is_next(robot: Robot) -> None:
    robot.next(2)
    ask(robot, "user3", "user1")
    assert answer(robot) == ["Carl is next, because Carl has waited longest."]
    robot.next(1)
    assert answer(robot) == [
        "Tangy is with Carl.",
        "After that, Berta is next, because Berta has waited longest.",
    ]


def test_a_number_that_is_being_called_is_not_told_as_the_next_step(robot: Robot) -> None:
    robot.next(2)
    ask(robot, "user3")
    moment = game_moment(robot.control)
    assert moment.decision is not None
    calls = replace(moment.decision, behaviour="call number")
    moment = replace(moment, calling="B-9", decision=calls)
    activity, name = robot.world.activity, robot.workspace.name
    assert now_lines(activity, moment, name)[0] == "Tangy is calling B-9."
    assert next_up.next_lines(activity, moment, name) == [
        "Tangy is calling B-9.",
        "After that, Berta is next, because Berta asked for help.",
    ]


def test_a_game_that_is_over_has_nothing_next(robot: Robot) -> None:
    robot.next(2)
    moment = replace(game_moment(robot.control), holder="over")
    lines = next_up.next_lines(robot.world.activity, moment, robot.workspace.name)
    assert len(lines) == 1 and "over" in lines[0]


def test_a_scripted_teacher_is_named_in_plain_words() -> None:
    assert teachers_words(["Ada", "scripted"]) == "Ada and a ready-made example"
