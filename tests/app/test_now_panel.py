"""The panel *Now*: the next step is only what is decided, and says why somebody comes first."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from tangy_hw.robot_client.commands import WaitKind
from tangy_profiles.game_rules import GamePlan
from tangy_tui.app.claim_controls import CLAIM_SECONDS
from tangy_tui.app.game_commands import AskFor, ClaimCard, Pause, TakeOver
from tangy_tui.app.robot_controls import PersonWait
from tangy_tui.app.staff_view import PersonNow
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.inquiries import Inquiries
from tangy_tui.text.control import person_wait_words
from tangy_tui.text.staff_view import PAUSED, PAUSES_THEN, person_words
from tangy_tui.text.whose_turn import why_now_lines
from tangy_tui.ui.screens.play_view import ViewSource, news_line, next_line
from tests.app.test_interruption import Robot
from tests.support.planned_games import Planned


@pytest.fixture
def robot(taught: Path) -> Iterator[Robot]:
    workspace = Workspace(taught)
    yield Robot(workspace)
    workspace.close()


def next_of(robot: Robot) -> str:
    return next_line(ViewSource(robot.world, robot.control, robot.workspace.name))


def test_until_the_card_is_read_the_next_step_is_to_look_at_it(robot: Robot) -> None:
    robot.next(2)
    robot.control.apply(AskFor("user2"))
    shown = list[tuple[str, str]]()
    robot.link.meanwhile = lambda do, time: shown.append((do, next_of(robot)))
    robot.next(1)
    name = robot.workspace.name("user2")
    looks = f"Tangy looks at the card ({name})."
    assert [words == looks for do, words in shown if do == "card"] == [True]
    assert next_of(robot).startswith("Next: ask to move the card closer")
    (arrives,) = (words for do, words in shown if do == "go")
    assert arrives.startswith(f"Next: go to {name}")


def test_while_tangy_waits_for_a_person_it_says_for_whom_and_how_long(robot: Robot) -> None:
    robot.next(2)
    robot.control.apply(AskFor("user2"))
    robot.next(1)
    name, most = robot.workspace.name("user2"), 2 * robot.world.activity.patience
    shown = list[tuple[str, str]]()
    inquiries = Inquiries(robot.control, robot.workspace.name, None, str)

    def look(do: str, time: float) -> None:
        where, why = ("".join(inquiries.lines(word) or []) for word in ("where", "why"))
        words = next_of(robot)
        assert ("waits for" in words) is ("waits for" in where) is ("waits for" in why)
        shown.append((do, words))

    robot.link.meanwhile = look
    robot.next(1)  # ask to move the card closer, which the person does not do
    waits = [words for _, words in shown if "waits for" in words]
    left = [int(words.split()[-2]) for words in waits]
    assert waits[0] == f"Tangy waits for {name} to respond, up to {left[0]} s."
    assert most - 2 <= left[0] <= most and left == sorted(left, reverse=True) and left[-1] < 5
    assert all("waits for" not in words for do, words in shown if do == "perform")
    assert robot.control.robot.waits_for is None and "waits for" not in next_of(robot)


@pytest.mark.parametrize(
    ("kind", "person", "words"),
    [
        ("sign", "user2", "Tangy waits until Rosa has put the sign down, up to 8 s."),
        ("act", "user2", "Tangy waits for Rosa, up to 8 s."),
        ("act", "", "Tangy waits for everybody, up to 8 s."),
    ],
)
def test_what_tangy_waits_for_is_told(kind: WaitKind, person: str, words: str) -> None:
    assert person_wait_words(PersonWait(kind, person, 8), lambda id: "Rosa") == words


def test_the_last_words_of_tangy_are_known_while_it_speaks(robot: Robot) -> None:
    said = list[str]()
    robot.link.meanwhile = lambda do, time: said.append(robot.world.said)
    robot.next(1)
    assert said[0] == robot.link.said[0] == robot.world.said
    robot.world.announce("Well done!")
    assert robot.world.said == "Well done!"
    robot.world.begin()
    assert robot.world.said == ""


def test_who_waits_for_some_numbers_is_told_so(taught: Path) -> None:
    planned = Planned(taught, users=24)
    planned.begin(GamePlan(("full card",), visits=True, pace=5))
    world, name = planned.world, planned.workspace.name
    while world.tracker.calls_first < 2:
        planned.play(calls=len(world.called_now) + 1)
        assert not planned.supervision.over
    calls, first = world.tracker.calls_first, world.tracker.queue[0]
    words = next_line(ViewSource(world, planned.control, name))
    then = f"{calls} numbers first, then {name(first)}, as everybody waits for the next one."
    assert words == f"Next: call number. {then}"
    people = {one.id: one for one in planned.control.view().people}
    assert f", after {calls} numbers" in person_words(people[first])
    assert not any(one.calls_first for one in people.values() if one.id != first)
    planned.workspace.close()


def test_who_comes_first_by_a_claim_is_told_so(robot: Robot) -> None:
    robot.next(2)
    robot.control.apply(AskFor("user1"))
    robot.world.observe()
    world = robot.world
    numbers = world.numbers_on(17)
    assert numbers is not None
    world.called.extend(numbers)
    told = robot.control.apply(ClaimCard(17, "user3"))
    assert told and "user3" in world.vouched
    view = {one.id: one for one in robot.control.view().people}
    assert (view["user3"].turn, view["user3"].claims) == (1, True)
    assert person_words(view["user3"]).startswith("first: a claim, asks")
    assert not view["user1"].claims
    name = robot.workspace.name("user3")
    assert next_of(robot) == f"Next: go to {name} (first because of the claim)."


def test_a_claim_that_wins_is_news_until_tangy_is_there(robot: Robot) -> None:
    robot.next(2)
    world, plan, name = robot.world, robot.control.plan, robot.workspace.name("user3")
    numbers = world.numbers_on(17)
    assert numbers is not None
    world.called.extend(numbers)
    shown = ViewSource(world, robot.control, robot.workspace.name)
    goes = f"Next: go to {name} (first because of the claim)."
    world.tracker.calls_first = 1  # others come later
    plan.say_early(ClaimCard(17, "user3"))  # while Tangy carries out its step
    assert news_line(shown).startswith(f"Card 17 ({name}) wins. Tangy finishes this")
    assert next_of(robot) == goes
    why = why_now_lines(robot.control, robot.workspace.name)
    assert f"Tangy goes to {name} next, because of the claim." in why
    robot.control.apply(ClaimCard(17, "user3"))
    assert news_line(shown) == f"Card 17 ({name}) wins. Tangy goes there next."
    assert next_of(robot) == goes
    robot.next(1)
    assert world.tracker.place == "user3" and news_line(shown) == ""


def test_a_step_that_staff_chose_is_told_while_it_is_carried_out(robot: Robot) -> None:
    robot.next(2)
    robot.control.apply(TakeOver())
    robot.next(1)
    robot.control.apply(AskFor("user2"))
    shown = list[str]()
    robot.link.meanwhile = lambda do, time: shown.append(next_of(robot))
    behaviour = robot.world.activity.behaviours["navigate to user"]
    robot.control.answer(behaviour, "user3")
    said = f"As you said: go to {robot.workspace.name('user3')}."
    assert shown and all(one == said for one in shown)
    assert robot.control.obeys is None and not next_of(robot).startswith(said)


def test_a_pause_during_a_step_is_told_to_come_after_it(robot: Robot) -> None:
    robot.next(2)
    robot.control.apply(AskFor("user2"))
    shown = list[str]()

    def pause(do: str, time: float) -> None:
        robot.control.apply(Pause())
        shown.append(next_of(robot))

    robot.link.meanwhile = pause
    robot.next(1)
    assert shown and all(one.startswith(PAUSES_THEN) for one in shown)
    robot.link.meanwhile = lambda do, time: None
    assert next_of(robot).startswith(PAUSED)


def test_the_reason_stands_before_the_visit() -> None:
    waits = PersonNow("ann", "asks", 1, waits=14.0, unvisited=24.0)
    assert (
        person_words(replace(waits, calls_first=3))
        == "asks 10 s, after 3 numbers, visited 20 s ago"
    )
    assert (
        person_words(replace(waits, claims=True)) == "first: a claim, asks 10 s, visited 20 s ago"
    )


def test_the_countdown_stands_still_only_while_a_step_is_carried_out(robot: Robot) -> None:
    shown = list[tuple[str, bool]]()
    robot.link.meanwhile = lambda do, time: shown.append((do, robot.control.counts_down))
    robot.world.set_pace(30.0)
    robot.next(2)
    assert robot.world.calls_in > 0 and robot.control.counts_down
    assert [counts for _, counts in shown] == [False] * len(shown)
    robot.next(1)  # it is too early
    assert robot.control.counts_down
    robot.control.apply(AskFor("user1"))
    robot.world.observe()
    assert not robot.control.counts_down  # Tangy goes to somebody first
    robot.control.apply(Pause())
    assert not robot.control.counts_down


def test_the_result_of_a_claim_is_told_at_once_and_stays_until_the_next_call(
    robot: Robot,
) -> None:
    robot.next(2)
    world, plan = robot.world, robot.control.plan
    shown = ViewSource(world, robot.control, robot.workspace.name)
    claim = ClaimCard(17, "user3")
    card = f"Card 17 ({robot.workspace.name('user3')})"
    plan.say_early(claim)  # while Tangy carries out its step
    assert news_line(shown) == (
        f"{card} does not win yet. Tangy finishes this, then tells everybody."
    )
    robot.control.apply(claim)
    told = f"{card} does not win yet."
    assert news_line(shown) == told
    robot.link.time += CLAIM_SECONDS
    assert news_line(shown) == told
    robot.next(1)
    assert news_line(shown) == ""


def test_a_number_that_is_being_called_may_decide_a_claim(robot: Robot) -> None:
    numbers = robot.world.numbers_on(17)
    assert numbers is not None
    robot.world.calls.calling = numbers[:1]
    robot.control.plan.say_early(ClaimCard(17, "user3"))
    shown = ViewSource(robot.world, robot.control, robot.workspace.name)
    assert "Tangy checks it as soon as it has called" in news_line(shown)
