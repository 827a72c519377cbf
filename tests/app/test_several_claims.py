"""Several claims at once: the win stays in view, and the group is not told to play on before it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tangy_tui.app.claim_controls import joined
from tangy_tui.app.game_commands import ClaimCard
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.workspace import Workspace
from tangy_tui.text.control import CELEBRATES_FIRST, CHECKS_OTHERS, noted_words
from tangy_tui.ui.screens.play_view import ViewSource, news_line
from tests.app.test_interruption import Robot

WINS = "Card 17 (user2) wins."


@pytest.fixture
def robot(taught: Path) -> Iterator[Robot]:
    robot = Robot(Workspace(taught))
    robot.next(3)
    numbers = robot.world.numbers_on(17)
    assert numbers is not None
    robot.world.called.extend(n for n in numbers if n not in robot.world.called)
    yield robot
    robot.workspace.close()


@pytest.fixture
def announced(robot: Robot, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    announced = list[str]()
    monkeypatch.setattr(robot.world, "announce", announced.append)
    return announced


def claim(robot: Robot, card: int, person: str) -> StaffNote:
    note = robot.control.apply(ClaimCard(card, person))[0]
    assert isinstance(note, StaffNote)
    return note


def news(robot: Robot) -> str:
    return news_line(ViewSource(robot.world, robot.control, str))


def test_a_claim_that_wins_stays_before_those_that_do_not(
    robot: Robot, announced: list[str]
) -> None:
    claim(robot, 17, "user2")
    robot.control.plan.say_early(ClaimCard(18, "user3"))  # while Tangy carries out its step
    wins = f"{WINS} Tangy goes there next."
    assert news(robot) == f"{wins} Card 18 (user3) does not win yet. {CELEBRATES_FIRST}"
    claim(robot, 18, "user3")
    claim(robot, 19, "user1")
    assert news(robot) == f"{wins} Card 19 (user1) does not win yet."
    robot.link.time += 1000.0
    assert news(robot) == wins
    robot.control.supervision.game.change("played on", person="user2", by="")
    assert news(robot) == ""


def test_a_win_is_news_before_tangy_has_told_it(robot: Robot) -> None:
    plan = robot.control.plan
    plan.say_early(ClaimCard(17, "user2"))
    plan.say_early(ClaimCard(18, "user3"))
    assert news(robot).startswith(WINS)
    plan.forget_early(ClaimCard(17, "user2"))  # it was refused in its turn
    assert "17" not in news(robot)


def test_the_group_hears_of_wrong_cards_after_the_celebration(
    robot: Robot, announced: list[str]
) -> None:
    claim(robot, 18, "user3")
    claim(robot, 17, "user2")
    del announced[:]
    note = claim(robot, 19, "user1")
    assert noted_words(note, str) == f"Card 19 (user1) does not win yet. {CELEBRATES_FIRST}"
    claim(robot, 20, "user4")
    robot.control.plan.tell_left()
    assert announced == []
    robot.control.supervision.game.change("played on", person="user2", by="")
    del announced[:]
    robot.control.plan.tell_left()
    said = "Card 19 does not win yet. Card 20 does not win yet. Let us play on."
    assert announced == [said]
    (told,) = robot.control.plan.late_notes()
    assert noted_words(told, str) == f"Tangy tells everybody: {said}"
    robot.control.plan.tell_left()
    assert announced == [said]


def test_the_group_hears_once_of_claims_that_wait_together(
    robot: Robot, announced: list[str]
) -> None:
    cards = {19: "user1", 18: "user3", 20: "user4"}
    claims = [ClaimCard(card, person) for card, person in cards.items()]
    for one in claims:
        robot.control.plan.say_early(one)  # while Tangy carries out its step
    notes = [robot.control.plan.do(one)[0] for one in claims]
    said = "".join(f"Card {card} does not win yet. " for card in cards) + "Let us play on."
    assert announced == [said]
    told = [noted_words(one, str) for one in notes if isinstance(one, StaffNote)]
    assert told == [
        f"Card 19 (user1) does not win yet. {CHECKS_OTHERS}",
        f"Card 18 (user3) does not win yet. {CHECKS_OTHERS}",
        f"Card 20 (user4) does not win yet. Tangy tells everybody: {said}",
    ]
    robot.control.next()
    assert announced == [said]


def test_a_claim_that_waits_in_vain_holds_no_announcement(
    robot: Robot, announced: list[str]
) -> None:
    plan = robot.control.plan
    for one in (ClaimCard(19, "user1"), ClaimCard(18, "user3")):
        plan.say_early(one)
    plan.do(ClaimCard(20, "user4"))
    assert announced == []
    robot.control.next()  # the others were never carried out
    assert announced == ["Card 20 does not win yet. Let us play on."]


def test_staff_read_what_the_group_hears_late_before_the_next_step(
    robot: Robot, announced: list[str]
) -> None:
    claim(robot, 17, "user2")
    claim(robot, 19, "user1")
    game = robot.control.supervision.game
    game.change("played on", person="user2", by="")
    steps = game.steps
    assert robot.control.next() == [] and game.steps == steps
    robot.control.next()  # also if nobody takes the note
    assert game.steps == steps + 1
    (told,) = robot.control.plan.late_notes()
    assert told.kind == "claims told"


def test_words_without_a_card_are_said_once() -> None:
    assert joined("Not yet. Let us play on.", [18, 19], "a line") == "Not yet. Let us play on."
    assert joined("Let us see: {card} no.", [18], "") == "Let us see: 18 no."
    assert joined("", [18, 19], "") == ""
