"""A robot without a card camera asks staff about the cards, and asks nobody to move one."""

from __future__ import annotations

from pathlib import Path
from typing import cast

import pytest

from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_hw.robot_client.staff_card_reports import ReportedCard, read_told, reported_card
from tangy_profiles.activity import load_activity
from tangy_profiles.behaviour import Action
from tangy_profiles.robot import load_robot
from tangy_profiles.room import load_room
from tests.hw.links import FakeLink
from tests.support.robots import robot_without

BINGO = load_activity("bingo")
PEOPLE = ("user1", "user2", "user3", "user4")
CALLED = (5, 20, 40)


class Staffed:
    """The world of a robot without a camera, whose staff give the reports in `tells` in turn."""

    def __init__(self, folder: Path) -> None:
        self.link = FakeLink(PEOPLE)
        robot = load_robot(str(robot_without(folder, "camera")))
        self.world = LiveWorld(
            BINGO, PEOPLE, cast(RobotLink, self.link), robot, load_room(), seed=1, pace=0.0
        )
        self.tells: list[str] = []
        self.asked: list[str] = []
        self.link.meanwhile = self._tell
        self.world.begin()

    def _tell(self, do: str, time: float) -> None:
        eyes = self.world.eyes
        if eyes is not None and eyes.asks and do == "wait":
            self.asked.append(eyes.asks)
            if self.tells:
                assert eyes.tell(self.tells.pop(0))

    def do(self, behaviour: str, target: str | None = None) -> object:
        strategy = "neutral" if BINGO.behaviours[behaviour].persuades else None
        action = BINGO.action(BINGO.behaviours[behaviour], target, strategy)
        assert isinstance(action, Action)
        return self.world.execute(action).response

    def visit(self, *tells: str) -> None:
        self.tells = list(tells)
        self.do("greeting")
        self.world.calls.called.extend(CALLED)
        self.link.sign(1)
        self.world.observe()
        self.do("navigate to user", "user1")


@pytest.fixture
def staffed(tmp_path: Path) -> Staffed:
    return Staffed(tmp_path)


def test_the_robot_asks_staff_on_arrival_and_looks_at_no_card(staffed: Staffed) -> None:
    staffed.visit("missed numbers B-5")
    state = staffed.world.observe()
    assert state.situation.user_state == "missing numbers"
    assert set(staffed.asked) == {"user1"}
    assert not [do for do, _ in staffed.link.done if do == "card"]


def test_a_request_names_the_numbers_reported_by_staff_and_ends_with_their_report(
    staffed: Staffed,
) -> None:
    staffed.visit("missed numbers B-5, 20")
    staffed.tells = ["all correct"]
    response = staffed.do("mark numbers", "user1")
    assert "B-5" in staffed.link.said[-1] and "20" in staffed.link.said[-1]
    assert getattr(response, "followed", None) is True
    assert staffed.world.observe().situation.user_state == "correctly marked"


def test_an_unchanged_report_counts_as_not_followed(staffed: Staffed) -> None:
    staffed.visit("wrong marks 7")
    staffed.tells = ["wrong marks B7"]
    assert getattr(staffed.do("remove markers", "user1"), "followed", None) is False


def test_nobody_is_asked_to_move_a_card_without_a_camera(staffed: Staffed) -> None:
    staffed.visit("all correct")
    said = len(staffed.link.said)
    staffed.world.tracker.seen = None  # as after a stop during a question to staff
    staffed.tells = ["bingo"]
    staffed.do("move card closer", "user1")
    assert len(staffed.link.said) == said
    assert staffed.world.observe().situation.user_state == "bingo"


def test_a_stop_ends_the_wait_for_staff(staffed: Staffed) -> None:
    staffed.link.breaks["wait"] = "staff stopped it"
    staffed.visit()
    assert staffed.world.broken
    assert staffed.world.eyes is not None and staffed.world.eyes.asks == ""


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("all correct", ReportedCard("correctly marked")),
        ("Correctly  marked", ReportedCard("correctly marked")),
        ("bingo", ReportedCard("bingo")),
        ("wrong marks B-7, o70", ReportedCard("incorrectly marked", (7, 70))),
        ("missed numbers 5 and 20", ReportedCard("missing numbers", (5, 20))),
        ("wrong marks", None),  # it names no number
        ("wrong marks 5", None),  # 5 was called
        ("missed numbers 7", None),  # 7 was not called
        ("missed numbers 5 and 99", None),
        ("all correct 5", None),
        ("card not in view", None),  # there is no camera
        ("so so", None),
    ],
)
def test_a_report_names_a_state_and_its_numbers(words: str, told: ReportedCard | None) -> None:
    assert read_told(BINGO, words, CALLED) == told


def test_every_offered_phrase_is_understood(staffed: Staffed) -> None:
    eyes = staffed.world.eyes
    assert eyes is not None and eyes.sayable == []
    staffed.visit("all correct")
    eyes.asks = "user1"
    assert len(eyes.sayable) == len(BINGO.card_states)
    assert all(eyes.tell(words) for words in eyes.sayable)


def test_a_report_from_a_card_names_its_state_and_numbers() -> None:
    face = BINGO.deck.deal(iter([i / 60 for i in range(60)]).__next__)
    called = [face[0]]
    assert reported_card(BINGO, called, face, 0).numbers == (face[0],)
    assert reported_card(BINGO, called, face, 0b11).state == "incorrectly marked"


def test_a_robot_with_a_camera_does_not_ask_staff() -> None:
    link = FakeLink(PEOPLE)
    world = LiveWorld(
        BINGO, PEOPLE, cast(RobotLink, link), load_robot(), load_room(), seed=1, pace=0.0
    )
    assert world.eyes is None
