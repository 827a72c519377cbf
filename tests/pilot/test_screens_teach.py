"""The teaching screen, driven with keys."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from textual.app import App
from textual.pilot import Pilot
from textual.widgets import Static

from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.library import read_demonstrations
from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.text.keys import EMPTIES
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.question import QuestionDialog
from tangy_tui.ui.dialogs.why import WhyDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.screens.teach import TeachScreen
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.coverage_list import CoverageList
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.transcript import Transcript
from tests.pilot.conftest import LARGE, SMALL, Run, StillClock, screen_text


def program(workspace: Workspace, *, seed: int = 1, scripted: float | None = None) -> Program:
    """Make the program with the teaching screen open."""

    async def start(started: Program) -> None:
        teaching = workspace.teaching("ann", seed)
        await started.push_screen(TeachScreen(workspace, teaching, scripted=scripted))

    return Program(workspace, start, clock=StillClock())


async def say(pilot: Pilot[None], words: str, answer: str = "y") -> None:
    """Type a command, and answer its question."""
    await pilot.press(*words, "enter")
    await pilot.pause()
    assert isinstance(pilot.app.screen, QuestionDialog)
    await pilot.press(answer)
    await pilot.pause()


def steps(workspace: Workspace) -> list[str]:
    """Return the behaviours of the last demonstration by the log."""
    return [
        s.behaviour for s in read_demonstrations(workspace.store, workspace.activity.name)[-1].steps
    ]


@pytest.mark.slow
@pytest.mark.parametrize("size", [SMALL, LARGE])
async def test_a_confirmed_command_becomes_a_step(
    run: Run, workspace: Workspace, size: tuple[int, int]
) -> None:
    async with run(app=program(workspace), size=size) as pilot:
        await say(pilot, "greet everyone")
        shown = screen_text(pilot.app)
        assert "1 the game has not begun -> greet everyone" in shown
        assert "Hello, everybody" in shown
        assert "time for the next number" in shown
        assert steps(workspace) == ["greeting"]


@pytest.mark.slow
async def test_a_rejected_command_changes_nothing_and_returns_to_the_line(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace)) as pilot:
        await say(pilot, "call a number", "n")
        assert pilot.app.screen.query_one(CommandBar).text == "call a number"
        assert pilot.app.screen.query_one(Transcript).count == 0
        assert not read_demonstrations(workspace.store, workspace.activity.name)


@pytest.mark.slow
async def test_an_alternative_is_chosen_by_number_and_verified(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace)) as pilot:
        await pilot.press(*"greet evryone", "enter")
        await pilot.pause()
        first = pilot.app.screen
        assert isinstance(first, QuestionDialog)
        assert first.behaviour == "greet everyone"
        await pilot.press("1")
        await pilot.pause()
        second = pilot.app.screen
        assert isinstance(second, QuestionDialog)
        assert second.behaviour != first.behaviour
        await pilot.press("n")
        await pilot.pause()
        assert not read_demonstrations(workspace.store, workspace.activity.name)


async def test_unknown_words_are_reported_and_stay_in_the_line(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace)) as pilot:
        await pilot.press(*"flurb", "enter")
        await pilot.pause()
        assert "I do not know what 'flurb' means" in screen_text(pilot.app)
        assert pilot.app.screen.query_one(CommandBar).text == "flurb"


@pytest.mark.slow
async def test_a_new_question_clears_old_notices(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await pilot.press(*"flurb", "enter")
        await pilot.pause()
        await pilot.press("escape", *"celebrate", "enter")  # nobody has won
        await pilot.pause()
        log = pilot.app.screen.query_one(LogView)
        before = len(log.sentences)
        assert "I do not know what 'flurb' means" in " ".join(log.sentences)
        await pilot.press("escape", *"greet everyone", "enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, QuestionDialog)
        assert len(log.sentences) == before - 2
        assert "flurb" not in screen_text(pilot.app)


@pytest.mark.slow
@pytest.mark.parametrize("way", [("escape", "escape"), (*"quit", "enter")], ids=["esc", "word"])
async def test_leaving_a_game_reports_the_kept_steps(
    run: Run, workspace: Workspace, way: tuple[str, ...]
) -> None:
    async with run(app=program(workspace), notifications=True) as pilot:
        await say(pilot, "greet everyone")
        await pilot.press(*way)
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)
        assert "Tangy keeps 1 step of this game." in " ".join(
            n.message for n in pilot.app._notifications
        )


@pytest.mark.slow
async def test_undo_removes_the_last_step(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await say(pilot, "greet everyone")
        await say(pilot, "call number")
        await pilot.press("f2")
        await pilot.pause()
        assert pilot.app.screen.query_one(Transcript).count == 1
        assert steps(workspace) == ["greeting"]
        await pilot.press("ctrl+z")
        await pilot.pause()
        assert steps(workspace) == []


@pytest.mark.slow
async def test_redo_restores_the_steps_in_order(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await say(pilot, "greet everyone")
        await say(pilot, "call number")
        await pilot.press("f2", "f2")
        await pilot.pause()
        assert "seen 0/11" in screen_text(pilot.app)
        await pilot.press("f3")
        await pilot.pause()
        assert steps(workspace) == ["greeting"]
        await pilot.press("ctrl+y")
        await pilot.pause()
        assert steps(workspace) == ["greeting", "call number"]
        assert pilot.app.screen.query_one(Transcript).count == 2
        assert "seen 2/11" in screen_text(pilot.app)
        await pilot.press("f3")
        await pilot.pause()
        assert "no step to do again" in " ".join(pilot.app.screen.query_one(LogView).sentences)


@pytest.mark.slow
async def test_undo_and_redo_are_commands_too(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await say(pilot, "greet everyone")
        await pilot.press(*"undo", "enter")
        await pilot.pause()
        assert steps(workspace) == []
        await pilot.press(*"redo", "enter")
        await pilot.pause()
        assert steps(workspace) == ["greeting"]


@pytest.mark.slow
@pytest.mark.parametrize("typed", [True, False])
async def test_the_game_is_shown_again_from_a_step(
    run: Run, workspace: Workspace, typed: bool
) -> None:
    async with run(app=program(workspace)) as pilot:
        await mid_game(pilot, 14)
        if typed:
            await pilot.press(*"again 13", "enter")
        else:
            await pilot.press("escape", "up", "up", "ctrl+r")
        await pilot.pause()
        assert isinstance(pilot.app.screen, ConfirmDialog)
        assert "before step 13" in screen_text(pilot.app)
        assert "Steps 13 to 14 are taken back; f3 brings them" in screen_text(pilot.app)
        await pilot.press("y")
        await pilot.pause()
        screen = pilot.app.screen
        assert screen.query_one(Transcript).count == len(steps(workspace)) == 12
        assert screen_text(pilot.app).count("Steps 13 to 14 are undone") == 1
        await pilot.press("f3")
        await pilot.pause()
        assert len(steps(workspace)) == 13


@pytest.mark.slow
async def test_a_no_leaves_the_game_unchanged(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await mid_game(pilot, 4)
        await pilot.press("escape", "up", "ctrl+r")
        await pilot.pause()
        assert "Step 4 is taken back; f3 brings it back until" in screen_text(pilot.app)
        await pilot.press("n")
        await pilot.pause()
        assert len(steps(workspace)) == 4


@pytest.mark.slow
async def test_the_coverage_panel_lists_missing_situations(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        assert "helping: wrong marks" not in screen_text(pilot.app)
        await pilot.press("ctrl+o")
        await pilot.pause()
        seen = pilot.app.screen.query_one(CoverageList)
        assert "helping: wrong marks" in seen.missing
        assert "0 of 11 situations shown" in screen_text(pilot.app)
        await pilot.press("escape")
        await pilot.pause()
        assert isinstance(pilot.app.screen, TeachScreen)
        await mid_game(pilot, 15)  # the first person who is helped has wrong marks
        assert "helping: wrong marks" not in seen.missing
        said = " ".join(pilot.app.screen.query_one(LogView).sentences)
        assert "New to Tangy: helping: wrong marks" in said


async def test_a_large_screen_shows_the_coverage_below_the_steps(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace), size=LARGE) as pilot:
        assert "! helping: wrong marks" in screen_text(pilot.app)


@pytest.mark.slow
async def test_coverage_includes_earlier_demonstrations(run: Run, taught: Path) -> None:
    workspace = Workspace(taught)
    try:
        async with run(app=program(workspace, seed=9)) as pilot:
            assert "seen 11/11" in screen_text(pilot.app)
            await pilot.press("ctrl+o")
            await pilot.pause()
            assert "11 of 11 situations shown, 0 in this game" in screen_text(pilot.app)
            await pilot.press("escape")
            await mid_game(pilot, 3)
            await pilot.press("ctrl+o")
            await pilot.pause()
            assert "11 of 11 situations shown, 2 in this game" in screen_text(pilot.app)
            assert not pilot.app.screen.query_one(CoverageList).missing
    finally:
        workspace.close()


@pytest.mark.slow
async def test_the_status_names_a_guided_session(run: Run, workspace: Workspace) -> None:
    async def start(started: Program) -> None:
        await started.push_screen(
            TeachScreen(workspace, workspace.teaching("ada", 27, guided=True))
        )

    async with run(app=Program(workspace, start, clock=StillClock())) as pilot:
        await mid_game(pilot, 12)
        status = screen_text(pilot.app).splitlines()[0]
        assert "guided" in status
        assert "step 12" in status
        assert "game 27" in status


@pytest.mark.slow
async def test_why_shows_the_decision_learnt_so_far(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await pilot.press("f4")  # nothing was shown, so there is nothing to explain
        await ended(pilot, "why")
        assert isinstance(pilot.app.screen, TeachScreen)
        await mid_game(pilot, 4)
        await pilot.press("f4")
        await ended(pilot, "why")
        dialog = pilot.app.screen
        assert isinstance(dialog, WhyDialog)
        assert dialog.why.decision.behaviour == "call number"
        await pilot.press("escape")
        await pilot.pause()
        assert "working out" not in screen_text(pilot.app)
        await pilot.press("escape", "up", "up", "up", "up", "enter")
        await ended(pilot, "why")
        chosen = pilot.app.screen
        assert isinstance(chosen, WhyDialog)
        assert chosen.why.decision.behaviour == "greeting"


async def ended(pilot: Pilot[None], name: str) -> None:
    """Wait until a background computation of the screen ends."""
    for _ in range(200):
        await pilot.pause(0.02)
        if all(worker.is_finished for worker in pilot.app.workers if worker.name == name):
            await pilot.pause()
            return


@pytest.mark.slow
@pytest.mark.parametrize("where", ["the line", "nothing", "a chosen step"])
async def test_letters_go_to_the_line_from_any_focus(
    run: Run, workspace: Workspace, where: str
) -> None:
    async with run(app=program(workspace)) as pilot:
        await say(pilot, "greet everyone")
        if where != "the line":
            await pilot.press("escape")
        if where == "a chosen step":
            await pilot.press("up")
        screen, logged = pilot.app.screen, len(list(workspace.store.events()))
        letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+/"
        await pilot.press(*letters)
        await pilot.pause()
        assert pilot.app.screen is screen
        assert screen.query_one(CommandBar).text == letters
        assert len(list(workspace.store.events())) == logged
        assert steps(workspace) == ["greeting"]


@pytest.mark.slow
async def test_unknown_words_stay_selected(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        bar = pilot.app.screen.query_one(CommandBar)
        await pilot.press(*"sing us a lullaby", "enter")
        await pilot.pause()
        assert bar.text == "sing us a lullaby"
        await pilot.press(*"greet everyone")
        assert bar.text == "greet everyone"


async def test_tab_lists_only_possible_commands(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await pilot.press("tab")
        await pilot.pause()
        listed = screen_text(pilot.app)
        assert "greet everyone   call number" in listed and "check card" not in listed
        await pilot.press("tab")
        assert pilot.app.screen.query_one(CommandBar).text == "greet everyone"


@pytest.mark.slow
async def test_a_visit_without_a_request_is_refused_with_a_suggestion(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace)) as pilot:
        await pilot.press(*"go to user", "enter")
        await pilot.pause()
        assert "go to user 1" in screen_text(pilot.app)
        await pilot.press("end")  # the typed text is still there
        await say(pilot, " 3")
        await pilot.press("escape")  # there was no question: Tangy says so
        await pilot.pause()
        assert workspace.store.last("demonstration step") is not None
        assert "Tangy is with User 3" in str(pilot.app.screen.query_one("#now", Static).render())


@pytest.mark.slow
async def test_leaving_and_returning_keeps_the_steps(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await say(pilot, "greet everyone")
        await pilot.press("escape", "escape")
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)
    async with run(app=program(workspace)) as pilot:
        assert "1 the game has not begun -> greet everyone" in screen_text(pilot.app)
        assert "Going on where you left" in " ".join(pilot.app.screen.query_one(LogView).sentences)


@pytest.mark.slow
async def test_a_whole_game_can_be_demonstrated_before_the_next(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace)) as pilot:
        screen = pilot.app.screen
        assert isinstance(screen, TeachScreen)
        teacher = ScriptedTeacher(screen.teaching)
        while not screen.teaching.demonstration.finished:
            screen.follow(teacher.command())
            await pilot.pause()
            if isinstance(pilot.app.screen, QuestionDialog):
                await pilot.press("y")
                await pilot.pause()
        assert "The game is over" in screen_text(pilot.app)
        await pilot.press("f7")
        await pilot.pause()
        assert screen.query_one(Transcript).count == 0
        finished = read_demonstrations(workspace.store, workspace.activity.name)
        assert [d.finished for d in finished] == [True]


@pytest.mark.slow
async def test_stop_works_while_a_question_is_open(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await pilot.press(*"greet everyone", "enter")
        await pilot.pause()
        await pilot.press("ctrl+x")
        await pilot.pause()
        assert isinstance(pilot.app.screen, TeachScreen)
        assert "STOP" in " ".join(pilot.app.screen.query_one(LogView).sentences)
        assert not read_demonstrations(workspace.store, workspace.activity.name)


@pytest.mark.parametrize("words", ["stop the robot", "emergency stop", "Make it stop!"])
async def test_a_typed_stop_works_in_any_spoken_form(
    run: Run, workspace: Workspace, words: str
) -> None:
    async with run(app=program(workspace)) as pilot:
        pilot.type(*words, "enter")
        await pilot.pause()
        assert "STOP: the simulated robot stands still" in screen_text(pilot.app)
        assert isinstance(pilot.app.screen, TeachScreen)
        assert "No steps yet" in screen_text(pilot.app)


@pytest.mark.slow
async def test_markup_in_a_name_is_shown_as_text(run: Run, tmp_path: Path) -> None:
    with_markup = Workspace(tmp_path / "data")
    with_markup.store.rename("user1", "[/][@click=app.quit]x")
    with_markup.close()
    workspace = Workspace(tmp_path / "data")
    try:
        async with run(app=program(workspace), size=LARGE) as pilot:
            await say(pilot, "go to user 1")
            assert "[/]" in screen_text(pilot.app)
    finally:
        workspace.close()


async def mid_game(pilot: Pilot[None], steps: int) -> None:
    """Demonstrate some steps of a game."""
    screen = pilot.app.screen
    assert isinstance(screen, TeachScreen)
    teacher = ScriptedTeacher(screen.teaching)
    while len(screen.teaching.demonstration.steps) < steps:
        screen.follow(teacher.command())
        await pilot.pause()
        if isinstance(pilot.app.screen, QuestionDialog):
            await pilot.press("y")
            await pilot.pause()
    screen.query_one(RoomView).skip()


@pytest.mark.slow
@pytest.mark.parametrize("size", [SMALL, LARGE], ids=["small", "large"])
async def test_the_screen_during_a_game_matches_its_picture(
    run: Run, workspace: Workspace, size: tuple[int, int], picture: Callable[[App[None]], None]
) -> None:
    async with run(app=program(workspace), size=size) as pilot:
        await mid_game(pilot, 14)
        await pilot.press(*"remov")
        await pilot.pause()
        picture(pilot.app)


@pytest.mark.slow
async def test_the_coverage_panel_matches_its_snapshot(
    run: Run, workspace: Workspace, looks: Callable[[App[None]], None]
) -> None:
    async with run(app=program(workspace)) as pilot:
        await mid_game(pilot, 14)
        await pilot.press("ctrl+o")
        await pilot.pause()
        looks(pilot.app)


@pytest.mark.slow
async def test_the_question_matches_its_snapshot(
    run: Run, workspace: Workspace, looks: Callable[[App[None]], None]
) -> None:
    async with run(app=program(workspace)) as pilot:
        await mid_game(pilot, 11)
        await pilot.press(*"go to usr", "enter")
        await pilot.pause()
        looks(pilot.app)


@pytest.mark.slow
async def test_the_teaching_picture_in_the_readme_is_current(
    run: Run, workspace: Workspace, draw: Callable[[App[None]], str]
) -> None:
    kept = Path(__file__).parent / "pictures" / "teach.svg"
    async with run(app=program(workspace), size=(120, 40)) as pilot:
        await mid_game(pilot, 14)
        await pilot.press(*"remove markers", "enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, QuestionDialog)
        shown = str(pilot.app.screen.query_one("#question", Static).render())
        assert shown.startswith("Did you say: ask to remove markers") and "Y yes" in shown
        drawn = draw(pilot.app)
    if os.environ.get("TANGY_NEW_PICTURES"):
        kept.write_text(drawn, encoding="utf-8")
    assert kept.read_text(encoding="utf-8") == drawn, "draw it anew with TANGY_NEW_PICTURES=1"


async def test_a_notice_stands_in_the_log_and_covers_nothing(
    run: Run, workspace: Workspace
) -> None:
    screen = TeachScreen(workspace, workspace.teaching("ann", 1))
    program = Program(workspace, clock=StillClock())
    async with run((80, 24), app=program) as pilot:
        await program.push_screen(screen)
        await pilot.pause()
        before = screen_text(pilot.app).splitlines()
        program.say("Tangy is learning ...")
        await pilot.pause()
        after = screen_text(pilot.app).splitlines()
        changed = [n for n, (one, two) in enumerate(zip(before, after, strict=True)) if one != two]
        assert any("Tangy is learning" in after[n] for n in changed)
        first = next(n for n, line in enumerate(after) if "still to show" in line)
        assert all(n < first for n in changed)


async def test_the_foot_tells_what_escape_does_and_how_often_it_is_pressed_to_go_home(
    run: Run, workspace: Workspace
) -> None:
    async with run(SMALL, app=program(workspace)) as pilot:
        for begun in (("tab",), tuple("cal")):
            await pilot.press(*begun)
            await pilot.pause()
            assert f"esc {EMPTIES}" in screen_text(pilot.app)
            assert "home" not in screen_text(pilot.app).splitlines()[-1]
            await pilot.press("escape")
            await pilot.pause()
            bar = pilot.app.screen.query_one(CommandBar)
            assert (bar.text, bar.lists, bar.has_keys) == ("", False, True)
            assert "esc esc home" in screen_text(pilot.app)
        await pilot.press("escape")
        await pilot.pause()
        assert isinstance(pilot.app.screen, TeachScreen)
        shown = screen_text(pilot.app)
        assert "esc home" in shown
        assert "esc esc" not in shown
        await pilot.press("escape")
        await pilot.pause()
        assert not isinstance(pilot.app.screen, TeachScreen)
