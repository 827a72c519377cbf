"""Faults that halt the game or ask staff: clearing, giving up, accepting; driven with keys."""

from __future__ import annotations

import pytest

from tangy_profiles.game_records import GameEnding
from tangy_profiles.past_game import interrupted_game
from tangy_profiles.staff_records import StaffAction
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.fault import OVER, read_faults
from tangy_tui.monitoring.games import uncleared
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.fault import FaultDialog
from tangy_tui.ui.dialogs.question import QuestionDialog
from tangy_tui.ui.screens.help import HelpScreen
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.screens.question_panel import AskingPanel
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.transcript import Transcript
from tests.pilot.conftest import SMALL, Run
from tests.pilot.faults import (
    MIDDLE,
    TINY,
    asked,
    game_of,
    halted,
    halting,
    kinds_of,
    playing,
    seen,
    sure,
)
from tests.support.waiting import until_shown


@pytest.mark.slow
@pytest.mark.parametrize("size", [TINY, SMALL], ids=["tiny", "small"])
async def test_a_critical_fault_is_cleared_step_by_step(
    run: Run, workspace: Workspace, policy: Policy, size: tuple[int, int]
) -> None:
    async with run(app=playing(workspace, policy), size=size) as pilot:
        screen, game, _ = game_of(pilot)
        dialog = await halting(pilot)
        fault = dialog.fault
        count = screen.query_one(Transcript).count
        assert "! robot HALTED: Emergency stop press" in seen(pilot)
        assert "Somebody pressed the emergency stop." in seen(pilot)
        await pilot.press("r")
        await pilot.pause()
        assert "Press a first" in seen(pilot)
        await pilot.press("a")
        await pilot.pause()
        assert "the simulated" in seen(pilot)
        await pilot.press("r")
        await pilot.pause()
        assert "It is still there." in seen(pilot)
        assert game.halted is fault
        assert "esc give up" in seen(pilot)
        await pilot.press("e", "r")
        await until_shown(pilot, lambda: pilot.app.screen is screen)
        assert kinds_of(fault) == [
            "halted",
            "acknowledged",
            "still there",
            "expert called",
            "cleared",
        ]
        assert screen.query_one(Transcript).count == count
        await pilot.press("p")
        await until_shown(pilot, lambda: screen.query_one(Transcript).count > count)
        assert "robot OK" in seen(pilot)
    kept = read_faults(workspace.store)
    assert [kinds_of(fault) for fault in kept] == [kinds_of(fault)]
    assert {move.by for move in kept[0].moves} == {"", "ann"}


@pytest.mark.slow
async def test_the_dialog_shows_expected_and_observed_values_with_times(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy), size=MIDDLE) as pilot:
        await halting(pilot, "laser-disconnected")
        text = seen(pilot)
        assert "Still there: laser scanner: no data (STALE)." in text
        assert "expected: OK" in text
        assert "laser scanner, newest data: 2 s old" in text
        assert "at most 0.25 s old" in text
        assert "1. Do not push or pull the robot." in text
        assert "No expert is named for this robot" in text
        assert "0:31 halted" in text


@pytest.mark.slow
async def test_the_dialog_reports_the_end_of_the_fault_and_one_call(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        _, _, world = game_of(pilot)
        dialog = await halting(pilot, "camera-frozen")
        assert "Still there: head camera" in seen(pilot)
        assert "brightness" not in seen(pilot)  # it only says that the camera is not covered
        world.lift("camera-frozen")
        await until_shown(pilot, lambda: "It is gone now: press a, and r" in seen(pilot))
        await pilot.press("e", "e")
        await pilot.pause()
        assert "It is gone now: press r to clear." in seen(pilot)
        assert "The simulated expert has looked at it." in seen(pilot)
        assert kinds_of(dialog.fault).count("expert called") == 1


async def test_keys_typed_before_the_dialog_could_be_seen_do_nothing(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        dialog = await halting(pilot)
        pilot.type("a", "e", "R", "r", "escape", at=0.0)
        await pilot.pause()
        assert kinds_of(dialog.fault) == ["halted"]
        assert pilot.app.screen is dialog


@pytest.mark.slow
async def test_giving_up_needs_a_confirmation(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        screen, game, _ = game_of(pilot)
        dialog = await halting(pilot)
        await pilot.press("escape")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
        await pilot.pause()
        assert "not mended" in pilot.text()
        await pilot.press("escape")
        await pilot.pause()
        assert pilot.app.screen is dialog
        await pilot.press("escape")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
        await pilot.press("y")
        await until_shown(pilot, lambda: pilot.app.screen is screen)
        assert game.over
        assert kinds_of(dialog.fault)[-1] == "given up"
        assert "robot WARN: Emergency stop pressed, not cleared" in seen(pilot)
        assert pilot.lines()[-1].strip().startswith("g play again")
        assert "pause" not in pilot.lines()[-1]
        assert "[a] seen" not in pilot.text()
        ended = workspace.store.last("game ended")
        assert ended is not None
        assert "Emergency stop pressed" in str(ended.body["stopped"])


@pytest.mark.slow
@pytest.mark.parametrize("key", ["y", "n"])
async def test_an_uncleared_fault_blocks_the_next_game(
    run: Run, workspace: Workspace, policy: Policy, key: str
) -> None:
    before = workspace.supervision(policy, 5, asks=True, injections=("emergency-stop",))
    before.begin()
    while before.halted is None:
        before.step()
    before.give_up()
    async with run(app=playing(workspace, policy)) as pilot:
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
        await pilot.pause()
        assert "Emergency stop pressed" in seen(pilot)
        logged = workspace.store.last("game begun")
        await pilot.press(key)
        if key == "n":
            await until_shown(
                pilot, lambda: not any(isinstance(s, PlayScreen) for s in pilot.app.screen_stack)
            )
            assert workspace.store.last("game begun") == logged
        else:
            game = game_of(pilot)[1]
            await until_shown(pilot, lambda: not game.over)
            assert uncleared(workspace.store) is None
            earlier = str(logged.body["game"]) if logged is not None else ""
            (fault,) = [one for one in read_faults(workspace.store, earlier) if one.critical]
            assert fault.status == OVER and fault.moves[-1].by


@pytest.mark.slow
async def test_stop_works_inside_the_dialog_and_keeps_it_open(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        screen, _, world = game_of(pilot)
        world.inject("emergency-stop")
        dialog = await halted(pilot)
        await pilot.press("ctrl+x")
        await pilot.pause()
        assert pilot.app.screen is dialog
        assert "STOPPED, HALTED" in seen(pilot)
        assert "p lets Tangy go on" in seen(pilot)
        count = screen.query_one(Transcript).count
        await pilot.press("escape")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
        await pilot.press("ctrl+x")
        await pilot.pause()
        assert pilot.app.screen is dialog
        await pilot.press("e", "r")
        await until_shown(pilot, lambda: pilot.app.screen is screen)
        assert "STOPPED" in seen(pilot)
        for _ in range(3):
            await pilot.pause(0.02)
        assert screen.query_one(Transcript).count == count
        await pilot.press("p")
        await until_shown(pilot, lambda: screen.query_one(Transcript).count > count)


@pytest.mark.slow
async def test_two_critical_faults_are_cleared_one_after_the_other(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy), size=MIDDLE) as pilot:
        screen, game, world = game_of(pilot)
        first = await halting(pilot)
        world.inject("camera-disconnected")
        await until_shown(pilot, lambda: len(game.faults) == 2)
        assert "Also wrong" in seen(pilot)
        await pilot.press("e", "r")
        await until_shown(pilot, lambda: pilot.app.screen is not first)
        second = await halted(pilot)
        assert second.fault.code == "camera-disconnected"
        await pilot.press("e", "r")
        await until_shown(pilot, lambda: pilot.app.screen is screen)
        assert game.halted is None
        assert [fault.status for fault in game.faults] == [OVER, OVER]


@pytest.mark.slow
async def test_a_critical_fault_opens_over_the_help(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        screen, _, world = game_of(pilot)
        await pilot.press("p", "question_mark")
        await pilot.pause()
        world.inject("emergency-stop")
        await halted(pilot)
        await pilot.press("e", "r")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, HelpScreen))
        await pilot.press("escape")
        await pilot.pause()
        assert pilot.app.screen is screen


@pytest.mark.slow
async def test_a_game_can_be_resumed_after_quitting_while_halted(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        await halting(pilot)
        await pilot.press("ctrl+q")
    assert workspace.store.last(GameEnding) is None
    assert interrupted_game(workspace.store, workspace.activity.name) is not None
    assert not [act for act in workspace.store.events(StaffAction) if act.record.did == "stopped"]


@pytest.mark.slow
async def test_skipping_ends_at_a_halt(run: Run, workspace: Workspace, policy: Policy) -> None:
    async with run(app=playing(workspace, policy, "base-stuck")) as pilot:
        screen = game_of(pilot)[0]
        await sure(pilot, "E")
        dialog = await halted(pilot)
        assert dialog.fault.code == "base-stuck"
        assert screen.query_one(RoomView).going is None
        count = screen.query_one(Transcript).count
        await pilot.press("e", "r")
        await until_shown(pilot, lambda: pilot.app.screen is screen)
        assert screen.query_one(Transcript).count - count <= 1
        await sure(pilot, "E")
        await until_shown(pilot, lambda: screen.control.supervision.over)
        assert "The game is over" in screen.query_one(LogView).sentences[-1]


@pytest.mark.slow
async def test_a_fault_withdraws_a_question_until_it_is_cleared(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy, "no-effect", speed=1000)) as pilot:
        screen, _, world = game_of(pilot)
        first = await asked(pilot)
        pilot.type(*"call number", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, QuestionDialog))
        world.inject("emergency-stop")
        await halted(pilot)
        await until_shown(pilot, lambda: not screen.query(AskingPanel))
        assert not any(isinstance(s, QuestionDialog) for s in pilot.app.screen_stack)
        await pilot.press("e", "r")
        await until_shown(pilot, lambda: pilot.app.screen is screen)
        assert await asked(pilot) is not first
        assert "Tangy did not expect this" in seen(pilot)


@pytest.mark.slow
async def test_an_unexpected_effect_is_accepted_by_word(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy, "no-effect", speed=1000)) as pilot:
        screen, game, _ = game_of(pilot)
        await asked(pilot)
        assert "If all is well, type: all right" in seen(pilot)
        pilot.type(*"all right", "enter")
        await until_shown(pilot, lambda: kinds_of(game.faults[0])[-1] == "accepted")
        await sure(pilot, "E")
        await until_shown(pilot, lambda: not screen.query(AskingPanel))
    accepted = workspace.store.last("effect accepted")
    assert accepted is not None
    assert accepted.body["by"] == "ann"


@pytest.mark.slow
async def test_an_unexpected_effect_is_accepted_by_key_but_not_after_a_stop(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy, "no-effect", speed=1000)) as pilot:
        screen, game, _ = game_of(pilot)
        await asked(pilot)
        await pilot.press("escape")
        await pilot.pause()
        assert "r all right" in pilot.text()
        await pilot.press("ctrl+x", "r")
        await pilot.pause()
        assert game.question is not None
        assert "Press p to go on first" in seen(pilot)
        await pilot.press("p", "escape", "w")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, FaultDialog))
        assert "If all is well, say so" in seen(pilot)
        await pilot.press("escape")
        await sure(pilot, "r")
        await until_shown(pilot, lambda: game.faults[0].status == OVER)
        assert kinds_of(game.faults[0])[-1] == "accepted"
        await until_shown(pilot, lambda: not screen.query(AskingPanel))


@pytest.mark.slow
async def test_the_drawn_robot_freezes_at_a_stop_or_fault(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        screen, _, world = game_of(pilot)
        room = screen.query_one(RoomView)
        while room.going is None:
            await pilot.press("full_stop")
            await pilot.pause()
        caught, going = room.place_of_robot, room.going
        await pilot.press("ctrl+x")
        world.inject("emergency-stop")
        await halted(pilot)
        assert (room.place_of_robot, room.going) == (caught, going)
        await pilot.press("e", "r")
        await until_shown(pilot, lambda: pilot.app.screen is screen)
        assert (room.place_of_robot, room.going) == (caught, going)
        assert room.motion is None
        await pilot.press("p")
        await pilot.pause()
        assert room.motion is not None


@pytest.mark.slow
async def test_a_failed_step_is_marked(run: Run, workspace: Workspace, policy: Policy) -> None:
    async with run(app=playing(workspace, policy, "base-stuck")) as pilot:
        screen, game, _ = game_of(pilot)
        await sure(pilot, "E")
        await halted(pilot)
        steps = list(screen.query_one(Transcript).steps)
        done = [ground.acted.outcome.completed for ground in screen.picture.grounds]
        assert not all(done)
        assert ["not done: " not in step for step in steps] == done
        assert len(steps) == game.steps
