"""What happens while the robot drives, or cuts its drive short, is no fault of its place."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from datetime import timedelta

import pytest

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_hw.robot_process.stop_latch import ALONE
from tangy_profiles.game_records import FaultDiagnosed, FaultMove, GameStep
from tangy_tui.app.game_commands import TAKEN_OVER
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.games import read_games
from tangy_tui.monitoring.replay import read_replays
from tangy_tui.monitoring.supervision import Supervision
from tangy_tui.monitoring.watch import MOST_CUT_SHORT
from tangy_tui.text.staff_report import staff_rows
from tests.hw.links import FakeLink
from tests.support.live_worlds import live_world

PEOPLE = ("user1", "user2", "user3", "user4")
Meanwhile = Callable[[LiveWorld, FakeLink], object]


def asks_too(world: LiveWorld, link: FakeLink) -> None:
    link.sign(2, 1)


def takes_it_back(world: LiveWorld, link: FakeLink) -> None:
    link.sign()


def staff_ask(world: LiveWorld, link: FakeLink) -> None:
    world.requests.ask_for("user4")


def earlier_sign_is_seen_now(world: LiveWorld, link: FakeLink) -> None:
    link.sign(1, 2)  # the one who has asked for longer is seen later


def live_game(workspace: Workspace, learnt: Policy) -> tuple[Supervision, LiveWorld, FakeLink]:
    """A game in which user2 has just asked for help, and the robot is at the front."""
    link = FakeLink(PEOPLE)
    link.time = 100.0
    world = live_world(workspace, link)
    game = workspace.supervision(learnt, 1, world=world, asks=True)
    game.begin()
    for _ in range(3):
        game.step()
    link.sign(2)
    return game, world, link


def drives(link: FakeLink) -> list[str]:
    return [what["name"] for do, what in link.done if do == "go"]


@pytest.mark.parametrize(
    "meanwhile", [asks_too, takes_it_back, staff_ask, earlier_sign_is_seen_now]
)
def test_requests_that_change_during_a_drive_are_no_fault_of_the_robots_place(
    workspace: Workspace, learnt: Policy, meanwhile: Meanwhile
) -> None:
    game, world, link = live_game(workspace, learnt)

    def act(do: str, time: float) -> None:
        if do == "go":
            link.meanwhile = lambda do, time: None
            meanwhile(world, link)

    link.meanwhile = act
    while "user2" not in drives(link):
        game.step()
    assert [fault for fault in game.faults if fault.mismatches] == []
    assert game.question is None


def test_a_drive_that_the_programs_own_silence_cut_short_is_repeated(
    workspace: Workspace, learnt: Policy
) -> None:
    game, world, link = live_game(workspace, learnt)
    link.breaks["go"] = ALONE
    while "user2" not in drives(link):
        game.step()
    assert (world.tracker.place, game.faults, game.question) == ("front", [], None)
    game.step()
    assert (world.tracker.place, game.faults) == ("user2", [])


def test_a_robot_that_is_cut_short_again_and_again_has_a_fault(
    workspace: Workspace, learnt: Policy
) -> None:
    game, _, link = live_game(workspace, learnt)
    for _ in range(MOST_CUT_SHORT + 2):
        link.breaks["go"] = ALONE
        game.step()
        if drives(link):
            assert (drives(link).count("user2") <= MOST_CUT_SHORT) == (game.faults == [])
    assert [mismatch.variable for mismatch in game.faults[0].mismatches] == ["robot's place"]


def test_a_fault_names_no_behaviour_by_its_id(workspace: Workspace, learnt: Policy) -> None:
    game, _, link = live_game(workspace, learnt)
    link.missed.add("user2")
    while not game.faults:
        game.step()
    drive = workspace.activity.behaviours["navigate to user"]
    (record,) = (event.record for event in workspace.store.events(FaultDiagnosed))
    for text in (record.why, record.console, game.faults[0].console):
        assert drive.name not in text
    assert drive.question in record.why


def test_what_staff_do_about_a_fault_has_the_time_when_they_did_it(
    workspace: Workspace, learnt: Policy
) -> None:
    game, _, link = live_game(workspace, learnt)
    link.missed.add("user2")
    while not game.faults:
        game.step()
    (fault,) = game.faults
    link.time += 60.0
    game.acknowledge("Nina", fault)
    passed = timedelta(seconds=fault.moves[-1].seconds - fault.seconds)
    assert passed == timedelta(seconds=60)
    assert fault.real_time


def test_an_answer_is_logged_and_ends_its_fault_before_it_is_carried_out(
    workspace: Workspace, learnt: Policy
) -> None:
    game, _, link = live_game(workspace, learnt)
    link.missed.add("user2")
    while game.question is None:
        game.step()
    drive = workspace.activity.behaviours["navigate to user"]
    link.missed.clear()
    seen: list[tuple[str, str, str, str, str]] = []

    def look(do: str, time: float) -> None:
        if do == "go":
            move = game.faults[0].moves[-1]
            said = workspace.store.last(FaultMove)
            assert said is not None and said.record.move == move
            seen.append((move.kind, move.answer, move.target, move.by, game.status[0]))

    link.meanwhile = look
    game.answer(drive, "user2", "Nina")
    assert seen == [("taught", drive.name, "user2", "Nina", "OK")]


@pytest.mark.parametrize("over", [False, True], ids=["asked", "taken over"])
def test_the_report_tells_what_staff_answered(
    workspace: Workspace, learnt: Policy, over: bool
) -> None:
    game, _, link = live_game(workspace, learnt)
    if over:
        game.game.ask("", "", TAKEN_OVER)
    else:
        link.missed.add("user2")
    while game.question is None:
        game.step()
    link.missed.clear()
    drive = workspace.activity.behaviours["navigate to user"]
    game.answer(drive, "user2", "Nina")
    store, activity = workspace.store, workspace.activity
    (replay,) = read_replays(store, read_games(store), {activity.name: activity}, {})
    (row,) = staff_rows([replay], lambda person: f"<{person}>")
    assert row[1] == "Nina"
    assert row[2].endswith("go to <user2>")


@pytest.mark.parametrize("seconds", [9e11, -9e11])
def test_a_damaged_duration_does_not_break_the_report(
    workspace: Workspace, learnt: Policy, seconds: float
) -> None:
    game, *_ = live_game(workspace, learnt)
    store, activity = workspace.store, workspace.activity
    done = store.last(GameStep)
    assert done is not None and game.steps
    store.append(replace(done.record, teacher="Nina", seconds=seconds, clock=None))
    (replay,) = read_replays(store, read_games(store), {activity.name: activity}, {})
    assert [who for _, who, _ in staff_rows([replay], str)] == ["Nina"]
