"""Playing, policy, people, home and the demo: driven with keys, at both sizes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from textual.app import App
from textual.pilot import Pilot

from tangy_tui.app.staff_view import next_step
from tangy_tui.app.training import learn
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.library import effects_of
from tangy_tui.learning.policy import Policy
from tangy_tui.learning.scripted_teacher import ScriptedTeacher
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.dialogs.why import WhyDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.demonstration import DemonstrationScreen
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.screens.people import PeopleScreen
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.screens.policy import PolicyScreen, policy_rows
from tangy_tui.ui.screens.teach import TeachScreen
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.policy_table import PolicyTable
from tangy_tui.ui.widgets.posteriors import Posteriors
from tangy_tui.ui.widgets.status_line import StatusLine
from tangy_tui.ui.widgets.transcript import Transcript
from tests.pilot.conftest import LARGE, SMALL, Run, StillClock, screen_text
from tests.support.waiting import until_shown


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


@pytest.fixture
def policy(learnt: Policy) -> Policy:
    """The policy that was learnt there."""
    return learnt


@pytest.fixture
def untaught(tmp_path: Path) -> Iterator[Workspace]:
    """A workspace without demonstrations."""
    opened = Workspace(tmp_path / "untaught")
    yield opened
    opened.close()


def playing(workspace: Workspace, policy: Policy, *, speed: float = 1, games: int = 1) -> Program:
    """Make the program with the playing screen open; at speed 1 only keys move the game."""

    async def start(started: Program) -> None:
        supervision = workspace.supervision(policy, 5)
        await started.push_screen(PlayScreen(workspace, supervision, games=games, speed=speed))

    return Program(workspace, start, clock=StillClock())


async def pause_at_once(pilot: Pilot[None]) -> PlayScreen:
    """Pause the game and return its screen."""
    await pilot.press("p")
    await pilot.pause()
    screen = pilot.app.screen
    assert isinstance(screen, PlayScreen)
    return screen


@pytest.mark.slow
async def test_the_step_key_plays_one_step(run: Run, workspace: Workspace, policy: Policy) -> None:
    async with run(app=playing(workspace, policy), size=LARGE) as pilot:
        screen = await pause_at_once(pilot)
        before = screen.query_one(Transcript).count
        for more in (1, 2, 3):
            await pilot.press("full_stop")
            await pilot.pause()
            assert screen.query_one(Transcript).count == before + more
        assert screen.query_one(StatusLine).status.note == "paused"


@pytest.mark.slow
async def test_the_staff_panel_follows_a_simulated_game(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy), size=SMALL) as pilot:
        screen = await pause_at_once(pilot)
        await pilot.press("u")
        await pilot.pause()
        for _ in range(4):
            await pilot.press("full_stop")
            await pilot.pause()
            called = len(screen.control.supervision.world.scene().called)
            assert f"{called} called" in screen_text(pilot.app) or not called
        assert called


@pytest.mark.slow
async def test_the_policy_row_in_use_is_marked(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy), size=LARGE) as pilot:
        screen = await pause_at_once(pilot)
        for _ in range(3):
            await pilot.press("full_stop")
            await pilot.pause()
        table = screen.query_one(PolicyTable)
        assert table.marked is not None
        assert table.rows[table.marked].behaviour == "call number"


@pytest.mark.slow
async def test_skipping_plays_the_game_to_its_end(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        screen = await pause_at_once(pilot)
        await pilot.press("E", "y")
        while not screen.control.supervision.over:
            await pilot.pause(0.02)
        await pilot.pause()
        assert "The game is over" in screen.query_one(LogView).sentences[-1]
        assert screen.query_one(StatusLine).status.stage == "the game is over"
        assert workspace.store.last("game ended") is not None
        assert screen.query_one(Posteriors).display  # beliefs about the people
        await pilot.press("g", "y")
        await pilot.pause()
        assert screen.query_one(StatusLine).status.game == 2


@pytest.mark.slow
async def test_the_speed_ranges_from_real_time_to_a_thousand_times(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        screen = pilot.app.screen
        await pilot.press("p", "p")
        for _ in range(12):
            await pilot.press("greater_than_sign")
        await pilot.press("p")
        await pilot.press("p")
        await pilot.pause()
        assert screen.query_one(StatusLine).status.note == "x1000"
        for _ in range(12):
            await pilot.press("less_than_sign")
        await pilot.pause()
        assert screen.query_one(StatusLine).status.note == "x1"


@pytest.mark.slow
async def test_stop_holds_until_a_person_resumes(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        screen = pilot.app.screen
        await pilot.press("ctrl+x")
        await pilot.pause()
        count = screen.query_one(Transcript).count
        assert screen.query_one(StatusLine).status.alarm
        assert "STOPPED" in screen_text(pilot.app)
        await pilot.press("greater_than_sign", "less_than_sign")
        await pilot.pause()
        assert screen.query_one(Transcript).count == count
        assert "STOPPED" in screen_text(pilot.app)
        await pilot.press("full_stop")
        await pilot.pause()
        assert screen.query_one(Transcript).count == count
        await pilot.press("p")
        await pilot.pause()
        assert "STOPPED" not in screen_text(pilot.app)


@pytest.mark.slow
async def test_panels_are_chosen_by_number_in_a_small_window(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy), size=SMALL) as pilot:
        await pause_at_once(pilot)
        for key, title in (
            ("2", "Steps"),
            ("3", "Policy"),
            ("4", "What works with whom, simulated games"),
            ("5", "Log"),
        ):
            await pilot.press(key)
            await pilot.pause()
            assert f" {title} " in screen_text(pilot.app)


@pytest.mark.parametrize("size", [(80, 24), (80, 20)])
async def test_the_enlarged_room_fills_the_screen(
    run: Run, workspace: Workspace, policy: Policy, size: tuple[int, int]
) -> None:
    async with run(app=playing(workspace, policy), size=size) as pilot:
        screen = await pause_at_once(pilot)
        room, keys = screen.query_one("#room"), screen.query_one("#keys")
        beside = room.region.height
        await pilot.press("1")
        await pilot.pause()
        assert room.region.bottom == keys.region.y
        await pilot.press("2")
        await pilot.pause()
        assert room.region.height == beside


@pytest.mark.slow
async def test_an_undemonstrated_situation_ends_the_game_with_the_reason(
    run: Run, untaught: Workspace
) -> None:
    teaching = untaught.teaching("ann", 1)
    teacher = ScriptedTeacher(teaching)
    teaching.begin()
    for _ in range(4):
        teaching.apply(teacher.command())
    from tangy_tui.learning.library import read_demonstrations
    from tangy_tui.learning.policy import learn_policy

    poor = learn_policy(
        untaught.activity, read_demonstrations(untaught.store, untaught.activity.name)
    )
    async with run(app=playing(untaught, poor), size=LARGE) as pilot:
        screen = await pause_at_once(pilot)
        await pilot.press("E", "y")
        while not isinstance(pilot.app.screen, MessageDialog):
            await pilot.pause(0.02)
        assert "Nobody has shown Tangy" in screen_text(pilot.app)
        assert "Nobody has shown Tangy" in screen.query_one(LogView).sentences[-1]
        assert screen.query_one(StatusLine).status.alarm


@pytest.mark.slow
@pytest.mark.parametrize("size", [SMALL, LARGE], ids=["small", "large"])
async def test_the_play_screen_matches_its_picture(
    run: Run,
    workspace: Workspace,
    policy: Policy,
    size: tuple[int, int],
    picture: Callable[[App[None]], None],
) -> None:
    async with run(app=playing(workspace, policy), size=size) as pilot:
        await pause_at_once(pilot)
        for _ in range(12):
            await pilot.press("full_stop")
            await pilot.pause()
        picture(pilot.app)


async def test_the_policy_screen_marks_undemonstrated_situations(
    run: Run, untaught: Workspace
) -> None:
    teaching = untaught.teaching("ann", 1)
    teacher = ScriptedTeacher(teaching)
    teaching.begin()
    for _ in teacher.demonstrate():
        pass
    policy = learn(untaught)
    unseen = [row for row in policy_rows(untaught.activity, policy) if not row.seen]
    assert unseen, "this game was to leave something out"

    async def start(program: Program) -> None:
        effects = effects_of(untaught.store, untaught.activity, policy)
        await program.push_screen(PolicyScreen(untaught, policy, effects))

    async with run(app=Program(untaught, start, clock=StillClock()), size=LARGE) as pilot:
        shown = screen_text(pilot.app)
        assert f"{11 - len(unseen)} of 11 situations were shown" in shown
        assert "never shown" in shown
        await pilot.press("escape")
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)


@pytest.mark.slow
async def test_home_leads_everywhere_and_back(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    ways = {"t": TeachScreen, "o": PolicyScreen, "e": PeopleScreen, "p": PlayScreen}
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        assert "3 demonstrations" in screen_text(pilot.app)
        for key, kind in ways.items():
            await pilot.press(key, "enter")
            while not isinstance(pilot.app.screen, kind):
                await pilot.pause(0.02)
            if kind is TeachScreen:
                await pilot.press("escape")  # out of the command line
            await pilot.press("escape")
            await pilot.pause()
            if kind is PlayScreen:
                assert "Leave in the middle of the game?" in screen_text(pilot.app)
                await pilot.press("y")
                await pilot.pause()
            assert isinstance(pilot.app.screen, HomeScreen), key


async def test_playing_before_learning_explains_what_to_do(run: Run, untaught: Workspace) -> None:
    async with run(app=Program(untaught, clock=StillClock())) as pilot:
        await pilot.press("p", "enter")
        while not isinstance(pilot.app.screen, MessageDialog):
            await pilot.pause(0.02)
        assert "has not learnt Bingo yet" in screen_text(pilot.app)
        await pilot.press("enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)


async def test_learning_from_home_shows_the_policy(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.press("l", "enter")
        while not isinstance(pilot.app.screen, PolicyScreen):
            await pilot.pause(0.02)
        assert "Learnt from 3 demonstrations" in screen_text(pilot.app)


async def test_two_letters_at_home_are_one_choice(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.press("o", "enter", "p", "enter", "l")
        while not isinstance(pilot.app.screen, PolicyScreen):
            await pilot.pause(0.02)
        await pilot.press("escape")
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)


@pytest.mark.slow
async def test_why_explains_the_next_and_the_last_or_the_chosen_step(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        screen = await pause_at_once(pilot)
        while not any(ground.acted.choice for ground in screen.picture.grounds):
            await pilot.press("full_stop")
            await pilot.pause()
        ground = screen.picture.grounds[-1]
        assert ground.acted.choice is not None
        await pilot.press("w")
        await pilot.pause()
        dialog, text = pilot.app.screen, screen_text(pilot.app)
        assert isinstance(dialog, WhyDialog)
        coming = next_step(screen.control.supervision.world, policy)
        assert coming is not None
        assert dialog.coming is not None
        assert dialog.coming.why.situation == coming[1].situation
        assert dialog.coming.why.decision.behaviour == coming[0].behaviour
        assert dialog.coming.words in " ".join(text.replace("│", " ").split())
        assert dialog.why.situation == ground.acted.state.situation
        assert f"Step {len(screen.picture.grounds)}, the last one" in text
        await pilot.press("end")
        text += screen_text(pilot.app)
        for number in ground.acted.choice.draws.values():
            assert f"{number:.3f}" in text
        await pilot.press("escape", "2", "home", "enter")
        await pilot.pause()
        assert "Step 1: why this?" in screen_text(pilot.app)
        await pilot.press("enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, DemonstrationScreen)
        await pilot.press("escape")
        await pilot.pause()
        await pilot.press("escape")
        await pilot.pause()
        await pilot.press("escape")
        await pilot.pause()
        assert screen.query_one(Transcript).chosen is None
        assert "Leave" not in screen_text(pilot.app)


@pytest.mark.slow
@pytest.mark.parametrize("words", ["why", "what are you doing"])
async def test_a_typed_question_explains_what_tangy_does(
    run: Run, workspace: Workspace, policy: Policy, words: str
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        await pause_at_once(pilot)
        await pilot.press(":", *words, "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, WhyDialog))


async def test_leaving_during_a_game_asks_and_is_logged(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    async with run(app=playing(workspace, policy)) as pilot:
        await pilot.press("escape")
        await pilot.pause()
        assert "Leave in the middle of the game?" in screen_text(pilot.app)
        await pilot.press("n")
        await pilot.pause()
        assert isinstance(pilot.app.screen, PlayScreen)
        assert pilot.app.screen.query_one(StatusLine).status.note == "x1"
        assert workspace.store.last("game ended") is None
        assert workspace.store.last("staff action") is None  # the question is no pause
        await pilot.press("escape")
        await pilot.pause()
        await pilot.press("y")
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)
    ended = workspace.store.last("game ended")
    assert ended is not None
    assert ended.body["stopped"] == "It was left before its end."
