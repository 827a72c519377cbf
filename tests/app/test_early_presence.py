"""What staff say of people during a step is shown at once, and takes effect after it."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path
from threading import Thread

import pytest

from tangy_hw.robot_client.help_requests import HelpRequestTracker
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.game_records import GameChange
from tangy_profiles.game_world import BENCH, LIVE
from tangy_profiles.past_game import interrupted_game
from tangy_profiles.staff_records import StaffAction
from tangy_profiles.store import Store
from tangy_tui.app.game_commands import (
    AskFor,
    ClaimCard,
    ComesIn,
    EndGame,
    GameCommand,
    GoesAway,
)
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.waiting_on import wait_on
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.in_progress import ProgressLines
from tangy_tui.console.telling import GameTelling
from tangy_tui.text.control import noted_words, waits_words
from tests.app.test_interruption import Robot
from tests.support.waiting import wait_until


@pytest.fixture
def robot(taught: Path) -> Robot:
    return Robot(Workspace(taught))


def said(robot: Robot) -> list[tuple[str, str]]:
    """Return who left or came by the word of staff, as logged."""
    acts = (event.record for event in robot.workspace.store.events(StaffAction))
    return [(act.did, act.person) for act in acts if act.did in ("left", "came")]


def changed(robot: Robot) -> list[tuple[str, str]]:
    """Return who left or came in the game, as logged."""
    found = (event.record for event in robot.workspace.store.events(GameChange))
    return [(one.what, one.person) for one in found if one.what in ("left", "came")]


def has_said(robot: Robot, count: int) -> bool:
    return len(said(robot)) == count


def during_a_step(robot: Robot, *commands: GameCommand) -> list[tuple[str, ...]]:
    """Give commands during the next step; return who was shown as away after each of them."""
    threads, shown = list[Thread](), list[tuple[str, ...]]()

    def meanwhile(do: str, time: float) -> None:
        robot.link.meanwhile = lambda do, time: None
        for number, command in enumerate(commands, len(said(robot)) + 1):
            threads.append(Thread(target=robot.control.carry_out, args=(command,)))
            threads[-1].start()
            wait_until(partial(has_said, robot, number))
            people = robot.control.view().people
            shown.append(tuple(one.id for one in people if one.state == "away"))
            assert changed(robot) == []

    robot.link.meanwhile = meanwhile
    robot.next(1)
    for thread in threads:
        thread.join()
    return shown


def test_who_leaves_during_a_step_is_logged_and_shown_before_it_is_over(robot: Robot) -> None:
    assert during_a_step(robot, GoesAway("user2")) == [("user2",)]
    assert said(robot) == changed(robot) == [("left", "user2")]
    assert robot.control.plan.away == robot.world.away == {"user2"}


def test_lines_tell_at_once_that_a_command_waits_for_the_step(robot: Robot) -> None:
    control, told = robot.control, list[str]()
    command = GoesAway("user2")
    progress = ProgressLines(control, str)
    telling = GameTelling(control, str, told.append, progress, lambda events: [])
    threads = list[Thread]()

    def meanwhile(do: str, time: float) -> None:
        robot.link.meanwhile = lambda do, time: None
        threads.append(Thread(target=lambda: telling.tell(telling.queue(command)())))
        threads[-1].start()
        wait_until(lambda: told == [waits_words(command, str)])
        assert changed(robot) == []

    robot.link.meanwhile = meanwhile
    robot.next(1)
    threads[0].join()
    assert told == [waits_words(command, str), noted_words(StaffNote("goes", "user2"), str)]


def test_lines_tell_the_result_of_a_claim_before_the_step_is_over(robot: Robot) -> None:
    control, told = robot.control, list[str]()
    command = ClaimCard(17, "user3")
    telling = GameTelling(control, str, told.append, ProgressLines(control, str), lambda events: [])
    threads = list[Thread]()
    at_once = "Card 17 (user3) does not win yet. Tangy finishes this, then tells everybody."

    def meanwhile(do: str, time: float) -> None:
        robot.link.meanwhile = lambda do, time: None
        threads.append(Thread(target=lambda: telling.tell(telling.queue(command)())))
        threads[-1].start()
        wait_until(lambda: told == [at_once])

    robot.link.meanwhile = meanwhile
    robot.next(1)
    threads[0].join()
    assert told[0] == at_once
    assert told[1].startswith("Tangy tells everybody: Card 17 does not win yet.")
    telling.queue(command)()
    assert told[2] == "Card 17 (user3) does not win yet."


def test_lines_answer_each_command_that_waits_behind_another(robot: Robot) -> None:
    told = list[str]()
    progress = ProgressLines(robot.control, str)
    telling = GameTelling(robot.control, str, told.append, progress, lambda events: [])
    claims = [ClaimCard(17, "user3"), ClaimCard(18, "user1")]
    queued = [telling.queue(claim) for claim in claims]
    result = "Card {} ({}) does not win yet."
    assert told == [result.format(17, "user3"), result.format(18, "user1")]
    leave = [telling.queue(GoesAway(person)) for person in ("user1", "user2")]
    waits = [waits_words(GoesAway(person), str) for person in ("user1", "user2")]
    wait_until(lambda: sorted(told[2:]) == waits)
    del told[:]
    for task in (*queued, *leave):
        telling.tell(task())
    assert [line.partition(":")[0] for line in told] == [
        *("Tangy tells everybody", "Tangy tells everybody"),
        *(noted_words(StaffNote("goes", person), str) for person in ("user1", "user2")),
    ]


def test_lines_tell_a_result_again_if_it_has_changed(robot: Robot) -> None:
    told = list[str]()
    progress = ProgressLines(robot.control, str)
    telling = GameTelling(robot.control, str, told.append, progress, lambda events: [])
    task = telling.queue(ClaimCard(17, "user3"))
    numbers = robot.world.numbers_on(17)
    assert numbers is not None
    robot.world.called.extend(numbers)  # meanwhile
    telling.tell(task())
    assert "does not win yet" in told[0]
    assert told[1].startswith("Card 17 (user3) wins. Tangy tells everybody: ")


def test_who_leaves_and_comes_back_during_a_step_is_here(robot: Robot) -> None:
    shown = during_a_step(robot, GoesAway("user2"), ComesIn("user2"))
    assert shown == [("user2",), ()]
    assert said(robot) == changed(robot) == [("left", "user2"), ("came", "user2")]
    assert robot.control.plan.away == robot.world.away == set()


def test_a_request_by_word_of_staff_is_shown_during_the_step(robot: Robot) -> None:
    shown = list[tuple[tuple[str, ...], list[str]]]()

    def meanwhile(do: str, time: float) -> None:
        robot.link.meanwhile = lambda do, time: None
        robot.control.apply(AskFor("user3"))
        asks = [one.id for one in robot.control.view().people if one.state == "asks"]
        shown.append((robot.control.plan.scene.requests, asks))
        assert robot.world.tracker.queue == []

    robot.link.meanwhile = meanwhile
    robot.next(1)
    assert shown == [(("user3",), ["user3"])]
    robot.next(1)
    assert robot.control.plan.scene.requests == ("user3",)


def test_a_sign_is_shown_during_the_step_in_which_it_is_raised(robot: Robot) -> None:
    shown = list[tuple[tuple[str, ...], list[str]]]()

    def meanwhile(do: str, time: float) -> None:
        robot.link.meanwhile = lambda do, time: None
        robot.link.sign(2, 3)
        asks = [one.id for one in robot.control.view().people if one.state == "asks"]
        shown.append((robot.control.plan.scene.requests, asks))
        assert robot.world.tracker.queue == [] and robot.world.queue == ()

    robot.link.meanwhile = meanwhile
    robot.next(1)
    assert shown == [(("user2", "user3"), ["user2", "user3"])]
    assert robot.world.queue == ("user2", "user3")


def test_a_sign_that_comes_down_late_is_not_shown_as_a_new_request(robot: Robot) -> None:
    shown = list[tuple[str, ...]]()
    robot.next(1)
    robot.link.sign(2)

    def meanwhile(do: str, time: float) -> None:
        shown.append(robot.world.asking)

    robot.link.meanwhile = meanwhile
    assert robot.world.requests.stays_up("user2")
    assert shown and not any(shown)
    assert robot.world.asking == ("user2",)


def test_a_word_of_staff_that_an_interruption_overtook_holds_in_the_resumed_game(
    robot: Robot,
) -> None:
    robot.next(1)
    store = robot.workspace.store
    robot.control.note("left", person="user2")  # logged, and then the program was killed
    robot.control.interrupt()
    past = interrupted_game(store, "bingo")
    assert past is not None
    assert [(one.what, one.person) for one in past.unmade] == [("left", "user2")]
    again = Robot(robot.workspace, past)
    assert again.world.away == {"user2"} and changed(again) == [("left", "user2")]
    past = interrupted_game(store, "bingo")
    assert past is not None and past.unmade == ()


def test_a_log_that_has_the_change_before_the_word_of_staff_repeats_nothing(robot: Robot) -> None:
    robot.next(1)
    robot.control.apply(GoesAway("user2"))
    store = robot.workspace.store
    act, change = store.last(StaffAction), store.last(GameChange)
    assert act is not None and change is not None
    store.append(replace(change.record, what="came"))
    store.append(replace(act.record, did="came"))
    past = interrupted_game(store, "bingo")
    assert past is not None and past.unmade == ()


def test_for_whom_staff_asked_in_vain_still_waits_in_the_next_game(robot: Robot) -> None:
    robot.next(2)
    for person in ("user2", "user3", "user1"):
        robot.control.apply(AskFor(person))
    robot.control.view()
    while robot.world.tracker.place != "user2":  # Tangy goes there
        robot.next(1)
    robot.link.time += 300.0
    robot.control.apply(EndGame())
    robot.control.apply(GoesAway("user1"))
    robot.control.begin()
    assert robot.world.queue == ("user3",)
    (waits,) = [one.waits for one in robot.control.view().people if one.id == "user3"]
    assert waits is not None and waits >= 300.0
    robot.next(2)  # which open the game
    robot.world.observe()
    assert robot.world.tracker.queue == ["user3"]


def test_for_whom_staff_asked_in_vain_still_waits_in_a_game_that_is_set_up_anew(
    robot: Robot, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot.next(2)
    robot.control.apply(AskFor("user3"))
    robot.control.apply(AskFor("user4"))
    robot.control.view()
    robot.link.time += 300.0
    robot.next(1)  # to user3
    robot.control.apply(EndGame())
    anew = Robot(robot.workspace)  # switched on again
    assert anew.world.queue == ("user4",)
    (waits,) = [one.waits for one in anew.control.view().people if one.id == "user4"]
    assert waits is not None and 300.0 <= waits < 400.0
    anew.next(2)
    anew.control.apply(EndGame())
    later = datetime.now(UTC) + timedelta(hours=1)
    monkeypatch.setattr(Store, "now", lambda store: later)
    assert Robot(robot.workspace).world.queue == ()


def test_a_wait_goes_on_between_two_games(robot: Robot, monkeypatch: pytest.MonkeyPatch) -> None:
    robot.next(2)
    robot.control.apply(AskFor("user3"))
    robot.control.apply(AskFor("user4"))
    robot.control.view()
    robot.link.time += 300.0
    robot.next(1)  # to user3
    robot.control.apply(EndGame())
    later = datetime.now(UTC) + timedelta(minutes=20)
    monkeypatch.setattr(Store, "now", lambda store: later)
    waits = wait_on(robot.workspace.store, Robot(robot.workspace, begins=False).world)
    assert set(waits) == {"user4"} and waits["user4"] >= 300.0 + 20 * 60


@pytest.mark.parametrize(
    ("world", "sign", "waits"), [(LIVE, "", False), (LIVE, "no sensor", True), (BENCH, "", True)]
)
def test_a_request_by_a_sign_goes_over_only_if_the_new_game_cannot_see_the_sign(
    taught: Path, monkeypatch: pytest.MonkeyPatch, world: str, sign: str, waits: bool
) -> None:
    monkeypatch.setattr(LiveWorld, "played_in", world)
    monkeypatch.setattr(HelpRequestTracker, "sign_of", lambda tracker, person: sign)
    robot = Robot(Workspace(taught))
    robot.next(2)
    robot.link.sign(3, 4)
    robot.next(1)  # to user3
    robot.control.apply(EndGame())
    anew = Robot(robot.workspace, begins=False)
    told = wait_on(robot.workspace.store, anew.world)
    assert set(told) == ({"user4"} if waits else set())
    robot.workspace.close()


@pytest.mark.parametrize("away", [True, False])
def test_nobody_waits_on_who_does_not_play_or_for_a_robot_elsewhere(
    robot: Robot, monkeypatch: pytest.MonkeyPatch, away: bool
) -> None:
    robot.next(2)
    robot.control.apply(AskFor("user3"))
    robot.control.apply(AskFor("user4"))
    robot.control.view()
    robot.next(1)  # to user3
    robot.control.apply(EndGame())
    anew = Robot(robot.workspace, begins=False)
    assert set(wait_on(robot.workspace.store, anew.world)) == {"user4"}
    if away:
        people = [person for person in anew.world.people if person != "user4"]
        monkeypatch.setattr(anew.world, "people", tuple(people))
    else:
        monkeypatch.setattr(anew.world, "played_in", BENCH)
    assert wait_on(robot.workspace.store, anew.world) == {}


def test_signs_that_were_set_aside_count_again_in_the_next_game(robot: Robot) -> None:
    robot.next(2)
    robot.link.sign(3)
    robot.world.requests.set_aside("user3")
    assert "user3" not in robot.world.requests.all
    robot.control.apply(EndGame())
    robot.control.begin()
    assert "user3" in robot.world.requests.all
