"""The live screen: the view of the robot, and the interventions of staff."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from textual.app import App

from tangy_hw.device_protocols import Pose
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.game_records import GameBeginning
from tangy_profiles.health import OK, Reading
from tangy_profiles.staff_records import StaffAction
from tangy_tui.app.game_commands import GoOn
from tangy_tui.app.watching import Guest
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.learning.verification import StopCommand
from tangy_tui.text.control import WAITS_FOR_YOU
from tangy_tui.text.keys import EMPTIES
from tangy_tui.text.live_games import LOOKS_ROUND
from tangy_tui.text.staff_view import TANGY_WAITS
from tangy_tui.text.tablet import screen_words
from tangy_tui.ui.dialogs.choose import ChooseDialog
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.driving import DrivingDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.question_panel import AskingPanel
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.microphone_line import MicrophoneLine
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.staff_panel import StaffPanel
from tangy_tui.ui.widgets.status_line import StatusLine
from tests.hw.links import LaidCard
from tests.pilot.conftest import SMALL, screen_text
from tests.pilot.ears import FakeEars
from tests.pilot.live_games import HeldLink, live, live_program, paused_after, settled
from tests.support.waiting import until_shown

if TYPE_CHECKING:
    from tests.pilot.conftest import Run, TangyPilot


async def asked_about_the_next(pilot: TangyPilot) -> None:
    """Wait until the question is readable: earlier keys do not answer it."""
    await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
    await until_shown(pilot, lambda: "Next: " in screen_text(pilot.app))
    await pilot.pause()


@pytest.mark.slow
async def test_the_room_shows_the_robot_and_its_goal(
    run: Run, program: Program, link: HeldLink
) -> None:
    async with run(app=program) as pilot:
        await paused_after(pilot, link, 2)
        link.state = replace(
            link.state,
            pose=Pose(3.0, 2.5, 3.1),
            going="user1",
            path=((3.0, 2.5), (2.5, 3.2), (2.0, 4.3)),
            obstacles=((6.0, 3.0),),
        )
        live(pilot).track()
        await pilot.pause()
        shown = screen_text(pilot.app)
        assert "◂[• •]" in shown and "*" in shown
        assert "·" in shown


async def test_the_screen_shows_the_address_and_code_of_the_chest_screen(
    run: Run, program: Program, link: HeldLink
) -> None:
    link.screen, link.code = "http://10.0.0.5:8765/", "1234-5678"
    link.tablet_page = "chest screen http://10.0.0.5:8765/ code 1234-5678"
    async with run(app=program, size=(80, 24)) as pilot:
        await paused_after(pilot, link, 1)
        assert screen_words(link.screen, link.code) in live(pilot).query_one(LogView).sentences
        assert link.tablet_page in screen_text(pilot.app)  # however small the window is


async def test_a_small_window_shows_the_goal_of_the_robot(
    run: Run, program: Program, link: HeldLink
) -> None:
    async with run(app=program, size=(80, 24)) as pilot:
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 2)
        link.free = False
        try:
            await until_shown(pilot, lambda: live(pilot).working > 0)
            link.state = replace(link.state, going="user1")
            await until_shown(pilot, lambda: "drives to User 1" in pilot.lines()[0])
            told = pilot.lines()[0]
            assert "TANGY live" in told and "robot OK" in told
        finally:
            link.free = True


@pytest.mark.slow
async def test_a_sign_is_drawn_before_the_step_is_over(
    run: Run, program: Program, link: HeldLink, world: LiveWorld
) -> None:
    async with run(app=program) as pilot:
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 2)
        link.free = False
        try:
            await until_shown(pilot, lambda: link.holds)
            link.sign(3)
            room = live(pilot).query_one(RoomView)
            await until_shown(pilot, lambda: room.scene.requests == ("user3",))
            await until_shown(pilot, lambda: "1. User 3 asks" in screen_text(pilot.app))
            assert world.tracker.queue == []
        finally:
            link.free = True


@pytest.mark.slow
async def test_a_waiting_command_is_reported_at_once_and_with_its_result(
    run: Run, program: Program, link: HeldLink
) -> None:
    async with run(app=program, size=(80, 24), notifications=True) as pilot:
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 2)
        link.free = False
        try:
            await until_shown(pilot, lambda: live(pilot).working > 0)
            await pilot.press("colon", *"bingo 2", "enter")
            await until_shown(pilot, lambda: isinstance(pilot.app.screen, ChooseDialog))
            await pilot.press(*"not know", "enter")
            await until_shown(pilot, lambda: "then checks card 2." in screen_text(pilot.app))
        finally:
            link.free = True
        await until_shown(pilot, lambda: "Card 2 does not win" in screen_text(pilot.app))


@pytest.mark.slow
async def test_the_answer_to_a_claim_replaces_the_number_in_the_bubble(
    run: Run, program: Program, world: LiveWorld
) -> None:
    world.pace = 300.0
    async with run(app=program, size=(80, 24)) as pilot:
        await until_shown(pilot, lambda: len(world.called) == 1)
        await until_shown(pilot, lambda: live(pilot).control.counts_down)
        await pilot.press("colon", *"bingo 2", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ChooseDialog))
        await pilot.press(*"not know", "enter")
        room = live(pilot).query_one(RoomView)
        await until_shown(pilot, lambda: "does not win" in room.speech)


@pytest.mark.slow
async def test_a_claim_asks_whose_card_it_is_if_nobody_knows(
    run: Run, program: Program, link: HeldLink, workspace: Workspace
) -> None:
    async with run(app=program, size=(80, 24), notifications=True) as pilot:
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 2)
        await pilot.press("colon", *"bingo 2", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ChooseDialog))
        await pilot.press(*workspace.name("user3"), "enter")
        await until_shown(pilot, lambda: bool(workspace.store.last("staff action")))
        claim = workspace.store.last("staff action")
        assert claim is not None and isinstance(claim.record, StaffAction)
        assert (claim.record.person, claim.record.detail) == ("user3", "2")


async def ended(pilot: TangyPilot) -> None:
    """End the game by words, as staff do."""
    await pilot.press("colon", *"end", "enter")
    await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
    await pilot.press("y")
    await until_shown(pilot, lambda: live(pilot).at_rest)


@pytest.mark.slow
async def test_no_game_follows_one_that_staff_have_ended(
    run: Run, program: Program, link: HeldLink, workspace: Workspace
) -> None:
    async with run(app=program, size=(80, 24)) as pilot:
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 2)
        await ended(pilot)
        for _ in range(10):
            await pilot.pause(0.05)
        assert live(pilot).at_rest
        assert len(list(workspace.store.events(GameBeginning))) == 1


@pytest.mark.slow
async def test_a_claim_after_the_end_of_a_game_is_answered(
    run: Run, program: Program, link: HeldLink
) -> None:
    async with run(app=program, size=(80, 24), notifications=True) as pilot:
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 2)
        await ended(pilot)
        await pilot.press("colon", *"bingo 2", "enter")
        await until_shown(pilot, lambda: "There is no game now." in screen_text(pilot.app))


async def test_repeated_pace_keys_log_one_sentence(
    run: Run, program: Program, link: HeldLink
) -> None:
    async with run(app=program, size=(120, 40)) as pilot:
        await paused_after(pilot, link, 2)
        await pilot.press(*["less_than_sign"] * 4)
        log = live(pilot).query_one(LogView)
        await until_shown(pilot, lambda: any("calls every" in one for one in log.sentences))
        assert live(pilot).world.pace > 10
        (told,) = [one for one in log.sentences if "calls every" in one]
        assert f"{live(pilot).world.pace:g} seconds" in told


@pytest.mark.slow
async def test_a_lost_robot_is_shown_as_looking_round(
    run: Run, program: Program, link: HeldLink
) -> None:
    well = link.state.health
    astray = Reading("localisation", 0.0, OK, {"fit": 1.0, "spread": 4.0})
    link.state = replace(link.state, health=(astray, *well))
    link.free = False
    async with run(app=program, size=(120, 40)) as pilot:
        try:
            await until_shown(pilot, lambda: "finds its place" in pilot.lines()[0])
            assert [do for do, _ in link.done] == ["spin"]
            await until_shown(pilot, lambda: LOOKS_ROUND.split(":")[0] in screen_text(pilot.app))
            assert "OVER" not in pilot.lines()[0] and "i autonomy" in pilot.lines()[-1]
            await pilot.press("escape")
            await until_shown(pilot, lambda: "Leave in the middle" in screen_text(pilot.app))
            await pilot.press("n")
        finally:
            link.state = replace(link.state, health=well)
            link.free = True
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 1)


@pytest.mark.slow
@pytest.mark.parametrize("hands_free", [True, False])
async def test_a_spoken_stop_reaches_the_robot(
    run: Run,
    workspace: Workspace,
    world: LiveWorld,
    link: HeldLink,
    policy: Policy,
    hands_free: bool,
) -> None:
    ears = FakeEars(hands_free=hands_free)
    async with run(app=live_program(workspace, world, policy, ears)) as pilot:
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 2)
        line = pilot.app.screen.query_one(MicrophoneLine)
        assert ears.asks and ("listening for stop" if hands_free else "t talk") in line.text
        link.free = False
        await until_shown(pilot, lambda: live(pilot).working > 0)
        if not hands_free:
            await pilot.press("t")
            assert ears.state == "listening"
        ears.hear(StopCommand("stop the robot"))
        await until_shown(pilot, lambda: "stop: staff stopped it" in link.told)
        await until_shown(pilot, lambda: "STOPPED" in screen_text(pilot.app))
        assert "Heard: stop the robot." in [told.message for told in pilot.app._notifications]
        link.free = True
        await pilot.press("p", "y")
        await until_shown(pilot, lambda: "STOPPED" not in screen_text(pilot.app))


@pytest.mark.slow
async def test_stop_reaches_the_robot_and_p_releases_it(
    run: Run, program: Program, link: HeldLink
) -> None:
    async with run(app=program) as pilot:
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 2)
        link.free = False
        await until_shown(pilot, lambda: live(pilot).working > 0)
        await pilot.press("ctrl+x")
        await until_shown(pilot, lambda: "stop: staff stopped it" in link.told)
        await until_shown(pilot, lambda: "STOPPED" in screen_text(pilot.app))
        link.free = True
        await pilot.press("p", "y")
        await until_shown(pilot, lambda: link.told[-1] == "release")


@pytest.mark.slow
async def test_a_small_screen_names_who_stopped_the_robot_elsewhere(
    run: Run, program: Program, workspace: Workspace
) -> None:
    async with run(app=program, size=SMALL, notifications=True) as pilot:
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 2)
        workspace.door.open()
        guest = Guest(workspace.store.folder)
        assert guest.look()
        guest.stop("Bea")
        await until_shown(pilot, lambda: "Bea stopped the robot" in screen_text(pilot.app))
        guest.close()


@pytest.mark.slow
async def test_each_stop_is_logged_and_reported_once(
    run: Run, program: Program, workspace: Workspace
) -> None:
    async with run(app=program) as pilot:
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 2)
        for count in (1, 2):
            await pilot.press("ctrl+x")
            await until_shown(pilot, lambda: "STOPPED" in screen_text(pilot.app))
            noted = [event.record.did for event in workspace.store.events(StaffAction)]
            assert noted.count("stopped") == count
            await pilot.press("p", "y")
            await until_shown(pilot, lambda: "STOPPED" not in screen_text(pilot.app))
        told = live(pilot).query_one(LogView).sentences
        assert sum(line.startswith("STOP.") for line in told) == 2


@pytest.mark.slow
async def test_staff_can_request_help_for_a_person(
    run: Run, program: Program, link: HeldLink, world: LiveWorld
) -> None:
    link.cards["user2"] = LaidCard(7)
    async with run(app=program) as pilot:
        await paused_after(pilot, link, 2)
        await pilot.press("h")
        assert "Who needs help?" in screen_text(pilot.app)
        await pilot.press("down", "enter")
        assert "user2" in world.requests.all
        live(pilot).control.apply(GoOn())
        await until_shown(pilot, lambda: world.tracker.place == "user2")


@pytest.mark.slow
async def test_the_log_reports_a_swapped_seat_once_and_its_end(
    run: Run, program: Program, link: HeldLink, world: LiveWorld
) -> None:
    world.knows_faces = True
    link.cards["user2"] = LaidCard(7)
    link.faces["user2"] = "user4"
    other = "User 4 sits at User 2's place: Tangy speaks to User 4."
    own = "User 2 sits at User 2's place again."
    async with run(app=program) as pilot:
        log = live(pilot).query_one(LogView)
        link.sign(2)
        await until_shown(pilot, lambda: other in log.sentences)
        assert own not in log.sentences
        link.faces.clear()
        link.state = replace(link.state, asks=())
        await until_shown(pilot, lambda: world.tracker.place == "front")
        link.sign(2)
        await until_shown(pilot, lambda: own in log.sentences)
        assert log.sentences.count(other) == log.sentences.count(own) == 1


@pytest.mark.slow
async def test_staff_and_requests_can_interrupt_the_wait_between_calls(
    run: Run, program: Program, link: HeldLink, world: LiveWorld
) -> None:
    world.pace = 30.0
    async with run(app=program) as pilot:
        await until_shown(pilot, lambda: len(world.called) == 1)
        await until_shown(pilot, lambda: "next call in 30 s" in screen_text(pilot.app))
        said = list(link.said)
        await pilot.press("c")
        await until_shown(pilot, lambda: len(link.said) == len(said) + 1)
        assert link.said[-1] == world.activity.deck.label(world.called[0])
        link.cards["user2"] = LaidCard(7)
        link.sign(2)
        await until_shown(pilot, lambda: world.tracker.place == "user2")
        assert len(world.called) == 1


@pytest.mark.slow
async def test_the_lowest_autonomy_asks_staff_before_every_step(run: Run, program: Program) -> None:
    async with run(app=program) as pilot:
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 2)
        await pilot.press("i", "i")
        await asked_about_the_next(pilot)
        steps = live(pilot).control.supervision.steps
        await pilot.press("y")
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps == steps + 1)
        await asked_about_the_next(pilot)
        await pilot.press("n")
        await until_shown(pilot, lambda: bool(live(pilot).query(AskingPanel)))


@pytest.mark.slow
async def test_a_yes_does_not_count_for_a_changed_question(
    run: Run, program: Program, link: HeldLink, world: LiveWorld
) -> None:
    link.cards["user2"] = LaidCard(7)
    async with run(app=program) as pilot:
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 2)
        await pilot.press("i", "i")
        await asked_about_the_next(pilot)
        assert "Next: call number?" in screen_text(pilot.app)
        done = len(link.done)
        link.sign(2)
        await pilot.press("y")
        await until_shown(
            pilot, lambda: "Next: navigate to user (User 2)?" in screen_text(pilot.app)
        )
        await pilot.pause()
        assert link.done[done:] == []
        await pilot.press("y")
        await until_shown(pilot, lambda: world.tracker.place == "user2")
        await asked_about_the_next(pilot)


@pytest.mark.slow
async def test_staff_can_choose_the_next_behaviour(run: Run, program: Program) -> None:
    async with run(app=program) as pilot:
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 2)
        await pilot.press("o")
        await until_shown(pilot, lambda: "You say what Tangy does next." in screen_text(pilot.app))
        assert live(pilot).control.supervision.question is not None


@pytest.mark.slow
@pytest.mark.parametrize("typed", [False, True])
async def test_one_esc_returns_the_choice_to_tangy_and_two_with_text(
    run: Run, program: Program, typed: bool
) -> None:
    async with run(app=program, size=(120, 40)) as pilot:
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 2)
        await pilot.press("o")
        await until_shown(pilot, lambda: any(one.is_open for one in live(pilot).query(AskingPanel)))
        await until_shown(pilot, lambda: live(pilot).is_active)  # not the line typed ahead
        await until_shown(pilot, lambda: "esc let Tangy go on by itself" in screen_text(pilot.app))
        if typed:  # it is not understood, so it is in the line again
            pilot.type(*"play a tune", "enter")
            await until_shown(
                pilot, lambda: live(pilot).query_one(CommandBar).text == "play a tune"
            )
            both = f"esc {EMPTIES}   esc esc let Tangy go on by itself"
            await until_shown(pilot, lambda: both in screen_text(pilot.app))
            await pilot.press("escape")
            await until_shown(pilot, lambda: "esc let Tangy go on" in screen_text(pilot.app))
            assert live(pilot).query(AskingPanel)
        steps = live(pilot).control.supervision.steps
        await pilot.press("escape")
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps > steps)
        assert not live(pilot).control.supervision.over and live(pilot).is_active
        assert not live(pilot).query(AskingPanel)
        await until_shown(pilot, lambda: isinstance(live(pilot).focused, StaffPanel))  # it scrolls
        assert not live(pilot).control.taking_over


@pytest.mark.slow
async def test_typing_stop_stops_and_swallows_the_rest_of_the_sentence(
    run: Run, program: Program, link: HeldLink
) -> None:
    async with run(app=program) as pilot:
        await paused_after(pilot, link, 2)
        await pilot.press("p")
        pilot.type(*"stop the robot", "enter")
        await until_shown(pilot, lambda: live(pilot).control.stopped)
        assert live(pilot).is_active, "no dialog was opened by the rest"
        assert "stop: staff stopped it" in link.told


@pytest.mark.slow
async def test_staff_can_drive_by_keys(run: Run, program: Program, link: HeldLink) -> None:
    async with run(app=program) as pilot:
        await paused_after(pilot, link, 2)
        await pilot.press("d")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, DrivingDialog))
        await pilot.press("up", "left", "escape")
        assert link.told.count("drive") == 3  # the last one is a stop
        assert not isinstance(pilot.app.screen, DrivingDialog)


@pytest.mark.slow
async def test_the_driving_dialog_explains_the_safety_limits(
    run: Run, program: Program, link: HeldLink
) -> None:
    async with run(app=program, size=(80, 24)) as pilot:
        await paused_after(pilot, link, 2)
        await pilot.press("d")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, DrivingDialog))
        told = screen_text(pilot.app)
        for words in ("slows down near people", "cannot see behind itself", "scanner is silent"):
            assert words in told
        for held, words in (("slow", "Tangy drives slowly."), ("stands", "Tangy stands. Turn")):
            link.state = replace(link.state, held=held)
            await until_shown(pilot, lambda words=words: words in screen_text(pilot.app))  # type: ignore[misc]
        link.state = replace(link.state, held="")
        await pilot.press("down")
        await until_shown(pilot, lambda: "Something is" not in screen_text(pilot.app))
        link.state = replace(link.state, hazard="laser scanner says nothing")
        await until_shown(
            pilot, lambda: "stands still: laser scanner says nothing." in screen_text(pilot.app)
        )
        link.state = replace(link.state, hazard="")
        await pilot.press("escape")


@pytest.mark.slow
async def test_a_frozen_robot_is_reported_and_logged_once(
    run: Run, program: Program, link: HeldLink, workspace: Workspace
) -> None:
    async with run(app=program, size=(120, 40)) as pilot:
        await paused_after(pilot, link, 2)
        link.state = replace(link.state, frozen=5.0)
        await until_shown(pilot, lambda: "was frozen for 5 s" in screen_text(pilot.app))
        await pilot.pause(0.5)
        noted = [event.record.did for event in workspace.store.events(StaffAction)]
        assert noted.count("robot frozen") == 1


@pytest.mark.slow
async def test_p_releases_a_frozen_robot_after_a_game(
    run: Run, program: Program, link: HeldLink
) -> None:
    async with run(app=program, size=(120, 40)) as pilot:
        await paused_after(pilot, link, 2)
        live(pilot).control.supervision.leave()
        assert live(pilot).at_rest
        link.state = replace(link.state, frozen=5.0)
        link.released.clear()
        await pilot.press("p")
        await until_shown(pilot, lambda: link.released == [""])
        assert "may move again" in screen_text(pilot.app)


@pytest.mark.slow
async def test_a_call_is_repeated_and_taken_back(
    run: Run, program: Program, link: HeldLink, world: LiveWorld, workspace: Workspace
) -> None:
    async with run(app=program) as pilot:
        await paused_after(pilot, link, 3)
        label = world.activity.deck.label(world.called[-1])
        count = len(world.called)
        await pilot.press("c")
        await until_shown(pilot, lambda: link.said[-1] == label)
        await until_shown(pilot, lambda: not live(pilot).working)
        await pilot.press("f2")
        await until_shown(pilot, lambda: f"Take {label} back?" in screen_text(pilot.app))
        await pilot.press("full_stop")
        assert len(world.called) == count
        await pilot.press("f2")
        await until_shown(pilot, lambda: f"Take {label} back?" in screen_text(pilot.app))
        await pilot.press("y")
        events = workspace.store.events
        await until_shown(pilot, lambda: len(list(events(StaffAction))) > 2)
        assert len(world.called) == count - 1
        noted = [(event.record.did, event.record.detail) for event in events(StaffAction)]
        assert noted == [("paused", ""), ("called again", label), ("took back", label)]


@pytest.mark.slow
async def test_the_game_waits_while_staff_are_asked_about_a_call(
    run: Run, program: Program, link: HeldLink, world: LiveWorld
) -> None:
    async with run(app=program) as pilot:
        await paused_after(pilot, link, 3)
        await pilot.press("p")
        await until_shown(pilot, lambda: live(pilot).control.phase == "running")
        await pilot.press("f2")
        await until_shown(pilot, lambda: "back?" in screen_text(pilot.app))
        await until_shown(pilot, lambda: not live(pilot).working)
        count = len(world.called)
        for _ in range(20):
            assert live(pilot).control.next() == []
        assert len(world.called) == count
        line = live(pilot).query_one(StatusLine)
        assert (live(pilot).control.phase, line.status.note) == ("asking", WAITS_FOR_YOU)
        now = live(pilot).query_one(StaffPanel)  # the question covers it
        assert now.render_line(0).text.strip() == TANGY_WAITS
        await pilot.press("n")
        await until_shown(pilot, lambda: live(pilot).control.phase == "running")
        assert line.status.note != WAITS_FOR_YOU
        await until_shown(pilot, lambda: len(world.called) > count)


@pytest.mark.slow
@pytest.mark.parametrize(("size", "faults"), [(SMALL, "back"), ((160, 45), "leave")])
async def test_esc_leads_back_to_now_before_it_asks_to_leave(
    run: Run, program: Program, link: HeldLink, size: tuple[int, int], faults: str
) -> None:
    def esc(leads: str) -> bool:
        return f"esc {leads}" in pilot.lines()[-1]

    async with run(app=program, size=size) as pilot:
        await paused_after(pilot, link, 3)
        for key, leads in (("u", "back"), ("6", faults), ("3", "back")):
            await until_shown(pilot, partial(esc, "leave"))
            await pilot.press(key)
            await until_shown(pilot, partial(esc, leads))
            if leads == "back":
                await pilot.press("escape")
                await until_shown(pilot, lambda: " Now " in pilot.text())
        await until_shown(pilot, partial(esc, "leave"))
        await pilot.press("3")
        await pilot.resize_terminal(160, 45)
        await pilot.press("escape")
        await pilot.press("escape")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))


@pytest.mark.slow
async def test_a_typed_end_asks_first(run: Run, program: Program, link: HeldLink) -> None:
    async with run(app=program) as pilot:
        await paused_after(pilot, link, 3)
        for key in ("n", "y"):
            assert not live(pilot).control.supervision.over
            await pilot.press("colon")
            await pilot.pause()
            await pilot.press(*"end", "enter")
            await until_shown(pilot, lambda: "End the game?" in screen_text(pilot.app))
            await pilot.pause()
            await pilot.press(key)
            await until_shown(pilot, lambda: pilot.app.screen is live(pilot))
        await until_shown(pilot, lambda: live(pilot).control.supervision.over)


@pytest.mark.slow
async def test_the_screen_shows_its_heartbeat_under_dialogs(
    run: Run, program: Program, link: HeldLink
) -> None:
    async with run(app=program) as pilot:
        await until_shown(pilot, lambda: link.stamps > 1)
        for key in ("question_mark", "7"):
            await pilot.press(key)
            await until_shown(pilot, lambda: pilot.app.screen is not live(pilot))
            stamps = link.stamps
            await until_shown(pilot, lambda stamps=stamps: link.stamps > stamps + 2)  # type: ignore[misc]
            await pilot.press("escape")
            await until_shown(pilot, lambda: pilot.app.screen is live(pilot))


async def test_keys_of_simulated_games_are_absent(run: Run, program: Program) -> None:
    async with run(app=program) as pilot:
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 1)
        for action in ("one_step", "skip"):
            assert live(pilot).check_action(action, ()) is False


@pytest.mark.slow
async def test_the_live_picture_in_the_readme_is_current(
    run: Run, program: Program, link: HeldLink, draw: Callable[[App[None]], str]
) -> None:
    kept = Path(__file__).parent / "pictures" / "live.svg"

    def ask_for_help(do: str, _: float) -> None:
        if do == "perform" and len(link.said) == 6:
            link.sign(2)
        if do == "go":  # the drive goes on, and so does the game
            link.free = False

    link.meanwhile = ask_for_help
    async with run(app=program, size=(120, 40)) as pilot:
        await until_shown(pilot, lambda: not link.free)
        link.state = replace(
            link.state,
            pose=Pose(4.7, 2.6, 1.9),
            going="user2",
            path=((4.7, 2.6), (4.5, 3.2), (4.2, 3.8), (4.0, 4.3)),
            obstacles=((6.2, 3.0), (6.4, 3.1)),
        )
        live(pilot).picture.show_scene(0, drive=False, pace=0)
        live(pilot).track()
        live(pilot).show_status()
        await until_shown(pilot, lambda: "Tangy comes" in screen_text(pilot.app))
        await settled(pilot, lambda: screen_text(pilot.app))
        drawn = draw(pilot.app)
        link.free = True
    if os.environ.get("TANGY_NEW_PICTURES"):
        kept.write_text(drawn, encoding="utf-8")
    assert kept.read_text(encoding="utf-8") == drawn, "draw it anew with TANGY_NEW_PICTURES=1"
