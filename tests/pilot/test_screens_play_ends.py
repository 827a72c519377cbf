"""The ends of games: another game, leaving under a dialog, and overlapping panels."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tangy_profiles.demonstration import Demonstration
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.library import effects_of
from tangy_tui.learning.policy import ForestSettings, Policy
from tangy_tui.ui.policy_options import comparison_options
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.help import help_for
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.screens.policy import PolicyScreen
from tangy_tui.ui.screens.question_panel import AskingPanel
from tangy_tui.ui.widgets.command_input import CommandInput
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.status_line import StatusLine
from tangy_tui.ui.widgets.transcript import Transcript
from tests.interaction.gaps import learnt, without
from tests.pilot.conftest import SMALL, Run, StillClock, TangyPilot
from tests.pilot.test_screens_asking import answer, asked, gap
from tests.shown import log_demonstration
from tests.support.waiting import until_shown

Cover = Callable[[str, int, int], tuple[Demonstration, ...]]
FEW = ForestSettings(trees=5)


@pytest.fixture
def policy(workspace: Workspace, cover: Cover) -> Policy:
    """A policy without gaps."""
    return learnt(workspace.store, workspace.activity, cover("bingo", 1, 4), FEW)


@pytest.fixture
def gappy(workspace: Workspace, cover: Cover) -> Policy:
    """A policy that was never shown two situations."""
    games = cover("bingo", 1, 4)
    last = games[0].steps[-1].state.situation
    shown = [without(without(d, gap(workspace)), last) for d in games]
    return learnt(workspace.store, workspace.activity, shown, FEW)


def playing(workspace: Workspace, policy: Policy) -> Program:
    """Make the program with the playing screen open; the screen's results go to `results`."""

    async def start(program: Program) -> None:
        supervision = workspace.supervision(policy, 5, asks=True)
        screen = PlayScreen(workspace, supervision, speed=1000, teacher="ann")
        program.results = [await program.push_screen_wait(screen)]  # type: ignore[attr-defined]

    return Program(workspace, start, clock=StillClock())


def told(pilot: TangyPilot) -> str:
    """Return the sentences that are shown for a few seconds."""
    return " ".join(notification.message for notification in pilot.app._notifications)


async def over(pilot: TangyPilot) -> PlayScreen:
    """Skip to the end of the current game."""
    screen = pilot.app.screen
    assert isinstance(screen, PlayScreen)
    await pilot.press("E", "y")
    while not screen.control.supervision.over:
        await pilot.pause(0.02)
    await pilot.pause()
    return screen


@pytest.mark.slow
async def test_leaving_twice_at_once_leaves_once(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        screen = await over(pilot)
        screen.action_leave()
        screen.action_leave()
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)


# ------------------------------------------------------------------------------- another game


@pytest.mark.slow
async def test_another_game_can_be_scheduled_during_a_game(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy), notifications=True) as pilot:
        screen = pilot.app.screen
        await pilot.press("p", "g", "y")
        await pilot.pause()
        follows = "Another game begins when this one is over."
        assert screen.query_one(LogView).sentences[-1] == follows
        assert follows in told(pilot)
        await pilot.press("g", "y")
        assert (
            screen.query_one(LogView).sentences[-1] == "2 more games begin when this one is over."
        )
        await pilot.pause()
        while isinstance(pilot.app.screen, PlayScreen):  # the first ones close messages
            await pilot.press("escape")
            await pilot.pause()
        assert "2 games that were to follow are dropped." in pilot.text()


@pytest.mark.slow
async def test_another_game_starts_running_after_a_paused_one(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        screen = await over(pilot)
        await pilot.press("p", "g", "y")
        await pilot.pause(0.1)
        status = screen.query_one(StatusLine).status
        assert (status.game, status.note) == (2, "x1000")
        while screen.query_one(Transcript).count < 3:
            await pilot.pause(0.02)


@pytest.mark.slow
async def test_another_game_clears_the_messages_of_the_one_before(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy), notifications=True) as pilot:
        screen = await over(pilot)
        screen.notify("You ended the game.", timeout=600)
        await until_shown(pilot, lambda: "You ended the game." in told(pilot))
        screen.picture.tell(screen.control.begin(), pace=0)
        assert screen.control.supervision.games == 2
        await until_shown(pilot, lambda: "You ended the game." not in told(pilot))


# ------------------------------------------------------------------------- while Tangy asks


@pytest.mark.slow
@pytest.mark.parametrize("key", ["g", "full_stop", "E"])
async def test_a_key_that_must_wait_for_the_answer_says_so_in_the_panel(
    run: Run, workspace: Workspace, gappy: Policy, key: str
) -> None:
    async with run(app=playing(workspace, gappy), notifications=True) as pilot:
        screen = await asked(pilot)
        await pilot.press("escape", key)
        await pilot.pause()
        assert "answer first" in " ".join(pilot.text().split())
        assert not told(pilot)
        assert screen.games == 1


@pytest.mark.slow
async def test_the_keys_after_a_stop_list_the_working_ones(
    run: Run, workspace: Workspace, gappy: Policy
) -> None:
    async with run(app=playing(workspace, gappy), notifications=True) as pilot:
        screen = await asked(pilot)
        await pilot.press("escape")
        line = screen.query_one(CommandInput)
        assert "p pause" in line.placeholder
        await pilot.press("ctrl+x")
        await pilot.pause()
        assert "p go on" in line.placeholder
        await pilot.press("E", "y")
        await pilot.pause()
        assert "Not now: Tangy was stopped. Press p to go on first." in pilot.text()
        await pilot.press("p", "escape")
        await pilot.pause()
        assert "p pause" in line.placeholder
        assert "Not now" not in pilot.text()


async def test_the_key_line_of_a_paused_game_shows_how_to_resume(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy), size=SMALL) as pilot:
        await pilot.press("p")
        await pilot.pause()
        assert pilot.lines()[-1].strip().startswith("p go on")
        await pilot.press("p")
        await pilot.pause()
        assert pilot.lines()[-1].strip().startswith("p pause")


@pytest.mark.slow
async def test_no_message_covers_a_question(
    run: Run, workspace: Workspace, gappy: Policy, tmp_path: Path
) -> None:
    async with run(app=playing(workspace, gappy), notifications=True) as pilot:
        screen = await asked(pilot)
        program: Any = pilot.app
        program.say("Saved in the meantime.")
        await pilot.pause()
        assert not told(pilot)
        assert "Saved in the meantime." in pilot.text()
        assert screen.query_one(LogView).sentences[-1] == "Saved in the meantime."
        await answer(pilot)
        while screen.query(AskingPanel):
            await pilot.pause(0.02)
        await pilot.press("E", "y")
        await asked(pilot)
        await pilot.pause()
        assert not told(pilot)
        assert "Learnt from ann: " in pilot.text()


async def test_the_help_lists_the_panels_and_how_to_answer(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        help = help_for(pilot.app.screen)
        assert {"1", "2", "3", "4", "5"} <= {key for key, _ in help.here}
        assert ": goes back to it" in help.paragraphs[0]


# --------------------------------------------------------------------------- policies to read


async def test_the_effects_are_shown_from_their_beginning(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async def start(program: Program) -> None:
        effects = effects_of(workspace.store, workspace.activity, policy)
        await program.push_screen(PolicyScreen(workspace, policy, effects))

    async with run(app=Program(workspace, start, clock=StillClock()), size=SMALL) as pilot:
        effects = pilot.app.screen.query_one("#effects", LogView)
        assert effects.max_scroll_y > 0
        assert effects.scroll_offset.y == 0


def test_a_note_with_one_demonstration_uses_the_singular(
    workspace: Workspace, cover: Cover
) -> None:
    log_demonstration(workspace.store, cover("bingo", 1, 4)[0])
    notes = [option.note for option in comparison_options(workspace.store, workspace.activity)]
    assert "what 1 demonstration teaches" in notes
