"""A remark on a step replaces the command line, and takes a number as its answer."""

from __future__ import annotations

import pytest
from textual.pilot import Pilot

from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.library import read_library
from tangy_tui.learning.teaching_events import RemarkAnswer
from tangy_tui.learning.verification import Reply, Say
from tangy_tui.text.demonstrations import NOT_LEARNT
from tangy_tui.text.situations import WRONG_STEP
from tangy_tui.text.teaching import new_words
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.dialogs.question import QuestionDialog
from tangy_tui.ui.dialogs.remark import RemarkDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.demonstration import DemonstrationScreen
from tangy_tui.ui.screens.teach import TeachScreen
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.transcript import Transcript
from tests.pilot.conftest import Run, StillClock, screen_text
from tests.support.waiting import until_shown


def program(workspace: Workspace) -> Program:
    """Make the program: Ada has called a number where Bea is about to tell a joke."""

    async def start(started: Program) -> None:
        ada = workspace.teaching("Ada", 1)
        ada.begin()
        for phrase in ("greet everyone", "call number"):
            ada.apply(Say(phrase))
            ada.apply(Reply(yes=True))
        await started.push_screen(TeachScreen(workspace, workspace.teaching("Bea", 2)))

    return Program(workspace, start, clock=StillClock())


async def contradict(pilot: Pilot[None]) -> RemarkDialog:
    """Teach as Bea, and return the remark."""
    for phrase in ("greet everyone", "tell a joke"):
        await pilot.press(*phrase, "enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, QuestionDialog)
        await pilot.press("y")
        await pilot.pause()
    assert isinstance(pilot.app.screen, RemarkDialog)
    return pilot.app.screen


@pytest.mark.parametrize("width", [50, 80])
async def test_each_number_is_in_one_line_with_its_answer(
    run: Run, workspace: Workspace, width: int
) -> None:
    async with run((width, 24), app=Program(workspace, show_remark, clock=StillClock())) as pilot:
        await pilot.pause()
        lines = screen_text(pilot.app).splitlines()
        for start in (
            "1 this step",
            "2 the earlier one: greet",
            "3 both are fine",
            "4 a slip: undo",
        ):
            assert any(start in line for line in lines), lines


async def show_remark(started: Program) -> None:
    """Show a remark with four answers, too long for one line."""
    answers: list[tuple[RemarkAnswer, str]] = [
        ("this", "this step: tell a joke"), ("earlier", "the earlier one: greet everyone"),
        ("both", "both are fine"), ("undo", "a slip: undo this step"),
    ]  # fmt: skip
    await started.push_screen(RemarkDialog("Ada did something else here.", answers, "later"))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("key", "right"), [("1", ("joke",)), ("2", ("call number",)), ("3", ("joke", "call number"))]
)
async def test_a_contradiction_is_answered_in_place(
    run: Run, workspace: Workspace, key: str, right: tuple[str, ...]
) -> None:
    async with run(app=program(workspace)) as pilot:
        await contradict(pilot)
        assert "Ada showed: call number" in " ".join(screen_text(pilot.app).split())
        await pilot.press(key)
        await pilot.pause()
        assert isinstance(pilot.app.screen, TeachScreen)
        (said,) = read_library(workspace.store, "bingo").resolutions
        assert said.right == right


@pytest.mark.slow
@pytest.mark.parametrize(("key", "wrong"), [("1", False), ("2", True), ("3", False)])
async def test_a_step_that_was_called_wrong_is_marked_among_the_steps(
    run: Run, workspace: Workspace, key: str, wrong: bool
) -> None:
    async with run(app=program(workspace)) as pilot:
        await contradict(pilot)
        await pilot.press(key)
        await pilot.pause()
        first, last = pilot.app.screen.query_one(Transcript).steps
        assert not first.startswith(WRONG_STEP)
        assert last.startswith(WRONG_STEP) is wrong
        assert ("2 x wrong: a number is due" in screen_text(pilot.app)) is wrong
        await pilot.press("f2")  # the answer is undone with the step
        await pilot.press("f3")
        await pilot.pause()
        assert all(
            not step.startswith(WRONG_STEP) for step in pilot.app.screen.query_one(Transcript).steps
        )


@pytest.mark.slow
async def test_a_step_that_was_called_wrong_is_marked_in_the_library(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace)) as pilot:
        await contradict(pilot)
        await pilot.press("2")
        await pilot.pause()
        bea = read_library(workspace.store, "bingo").demonstrations[-1]
        await pilot.app.push_screen(DemonstrationScreen(workspace, bea.id, 2))
        await pilot.pause()
        await pilot.pause()
        shown = screen_text(pilot.app)
        assert "2 x wrong: a number is due" in shown
        assert NOT_LEARNT in shown


@pytest.mark.slow
@pytest.mark.parametrize(("key", "stands"), [("1", False), ("escape", True)])
async def test_a_step_counts_as_shown_once_it_is_no_slip(
    run: Run, workspace: Workspace, key: str, stands: bool
) -> None:
    new = new_words("a number is due")
    async with run(app=program(workspace)) as pilot:
        for phrase in ("greet everyone", "say goodbye"):
            await pilot.press(*phrase, "enter")
            await pilot.pause()
            await pilot.press("y")
            await pilot.pause()
        assert isinstance(pilot.app.screen, RemarkDialog)  # it ended the game early
        said = pilot.app.screen_stack[-2].query_one(LogView).sentences
        assert "seen 1/11" in screen_text(pilot.app)
        assert new not in said
        await pilot.press(key)
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, TeachScreen))
        assert ("seen 2/11" in screen_text(pilot.app)) is stands
        said = pilot.app.screen.query_one(LogView).sentences
        assert (new in said) is stands


@pytest.mark.slow
async def test_escape_defers_the_remark(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await contradict(pilot)
        await pilot.press("x", "y", "enter")  # none of these is an answer
        assert isinstance(pilot.app.screen, RemarkDialog)
        await pilot.press("escape")
        await pilot.pause()
        assert not read_library(workspace.store, "bingo").resolutions
        await pilot.press(*"call")
        assert pilot.app.screen.query_one(CommandBar).text == "call"


@pytest.mark.slow
async def test_learn_defers_the_remark_and_learns(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await contradict(pilot)
        await pilot.press("f5")
        await pilot.pause()
        await pilot.pause()
        assert isinstance(pilot.app.screen, MessageDialog)  # no game has ended
        assert not read_library(workspace.store, "bingo").resolutions


@pytest.mark.slow
async def test_a_slip_is_undone_from_the_remark(run: Run, workspace: Workspace) -> None:
    async with run(app=program(workspace)) as pilot:
        await contradict(pilot)
        await pilot.press("4")
        await pilot.pause()
        assert pilot.app.screen.query_one(Transcript).count == 1


@pytest.mark.slow
async def test_a_later_number_does_not_answer_a_deferred_remark(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=program(workspace)) as pilot:
        await contradict(pilot)
        await pilot.press("escape")
        await pilot.pause()
        await pilot.press("1", "enter")
        await pilot.pause()
        assert not read_library(workspace.store, "bingo").resolutions


@pytest.mark.slow
@pytest.mark.parametrize("key", ["f2", "ctrl+z"])
async def test_undo_takes_the_step_of_a_remark_back(
    run: Run, workspace: Workspace, key: str
) -> None:
    async with run(app=program(workspace)) as pilot:
        await contradict(pilot)
        screen = next(one for one in pilot.app.screen_stack if isinstance(one, TeachScreen))
        assert len(screen.teaching.demonstration.steps) == 2
        await pilot.press(key)
        await pilot.pause()
        await pilot.pause()
        assert pilot.app.screen is screen
        assert len(screen.teaching.demonstration.steps) == 1
        assert not read_library(workspace.store, "bingo").resolutions


@pytest.mark.slow
async def test_a_long_remark_cuts_no_list_in_the_middle(run: Run, workspace: Workspace) -> None:
    async with run((80, 24), app=program(workspace)) as pilot:
        remark = await contradict(pilot)
        await pilot.pause()
        box = remark.query_one("#remark").region
        teach = next(one for one in pilot.app.screen_stack if isinstance(one, TeachScreen))
        unseen = teach.query_one("#unseen").region
        assert unseen.y < box.y < unseen.bottom, "the remark covers a part of the list"

        def shown() -> str:
            return screen_text(pilot.app).splitlines()[box.y - 1].rstrip()

        await until_shown(pilot, lambda: shown().endswith("more"))  # it is laid out again
        assert "still to show: " in shown()
        one_line = shown()
        await pilot.press("escape")
        await pilot.pause()
        both = " ".join(screen_text(pilot.app).splitlines()[unseen.y : unseen.bottom])
        assert "still to show" in both
        assert len(both.split()) > len(one_line.split())


@pytest.mark.parametrize("hint", [False, True])
async def test_a_remark_cuts_nothing_of_the_situations_still_to_show(
    run: Run, workspace: Workspace, hint: bool
) -> None:
    sentence = "Something may be overlooked here: somebody asks for help, and a host goes to them."
    answers: list[tuple[RemarkAnswer, str]] = [("undo", "a slip: undo this step"), ("this", "fine")]
    async with run(app=program(workspace)) as pilot:
        remark = RemarkDialog(sentence, answers, "later")
        await pilot.app.push_screen(remark)
        await pilot.pause()
        if hint:
            await pilot.press("y")  # which is none of the answers
            await pilot.pause()
            assert "Press the number" in screen_text(pilot.app)
        lines = screen_text(pilot.app).splitlines()[: remark.query_one(".box").region.y]
    (first,) = (number for number, line in enumerate(lines) if "still to show" in line)
    assert any("more" in line for line in lines[first:]), "\n".join(lines)
