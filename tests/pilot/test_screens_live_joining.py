"""A new person joins on the live screen, and the game goes on with them."""

from __future__ import annotations

import threading
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager

import pytest

from tangy_hw.cancellation import Cancellation
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.errors import TangyError
from tangy_profiles.game_records import GameEnding
from tangy_profiles.staff_records import StaffAction
from tangy_tui.app.game_commands import SetAutonomy, StopRobot
from tangy_tui.app.game_view import view_of
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.text.watching import stage_words
from tangy_tui.ui.dialogs.switching_on import SwitchingOnDialog
from tangy_tui.ui.live_games import play_live
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.live import LiveScreen
from tests.pilot.conftest import Run, StillClock, TangyPilot
from tests.pilot.live_games import HeldLink, held_world, live, paused_after
from tests.support.waiting import until_shown


class Robot:
    """A robot that is switched on again for each group of people."""

    def __init__(self, workspace: Workspace) -> None:
        self.groups: list[tuple[str, ...]] = []
        self.off = 0
        self.links: list[HeldLink] = []
        self.workspace = workspace
        self.closing: threading.Event | None = None
        """Set when it may be switched off; None: at once."""
        self.broken = False
        """Whether it does not come on."""
        self.meanwhile: Callable[[], object] = lambda: None
        """Called while it is switched on."""

    @contextmanager
    def __call__(self, stepped: bool, cancellation: Cancellation) -> Iterator[LiveWorld]:
        if self.broken:
            raise TangyError("The laser scanner does not answer.")
        self.meanwhile()
        people = tuple(self.workspace.names)
        self.groups.append(people)
        link = HeldLink(people)
        link.most = 3  # calls, at most
        self.links.append(link)
        try:
            yield held_world(self.workspace, link)
        finally:
            if self.closing is not None:
                self.closing.wait()
            self.off += 1


@asynccontextmanager
async def paused_game(run: Run, robot: Robot, policy: Policy) -> AsyncIterator[TangyPilot]:
    """Play on the live screen with a robot, and pause after two steps."""

    async def start(program: Program) -> None:
        await play_live(program, robot, policy, games=1, seed=1, teacher="ann")

    program = Program(robot.workspace, start, clock=StillClock())
    async with run(app=program, size=(160, 45)) as pilot:
        await until_shown(pilot, lambda: len(robot.groups) == 1 and "game 1" in pilot.text())
        await paused_after(pilot, robot.links[0], 2)
        yield pilot


@pytest.mark.slow
async def test_a_new_person_joins_a_game_on_the_screen(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    robot = Robot(workspace)
    async with paused_game(run, robot, policy) as pilot:
        first = live(pilot)
        called = tuple(first.world.called)
        first.control.apply(SetAutonomy("each"))
        first.games += 1  # as if another game followed
        await pilot.press("L")
        await until_shown(pilot, lambda: "somebody new" in pilot.text())
        await pilot.press(*"new", "enter")
        await until_shown(pilot, lambda: "Who has come?" in pilot.text())
        await pilot.press(*"Berta", "enter")
        await until_shown(pilot, lambda: "Is Berta here for good?" in pilot.text())
        await pilot.press("enter")
        await until_shown(pilot, lambda: "Where does Berta sit?" in pilot.text())
        await pilot.press("down", "enter")
        await until_shown(pilot, lambda: "Berta has joined." in pilot.text())
        assert live(pilot) is not first
        assert robot.off == 1 and robot.groups[1] == (*robot.groups[0][:3], "user5", "user4")
        assert workspace.name("user5") == "Berta"
        assert tuple(live(pilot).world.called)[: len(called)] == called
        assert not live(pilot).control.going  # as before
        assert live(pilot).control.autonomy.level == "each" and live(pilot).games == 2


@pytest.mark.slow
async def test_the_screen_says_for_whom_tangy_is_set_up_anew(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    robot = Robot(workspace)
    robot.closing = threading.Event()
    try:
        async with paused_game(run, robot, policy) as pilot:
            first = live(pilot)
            await pilot.press(":", *"add Berta", "enter")
            await until_shown(pilot, lambda: "sets itself up for Berta │ game 1" in pilot.text())
            now = "Tangy sets itself up for Berta. Then the game goes on."
            await until_shown(pilot, lambda: now in pilot.text())
            text = pilot.text()
            assert "the game goes on" in pilot.lines()[0]
            assert "play again" not in text and "is over" not in text
            view = view_of(first.control)
            assert view is not None and "somebody new joins" in stage_words(view)
            await pilot.press("g", "escape")
            assert pilot.app.screen is first  # both wait
            robot.closing.set()
            await until_shown(pilot, lambda: "Berta has joined." in pilot.text())
            assert live(pilot) is not first
    finally:
        robot.closing.set()


@pytest.mark.slow
async def test_a_game_is_kept_if_the_robot_does_not_come_on_again(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    robot = Robot(workspace)
    async with paused_game(run, robot, policy) as pilot:
        first, robot.broken = live(pilot), True
        await pilot.press(":", *"add Berta", "enter")
        await until_shown(pilot, lambda: "does not answer" in pilot.text())
        assert "the game is kept" in pilot.text()
        robot.broken = False
        called = tuple(first.world.called)
        await pilot.press("y")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, LiveScreen))
        assert live(pilot) is not first and robot.groups[-1][-1] == "user5"
        await until_shown(pilot, lambda: bool(live(pilot).world.called))
        assert tuple(live(pilot).world.called) == called


@pytest.mark.slow
async def test_a_stop_that_leaves_the_robot_off_holds_when_it_is_switched_on_again(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    robot = Robot(workspace)
    async with paused_game(run, robot, policy) as pilot:
        first = live(pilot)
        await pilot.press(":", *"add Berta", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, SwitchingOnDialog))
        await pilot.press("ctrl+x")
        await until_shown(pilot, lambda: "You stopped it" in pilot.text())
        await pilot.press("y")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, LiveScreen))
        second = live(pilot)
        assert second is not first
        await until_shown(pilot, lambda: second.control.phase == "stopped")
        assert not second.world.link.state.going


@pytest.mark.slow
async def test_a_stop_meanwhile_holds(run: Run, workspace: Workspace, policy: Policy) -> None:
    robot = Robot(workspace)
    async with paused_game(run, robot, policy) as pilot:
        first = live(pilot)
        robot.meanwhile = lambda: first.control.apply(StopRobot(by="Nina"))
        await pilot.press(":", *"add Berta", "enter")
        await until_shown(pilot, lambda: "Nina stopped the robot" in pilot.text())
        second = live(pilot)
        await until_shown(pilot, lambda: "back where it was" in pilot.text())
        assert second is not first and second.control.phase == "stopped"
        await until_shown(pilot, lambda: "Nina stopped Tangy." in pilot.text())
        assert tuple(second.world.called) == tuple(first.world.called)
        assert robot.links[1].held_by and not robot.links[1].done
        await pilot.press("p")
        await until_shown(pilot, lambda: "Let the robot move again?" in pilot.text())
        await pilot.press("y")
        await until_shown(pilot, lambda: second.control.phase == "running")
        assert not second.control.stopped and not robot.links[1].held_by


@pytest.mark.slow
async def test_a_person_who_leaves_is_drawn_as_away_at_once(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    robot = Robot(workspace)
    async with paused_game(run, robot, policy) as pilot:
        assert "○" not in pilot.text()
        await pilot.press(":", *"User 2 left", "enter")
        await until_shown(pilot, lambda: "○" in pilot.text())
        assert not live(pilot).control.going


@pytest.mark.slow
@pytest.mark.parametrize("leaves", [False, True])
async def test_a_question_that_is_open_when_somebody_joins_is_answered_first(
    run: Run, workspace: Workspace, policy: Policy, leaves: bool
) -> None:
    robot = Robot(workspace)
    async with paused_game(run, robot, policy) as pilot:
        first = live(pilot)
        robot.links[0].free = False  # it is on its way to the front
        await pilot.press(":", *"add Berta", "enter")
        await until_shown(pilot, lambda: first.control.welcomes == ("Berta",))
        await pilot.press("escape")
        await until_shown(pilot, lambda: "Leave in the middle of the game?" in pilot.text())
        robot.links[0].free = True
        await until_shown(pilot, lambda: first.control.joined)
        await pilot.pause(0.2)
        assert "Leave in the middle of the game?" in pilot.text() and len(robot.groups) == 1
        await pilot.press("y" if leaves else "n")
        if leaves:
            await until_shown(pilot, lambda: robot.off == 1)
            ends = [event.record for event in workspace.store.events(GameEnding)]
            assert len(ends) == 1 and len(robot.groups) == 1
            did = [event.record.did for event in workspace.store.events(StaffAction)]
            assert did == ["paused", "came", "ended"]
        else:
            await until_shown(pilot, lambda: "Berta has joined." in pilot.text())
            assert len(robot.groups) == 2
