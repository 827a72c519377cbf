"""The library of demonstrations and its conflicts, driven with keys."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from rich.cells import cell_len
from textual.app import App
from textual.widgets import Static

from tangy_profiles.demonstration import Demonstration
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.demonstration_rows import list_rows
from tangy_tui.learning.library import read_library
from tangy_tui.learning.library_entries import Library
from tangy_tui.learning.policies import last_policy, load_policy
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.words import WordsDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.conflicts import ConflictsScreen
from tangy_tui.ui.screens.demonstration import DemonstrationScreen
from tangy_tui.ui.screens.demonstrations import DemonstrationsScreen
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.screens.policy import PolicyScreen
from tangy_tui.ui.screens.teach import TeachScreen
from tangy_tui.ui.terminal import TerminalKind
from tangy_tui.ui.widgets.demonstration_list import demonstration_lines
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.transcript import Transcript
from tests.pilot.conftest import LARGE, SMALL, Run, StillClock, TangyPilot
from tests.shown import SlowClock, answering, log_demonstration

Demonstrate = Callable[[str, int, int], Demonstration]
WRONG = "incorrectly marked"
SIZES = pytest.mark.parametrize("size", [SMALL, LARGE], ids=["small", "large"])


@pytest.fixture(autouse=True)
def _greenwich(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Make dates look the same everywhere."""
    monkeypatch.setenv("TZ", "UTC")
    time.tzset()
    yield
    monkeypatch.undo()
    time.tzset()


@pytest.fixture
def workspace(
    tmp_path: Path, demonstrate: Demonstrate, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Workspace]:
    """A workspace in which Ada and Bea disagree about wrong marks, and Cem did not finish."""
    monkeypatch.setenv("USER", "ann")
    opened = Workspace(tmp_path / "data", now=SlowClock())
    games = (demonstrate("bingo", seed, 4) for seed in range(1, 40))
    wanted = (g for g in games if any(s.state.situation.user_state == WRONG for s in g.steps))
    first, second, third = (next(wanted) for _ in range(3))
    log_demonstration(opened.store, replace(first, id="aaaa", teacher="Ada"))
    other = replace(second, id="bbbb", teacher="Bea")
    log_demonstration(opened.store, answering(other, WRONG, "encourage"))
    begun = replace(third, id="cccc", teacher="Cem", steps=third.steps[:6], finished=False)
    log_demonstration(opened.store, begun)
    yield opened
    opened.close()


def library_of(workspace: Workspace) -> Library:
    return read_library(workspace.store, workspace.activity.name)


def states(workspace: Workspace) -> list[str]:
    """Return why each demonstration is excluded from learning (empty: it is used)."""
    return [entry.hidden for entry in library_of(workspace).entries.values()]


def program(workspace: Workspace, *keys: str) -> Program:
    """Make the program at home."""
    return Program(workspace, clock=StillClock())


async def press(pilot: TangyPilot, *keys: str) -> None:
    """Press keys in turn, each when the effect of the last one is on the screen."""
    for key in keys:
        await pilot.press(key)
        await pilot.pause()


def told(pilot: TangyPilot) -> str:
    """Return the sentences that are shown for a few seconds."""
    return " ".join(notification.message for notification in pilot.app._notifications)


async def wait_for(pilot: TangyPilot, kind: type[object]) -> None:
    """Wait until a screen is open: learning runs in the background."""
    for _ in range(200):
        await pilot.pause(0.02)
        if isinstance(pilot.app.screen, kind):
            return
    raise AssertionError(f"no {kind.__name__}, but {pilot.app.screen}")


# ----------------------------------------------------------------------------------- the list


@pytest.mark.slow
async def test_the_list_shows_teachers_and_notes(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await press(pilot, "i", "enter")
        assert isinstance(pilot.app.screen, DemonstrationsScreen)
        shown = pilot.text()
        assert "2 of 3 in use" in shown
        assert "1 conflict: press D" in shown
        assert "Ada" in shown and "2026-03-02 09:0" in shown
        assert "unfinished" in shown
        assert "disagrees with demonstration 2 in 1 situation" in shown
        await press(pilot, "down", "down")
        assert "3: unfinished; not finished" in pilot.text()


@pytest.mark.slow
async def test_one_key_deletes_after_a_question_and_restores(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace)) as pilot:
        await press(pilot, "i", "enter", "x")
        assert isinstance(pilot.app.screen, ConfirmDialog)
        await press(pilot, "n")
        assert states(workspace) == ["", "", ""]
        await press(pilot, "x", "y")
        assert states(workspace) == ["deleted", "", ""]
        assert "1 of 3 in use" in pilot.text()
        await press(pilot, "x")
        assert states(workspace) == ["", "", ""]


@pytest.mark.slow
async def test_changes_are_undone_and_redone_in_order(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace), notifications=True) as pilot:
        await press(pilot, "i", "enter", "x", "y", "down", "x", "y")
        assert states(workspace) == ["deleted", "deleted", ""]
        await press(pilot, "f2")
        assert states(workspace) == ["deleted", "", ""]
        await press(pilot, "ctrl+z")
        assert states(workspace) == ["", "", ""]
        await press(pilot, "f2")
        assert "no change of the demonstrations to undo" in told(pilot)
        await press(pilot, "f3", "ctrl+y")
        assert states(workspace) == ["deleted", "deleted", ""]


@pytest.mark.slow
async def test_marked_demonstrations_are_merged_and_the_merge_undone(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace), notifications=True) as pilot:
        await press(pilot, "i", "enter", "asterisk", "M")
        assert "Mark two or more" in told(pilot)
        await press(pilot, "down", "asterisk", "M")
        assert "Merge demonstrations 1 and 2?" in pilot.text()
        await press(pilot, "y")
        assert states(workspace) == ["merged", "merged", "", ""]
        assert len(library_of(workspace).find("4").demonstration.steps) == sum(
            len(library_of(workspace).find(n).demonstration.steps) for n in "12"
        )
        await press(pilot, "f2")
        assert states(workspace)[:3] == ["", "", ""]


@pytest.mark.slow
async def test_a_demonstration_is_split_after_the_chosen_step(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace), notifications=True) as pilot:
        await press(pilot, "i", "enter", "S")
        assert "Choose the step that ends the first part" in told(pilot)
        await press(pilot, "tab", "home", "down", "S", "y")
        assert states(workspace) == ["split", "", "", "", ""]
        first = library_of(workspace).find("4").demonstration
        assert len(first.steps) == 2


async def test_merging_an_unfinished_demonstration_is_refused_with_the_reason(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace), notifications=True) as pilot:
        await press(pilot, "i", "enter", "asterisk", "down", "down", "asterisk", "M")
        assert isinstance(pilot.app.screen, DemonstrationsScreen)
        refusal = "Demonstration 3 by Cem is not finished yet."
        assert refusal in told(pilot)
        assert str(pilot.app.screen.query_one("#notes", Static).render()) == refusal
        await press(pilot, "up")
        assert "2: in use" in pilot.text()
        assert states(workspace) == ["", "", ""]


async def test_a_split_after_the_last_step_is_refused(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace), notifications=True) as pilot:
        await press(pilot, "i", "enter", "tab")
        steps = pilot.app.screen.query_one(Transcript)
        steps.point(steps.count)
        await press(pilot, "S")
        assert isinstance(pilot.app.screen, DemonstrationsScreen)
        assert "Nothing comes after step" in told(pilot)


@pytest.mark.slow
async def test_an_undone_merge_is_not_listed(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await press(pilot, "i", "enter", "asterisk", "down", "asterisk", "M", "y", "f2")
        assert states(workspace) == ["", "", "", "undone"]
        assert "undone" not in pilot.text()
        assert "2 of 3 in use" in pilot.text()
        await press(pilot, "f3", "down", "down")
        assert "merged from demonstrations 1 and 2" in pilot.text()


@pytest.mark.slow
async def test_leaving_a_screen_removes_its_messages(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace), notifications=True) as pilot:
        await press(pilot, "i", "enter", "x", "y")
        assert told(pilot)
        pilot.type("escape", "escape")  # the second comes when the screen has closed already
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)
        assert not told(pilot)


@pytest.mark.parametrize("size", [(60, 18), SMALL, LARGE])
async def test_the_key_line_always_lists_the_exit_and_the_help(
    run: Run, workspace: Workspace, size: tuple[int, int]
) -> None:
    async with run(app=program(workspace), size=size) as pilot:
        await press(pilot, "i", "enter")
        assert pilot.lines()[-1].endswith("esc back  ? help")
        assert "x put away  / filter" in pilot.lines()[-1]


@pytest.mark.slow
async def test_notes_fit_into_the_list(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace), size=LARGE) as pilot:
        await press(pilot, "i", "enter")
        for width in range(85, 161, 5):
            rows = list_rows(workspace.activity, library_of(workspace))
            lines = demonstration_lines(rows, (), width)
            assert max(cell_len("".join(t for t, _ in line.row)) for line in lines) <= width


@pytest.mark.slow
async def test_a_demonstration_opens_at_the_chosen_step(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await press(pilot, "i", "enter", "tab", "home", "down", "down", "enter")
        screen = pilot.app.screen
        assert isinstance(screen, DemonstrationScreen)
        assert screen.query_one(Transcript).chosen == 3
        assert "3 of " in str(screen.query_one("#told", Static).render())
        await press(pilot, "up", "escape")
        assert isinstance(pilot.app.screen, DemonstrationsScreen)
        await press(pilot, "escape", "escape")
        assert isinstance(pilot.app.screen, HomeScreen)


@pytest.mark.slow
async def test_a_demonstration_is_shown_again_from_a_step(run: Run, tmp_path: Path) -> None:
    from tangy_tui.learning.scripted_teacher import ScriptedTeacher

    workspace = Workspace(tmp_path / "own")
    try:
        teaching = workspace.teaching("Ada", 1)
        teaching.begin()
        list(ScriptedTeacher(teaching).demonstrate())
        async with run(app=program(workspace)) as pilot:
            await press(pilot, "i", "enter", "tab", "home", "down", "down", "down", "ctrl+r")
            assert "Show demonstration 1 again from step 4?" in pilot.text()
            await press(pilot, "n")
            assert len(library_of(workspace).entries) == 1
            await press(pilot, "ctrl+r", "y")
            await wait_for(pilot, TeachScreen)
            assert pilot.app.screen.query_one(Transcript).count == 3
            assert "Show it again from step 4" in pilot.text()
            await press(pilot, *"call number", "enter", "y")
            begun = library_of(workspace).find("2").demonstration
            assert (begun.origin, len(begun.steps)) == ("again", 4)
            assert not library_of(workspace).find("1").hidden  # until the new one is complete
    finally:
        workspace.close()


@pytest.mark.slow
async def test_a_step_opened_while_teaching_goes_back_in_that_session(
    run: Run, tmp_path: Path
) -> None:
    workspace = Workspace(tmp_path / "own")
    try:
        async with run(app=program(workspace)) as pilot:
            await press(
                pilot, "t", "enter", *"greet everyone", "enter", "y", *"call number", "enter", "y"
            )
            teach = pilot.app.screen
            id = library_of(workspace).find("1").demonstration.id
            await pilot.app.push_screen(DemonstrationScreen(workspace, id, 2))
            await press(pilot, "ctrl+r", "y")
            await wait_for(pilot, ConfirmDialog)
            await press(pilot, "y")
            assert pilot.app.screen is teach
            assert teach.query_one(Transcript).count == 1
            assert len(library_of(workspace).entries) == 1
    finally:
        workspace.close()


# ------------------------------------------------------------------------------ the conflicts


@pytest.mark.slow
async def test_learning_shows_conflicts_first_and_uses_the_answers(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace)) as pilot:
        await press(pilot, "l", "enter")
        assert isinstance(pilot.app.screen, ConflictsScreen)
        assert last_policy(workspace.store, "bingo") is None
        shown = pilot.text()
        assert "helping: wrong marks" in shown
        assert "remove markers" in shown and "encourage" in shown
        assert "demonstration 1" in shown and "Bea, 2026-03-02" in shown
        await press(pilot, "2")
        assert "Settled: 1" in pilot.text()
        await press(pilot, "enter")
        await wait_for(pilot, PolicyScreen)
        policy, _ = load_policy(workspace.store, workspace.activity)
        (conflict,) = (s for s in workspace.activity.situations if s.user_state == WRONG)
        right = library_of(workspace).resolutions[0].right
        assert (policy.decide(conflict).behaviour,) == right
        assert policy.decide(conflict).sure


@pytest.mark.slow
async def test_open_conflicts_are_asked_about_in_games(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await press(pilot, "l", "enter", "escape")
        assert "Left open: 1; Tangy will ask" in pilot.text()
        await press(pilot, "enter")
        await wait_for(pilot, PolicyScreen)
        policy, _ = load_policy(workspace.store, workspace.activity)
        contested = [s for s in workspace.activity.situations if policy.decide(s).contested]
        assert [s.user_state for s in contested] == [WRONG]


@pytest.mark.slow
async def test_answers_can_be_undone_and_learning_left(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await press(pilot, "l", "enter", "1")
        assert len(library_of(workspace).resolutions) == 1
        await press(pilot, "f2")
        assert library_of(workspace).resolutions == ()
        assert "Which is right?" in pilot.text()
        await press(pilot, "0")
        assert len(library_of(workspace).resolutions[0].right) == 2
        await press(pilot, "escape")
        assert isinstance(pilot.app.screen, HomeScreen)
        assert last_policy(workspace.store, "bingo") is None


@pytest.mark.slow
async def test_a_third_behaviour_can_be_the_right_one(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await press(pilot, "l", "enter", "O")
        assert isinstance(pilot.app.screen, WordsDialog)
        await press(pilot, "t", "enter")  # tell a joke
        assert library_of(workspace).resolutions[0].right == ("joke",)


@pytest.mark.slow
async def test_a_step_of_a_conflict_opens_in_its_demonstration(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace)) as pilot:
        await press(pilot, "i", "enter", "D", "tab", "enter")
        screen = pilot.app.screen
        assert isinstance(screen, DemonstrationScreen)
        step = screen.shown.steps[(screen.query_one(Transcript).chosen or 0) - 1]
        assert step.state.situation.user_state == WRONG
        await press(pilot, "escape")
        assert isinstance(pilot.app.screen, ConflictsScreen)
        assert "Which is right?" in pilot.text()


async def test_a_key_typed_before_the_conflict_appears_resolves_nothing(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace)) as pilot:
        await press(pilot, "l", "enter")
        pilot.type("1", at=0.1)
        await pilot.pause()
        assert library_of(workspace).resolutions == ()
        assert pilot.app.screen.query_one(LogView).sentences == ()


# ----------------------------------------------------------------------------------- appearance


@SIZES
async def test_the_list_matches_its_snapshot(
    run: Run, workspace: Workspace, size: tuple[int, int], looks: Callable[[App[None]], None]
) -> None:
    async with run(app=program(workspace), size=size) as pilot:
        await press(pilot, "i", "enter", "asterisk", "down", "asterisk")
        looks(pilot.app)


@pytest.mark.slow
@SIZES
async def test_a_demonstration_matches_its_snapshot(
    run: Run, workspace: Workspace, size: tuple[int, int], looks: Callable[[App[None]], None]
) -> None:
    async with run(app=program(workspace), size=size) as pilot:
        await press(pilot, "i", "enter", "tab", "home", "down", "enter")
        looks(pilot.app)


@SIZES
async def test_a_conflict_matches_its_snapshot(
    run: Run, workspace: Workspace, size: tuple[int, int], looks: Callable[[App[None]], None]
) -> None:
    async with run(app=program(workspace), size=size) as pilot:
        await press(pilot, "i", "enter", "D")
        looks(pilot.app)


async def test_resolved_conflicts_match_their_snapshot(
    run: Run, workspace: Workspace, looks: Callable[[App[None]], None]
) -> None:
    async with run(app=program(workspace)) as pilot:
        await press(pilot, "i", "enter", "D", "1")
        looks(pilot.app)


@pytest.mark.parametrize("size", [(60, 18), SMALL])
async def test_the_library_is_readable_in_ascii_and_in_a_small_window(
    run: Run, workspace: Workspace, size: tuple[int, int]
) -> None:
    app = Program(workspace, clock=StillClock(), kind=TerminalKind(ascii=True, ansi=True))
    async with run(app=app, size=size) as pilot:
        await press(pilot, "i", "enter")
        assert "Ada" in pilot.text()
        await press(pilot, "D")
        assert "Which is right?" in pilot.text()
        assert "step " in pilot.text()
