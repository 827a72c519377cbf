"""What staff ask of a live game by keys and words, and what the screen answers."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from textual.widgets import Input, Static

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_tui.app.command_grammar import command_reader
from tangy_tui.app.game_commands import AskFor, EndGame, GoesAway
from tangy_tui.app.interruption import find_interrupted
from tangy_tui.app.similar_commands import nearest_commands
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.text.confirmations import called_meanwhile
from tangy_tui.text.control import WAITS_FOR_YOU, waits_words
from tangy_tui.text.games import REPORT_AFTER_LEAVING, REPORT_AT_HOME
from tangy_tui.text.interruptions import to_be_resumed_words
from tangy_tui.text.staff_view import TANGY_WAITS, TIME_FIRST
from tangy_tui.text.typed_commands import NEXT_OVER, next_dropped
from tangy_tui.ui import run as opening
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.staff_line import CommandDialog, NextDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.staff_panel import StaffPanel
from tangy_tui.ui.widgets.status_line import StatusLine
from tests.app.test_interruption import Robot
from tests.pilot.conftest import SMALL, StillClock, screen_text
from tests.pilot.faults import game_of, halting, playing
from tests.pilot.live_games import (
    HeldLink,
    ask_for_the_choice,
    live,
    paused_after,
    until_a_call_is_held,
)
from tests.support.waiting import until_shown

if TYPE_CHECKING:
    from tests.pilot.conftest import Run


@pytest.mark.slow
async def test_the_question_about_a_call_tells_of_a_call_that_came_meanwhile(
    run: Run, program: Program, link: HeldLink, world: LiveWorld, workspace: Workspace
) -> None:
    label = workspace.activity.deck.label
    async with run(app=program) as pilot:
        await paused_after(pilot, link, 2)
        asked, meanwhile = world.called_now[-1], world.called_now[-1] % 75 + 1
        await pilot.press("f2")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
        world.calls.called.append(meanwhile)
        await until_shown(
            pilot, lambda: called_meanwhile(label(meanwhile)) in screen_text(pilot.app)
        )
        await pilot.press("y")
        await until_shown(pilot, lambda: asked not in world.called_now)
        assert meanwhile in world.called_now


@pytest.mark.slow
async def test_a_call_is_taken_back_after_the_one_that_is_being_said(
    run: Run, program: Program, link: HeldLink, world: LiveWorld, workspace: Workspace
) -> None:
    label = workspace.activity.deck.label
    async with run(app=program) as pilot:
        room = live(pilot).query_one(RoomView)
        await until_a_call_is_held(pilot, link, world, 2)
        (said,), asked = world.calling, world.called_now[-1]
        await pilot.press("f2")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
        assert label(said) in screen_text(pilot.app) and said not in world.called_now
        await pilot.press("y")
        await pilot.pause()
        assert asked in world.called_now
        link.most = len(link.said)  # the number is said, and the group is told of the other
        await until_shown(pilot, lambda: asked not in world.called_now)
        assert said in world.called_now and live(pilot).working
        await until_shown(pilot, lambda: room.scene.called == world.called_now)
        link.most = 10_000


@pytest.mark.slow
async def test_who_leaves_during_a_step_is_told_and_drawn_as_away_at_once(
    run: Run, program: Program, link: HeldLink, world: LiveWorld, workspace: Workspace
) -> None:
    async with run(app=program) as pilot:
        screen = live(pilot)
        await until_shown(pilot, lambda: screen.control.supervision.steps >= 2)
        link.free = False
        await until_shown(pilot, lambda: screen.working)
        command = GoesAway("user3")
        await pilot.press("colon")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, CommandDialog))
        pilot.app.screen.query_one(Input).value = f"left {workspace.name('user3')}"
        await pilot.press("enter")
        told = waits_words(command, workspace.name)
        await until_shown(pilot, lambda: told in screen.query_one(LogView).sentences)
        await until_shown(pilot, lambda: screen.query_one(RoomView).scene.away == {"user3"})
        assert world.away == set()  # not before the step is done
        link.free = True
        await until_shown(pilot, lambda: world.away == {"user3"})


@pytest.mark.slow
@pytest.mark.parametrize("gives_back", [False, True])
async def test_staff_type_what_tangy_does_next_while_it_finishes_its_step(
    run: Run, program: Program, link: HeldLink, world: LiveWorld, gives_back: bool
) -> None:
    async with run(app=program) as pilot:
        await until_a_call_is_held(pilot, link, world)
        await ask_for_the_choice(pilot)
        if gives_back:
            await pilot.press("escape")
            await until_shown(pilot, lambda: not live(pilot).control.taking_over)
        else:
            await pilot.press(*"call number", "enter")
            link.most = len(link.said)
            await until_shown(pilot, lambda: "Did you say: call number?" in screen_text(pilot.app))
        link.most = 1000


@pytest.mark.slow
@pytest.mark.parametrize("typed", ["", "call number"])
async def test_the_line_for_what_tangy_does_next_ends_with_the_game(
    run: Run, program: Program, link: HeldLink, world: LiveWorld, typed: str
) -> None:
    async with run(app=program) as pilot:
        await until_a_call_is_held(pilot, link, world)
        screen = live(pilot)
        await ask_for_the_choice(pilot)
        if typed:
            await pilot.press(*typed, "enter")
        await asyncio.to_thread(screen.control.apply, EndGame())
        told = next_dropped(typed, over=True) if typed else NEXT_OVER
        await until_shown(pilot, lambda: told in screen.query_one(LogView).sentences)
        assert not any(isinstance(one, NextDialog) for one in pilot.app.screen_stack)
        assert not screen.control.taking_over
        link.most = 1000


@pytest.mark.slow
async def test_no_call_is_counted_down_while_tangy_waits_for_an_answer(
    run: Run, program: Program, world: LiveWorld
) -> None:
    world.pace = 30.0
    async with run(app=program, size=SMALL) as pilot:
        await until_shown(pilot, lambda: len(world.called) == 1)
        await until_shown(pilot, lambda: "next call in 30 s" in screen_text(pilot.app))
        await pilot.press("o")
        await until_shown(pilot, lambda: live(pilot).control.phase == "asking")
        line = live(pilot).query_one(StatusLine)
        await until_shown(pilot, lambda: line.status.note == WAITS_FOR_YOU)
        await until_shown(pilot, lambda: TANGY_WAITS in screen_text(pilot.app))


@pytest.mark.slow
async def test_a_refused_command_is_typed_over_or_replaced_by_a_similar_one(
    run: Run, workspace: Workspace
) -> None:
    reader = command_reader(workspace.activity, lambda who: workspace.find_person(who).id)
    name = workspace.name("user2")

    def similar(typed: str) -> tuple[str, ...]:
        return nearest_commands(typed, [*workspace.names.values()], workspace.activity.rules)

    async with run() as pilot:
        answers: list[object] = []
        dialog = CommandDialog(reader, "", "", "", similar)
        await pilot.app.push_screen(dialog, answers.append)
        line = dialog.query_one(Input)
        await pilot.press(*"qwertz", "enter")
        await pilot.press(*"zz")
        assert line.value == "zz"  # the next letter replaced the line
        line.value = f"help with {name}"
        await pilot.press("enter", "end", "x")
        assert line.value == f"help with {name}x"  # it can be corrected, too
        await pilot.press("backspace", "enter", "tab", "enter")
        assert answers == [AskFor("user2")]


@pytest.mark.slow
async def test_esc_closes_a_message_and_shows_the_next_step_before_it_asks_to_leave(
    run: Run, program: Program, link: HeldLink
) -> None:
    async with run(app=program, size=SMALL, notifications=True) as pilot:
        await paused_after(pilot, link, 2)
        screen = live(pilot)
        screen.query_one(StaffPanel).display = True
        screen.notify("Noted.")
        await until_shown(pilot, lambda: bool(screen.query("Toast")))
        await pilot.press("escape")
        await until_shown(pilot, lambda: not screen.query("Toast"))
        assert pilot.app.screen is screen
        panel = screen.query_one(StaffPanel)
        panel.styles.height = 4
        await pilot.pause()
        panel.scroll_to(y=2, animate=False, force=True)
        await until_shown(pilot, lambda: panel.scroll_offset.y == 2)
        await pilot.press("escape")
        await until_shown(pilot, lambda: panel.scroll_offset.y == 0)
        assert pilot.app.screen is screen
        await pilot.press("escape")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))


@pytest.mark.slow
async def test_while_a_call_is_counted_down_no_line_says_that_it_is_due(
    run: Run, program: Program, world: LiveWorld, workspace: Workspace
) -> None:
    world.pace = 30.0
    async with run(app=program, size=SMALL) as pilot:
        await until_shown(pilot, lambda: len(world.called) == 1)
        await until_shown(pilot, lambda: "next call in 30 s" in screen_text(pilot.app))
        await until_shown(pilot, lambda: TIME_FIRST in screen_text(pilot.app))
        due = workspace.activity.in_words(world.tracker.state().situation)
        line = live(pilot).query_one(StatusLine).status
        assert line.stage != due and line.step is None
        assert due not in screen_text(pilot.app)


def test_a_game_left_open_by_the_program_begun_at_home_is_told(
    taught: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    workspace = Workspace(taught)
    robot = Robot(workspace)

    def plays(program: Program) -> int:
        robot.control.next()
        robot.control.interrupt()
        return 0

    monkeypatch.setattr(opening, "outlive_terminal", lambda: None)
    monkeypatch.setattr(opening, "read_replies", lambda: None)
    monkeypatch.setattr(opening, "run_app", plays)
    opening.run_program(workspace, ascii_only=False)
    past = find_interrupted(workspace, robot.world.played_in)
    assert past is not None
    told = to_be_resumed_words(past, len(past.called(workspace.activity)))
    assert told in capsys.readouterr().out
    monkeypatch.setattr(opening, "run_app", lambda program: 0)
    opening.run_program(workspace, ascii_only=False)  # this time it was not played
    assert told not in capsys.readouterr().out
    workspace.close()


@pytest.mark.parametrize("left", ["abandon", "interrupt"])
def test_the_command_for_the_report_is_told_when_the_program_has_ended(
    taught: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], left: str
) -> None:
    workspace = Workspace(taught)
    robot = Robot(workspace)

    def plays(program: Program) -> int:
        robot.control.next()
        getattr(robot.control, left)()
        return 0

    monkeypatch.setattr(opening, "outlive_terminal", lambda: None)
    monkeypatch.setattr(opening, "read_replies", lambda: None)
    monkeypatch.setattr(opening, "run_app", plays)
    opening.run_program(workspace, ascii_only=False, report="tangy report --data here")
    *_, last = capsys.readouterr().out.splitlines()
    assert last.endswith("tangy report --data here")
    monkeypatch.setattr(opening, "run_app", lambda program: 0)
    opening.run_program(workspace, ascii_only=False, report="tangy report --data here")
    assert "tangy report" not in capsys.readouterr().out  # nothing was played
    workspace.close()


@pytest.mark.slow
@pytest.mark.parametrize("home", [True, False])
async def test_leaving_a_game_says_where_its_report_is(
    run: Run, program: Program, *, home: bool
) -> None:
    program.leads_home = home
    async with run(app=program, size=SMALL) as pilot:
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 1)
        await pilot.press("escape")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
        told = " ".join(str(part.render()) for part in pilot.app.screen.query(Static))
        assert (REPORT_AT_HOME in told) is home
        assert (REPORT_AFTER_LEAVING in told) is not home


@pytest.mark.slow
async def test_the_state_of_an_interrupted_game_stands_behind_the_question_if_all_is_well(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        screen, game, world = game_of(pilot)
        while not world.scene().called:
            await pilot.press("full_stop")
            await pilot.pause()
        await halting(pilot)
        await pilot.press("ctrl+q")
    past = find_interrupted(workspace, world.played_in)
    assert past is not None
    called = tuple(past.called(workspace.activity))

    async def start(program: Program) -> None:
        again = workspace.supervision(policy, past.beginning.seed, asks=True)
        await program.push_screen(PlayScreen(workspace, again, past=past))

    async with run(app=Program(workspace, start, clock=StillClock())) as pilot:
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ConfirmDialog))
        screen, game, _ = game_of(pilot)
        assert game.over
        assert screen.query_one(RoomView).scene.called == called
        label = workspace.activity.deck.label(called[-1])
        assert label in screen_text(pilot.app)
