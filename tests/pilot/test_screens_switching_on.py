"""The dialog during the opening of a robot; every exit cancels the opening."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from textual.app import App

from tangy_hw.cancellation import Cancellation
from tangy_hw.device_protocols import DeviceError, DeviceFailed
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.game_rules import GamePlan
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.text.live_games import STARTING, starting_again_words
from tangy_tui.ui.dialogs.switching_on import SwitchingOnDialog
from tangy_tui.ui.live_games import play_live
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.help import HelpScreen
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.screens.live import LiveScreen
from tests.pilot.conftest import Run, StillClock, TangyPilot
from tests.pilot.live_games import HeldLink, held_world, paused_after
from tests.support.waiting import until, until_shown


class Robot:
    """A robot whose devices answer when the test allows it."""

    def __init__(self, workspace: Workspace, wrong: DeviceError | None = None) -> None:
        self.did: list[str] = []
        self.answers = threading.Event()
        self.link = HeldLink()
        self._workspace = workspace
        self._wrong = wrong

    @contextmanager
    def __call__(self, stepped: bool, cancellation: Cancellation) -> Iterator[LiveWorld]:
        cancellation.starts("bench")
        cancellation.starts("faces", 3, 12)
        self.did.append("begins")
        cancellation.register(self.answers.set)
        try:
            assert self.answers.wait(20)
            cancellation.check()
            if self._wrong is not None:
                raise self._wrong
            self.did.append("is on")
            yield held_world(self._workspace, self.link)
        finally:
            self.did.append("is off")


def program(workspace: Workspace, policy: Policy, robot: Robot) -> Program:
    async def start(program: Program) -> None:
        await play_live(program, robot, policy, games=1, seed=1, teacher="ann")
        robot.did.append("over")

    return Program(workspace, start, clock=StillClock())


async def switching(pilot: TangyPilot, robot: Robot) -> None:
    await until_shown(pilot, lambda: "Starting now" in pilot.text() and robot.did == ["begins"])


@pytest.mark.slow
@pytest.mark.parametrize("size", [(80, 24), (120, 40)], ids=["80x24", "120x40"])
async def test_the_dialog_shows_the_progress_and_how_to_cancel(
    run: Run,
    workspace: Workspace,
    policy: Policy,
    looks: Callable[[App[Any]], None],
    size: tuple[int, int],
) -> None:
    robot = Robot(workspace)
    async with run(app=program(workspace, policy, robot), size=size) as pilot:
        await switching(pilot, robot)
        assert "Starting now: pictures of people's faces (3 of 12) ..." in pilot.text()
        assert "Ready: simulated devices and people." in pilot.text()
        looks(pilot.app)


@pytest.mark.parametrize(
    ("joins", "until_when"), [((), STARTING), (("Berta",), starting_again_words(("Berta",), 18.0))]
)
async def test_the_dialog_tells_until_when_the_robot_stands_still(
    run: Run, joins: tuple[str, ...], until_when: str
) -> None:
    dialog = SwitchingOnDialog("Tangy", lambda: None, joins=joins, seconds=18.0)
    async with run() as pilot:
        pilot.app.push_screen(dialog)
        await dialog.shown()
        shown = " ".join(pilot.text().replace("│", " ").split())
        assert until_when.split(". ")[1] in shown
        assert ("Berta joins. The game goes on in about 20 s:" in shown) is bool(joins)
        hides = dialog.styles.background.a == 1.0  # the home screen lies below
        assert hides is bool(joins)


@pytest.mark.slow
async def test_without_the_set_up_a_game_takes_the_last_plan_and_says_so(
    run: Run, workspace: Workspace, policy: Policy, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = GamePlan(("line",), absent=("user3",), pace=20.0, minutes=40)
    monkeypatch.setattr("tangy_tui.app.set_up.last_plan", lambda store, activity: before)
    robot = Robot(workspace)
    async with run(app=program(workspace, policy, robot), size=(120, 40)) as pilot:
        await switching(pilot, robot)
        robot.answers.set()
        await until_shown(pilot, lambda: "As you left your last game." in pilot.text())
        screen = pilot.app.screen
        assert isinstance(screen, LiveScreen)
        await until(lambda: screen.control.time.ends is not None)
        assert screen.control.plan.away == {"user3"} and screen.world.pace == 20.0


@pytest.mark.parametrize("key", ["escape", "ctrl+x"])
async def test_esc_and_stop_cancel_the_opening(
    run: Run, workspace: Workspace, policy: Policy, key: str
) -> None:
    robot = Robot(workspace)
    async with run(app=program(workspace, policy, robot)) as pilot:
        await switching(pilot, robot)
        await pilot.press(key)
        await until_shown(pilot, lambda: robot.did == ["begins", "is off", "over"])
        assert isinstance(pilot.app.screen, HomeScreen)


@pytest.mark.parametrize("leave", [lambda p: p.leave(), lambda p: p.exit()], ids=["left", "ended"])
async def test_quitting_the_program_cancels_the_opening(
    run: Run, workspace: Workspace, policy: Policy, leave: Callable[[Program], None]
) -> None:
    robot, app = Robot(workspace), None
    app = program(workspace, policy, robot)
    async with run(app=app) as pilot:
        await switching(pilot, robot)
        leave(app)
        await until(lambda: robot.did[:2] == ["begins", "is off"])  # no screen is left to draw


async def test_esc_typed_ahead_prevents_the_opening(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    """A slow window is closed before its text is readable."""
    robot = Robot(workspace)
    app = program(workspace, policy, robot)
    async with run(app=app) as pilot:
        await until_shown(pilot, lambda: isinstance(app.screen, SwitchingOnDialog))
        pilot.type("escape")
        await until_shown(pilot, lambda: robot.did == ["over"])


@pytest.mark.slow
async def test_the_game_begins_when_the_robot_answers_under_another_dialog(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    robot = Robot(workspace)
    async with run(app=program(workspace, policy, robot)) as pilot:
        await switching(pilot, robot)
        await pilot.press("question_mark")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, HelpScreen))
        robot.answers.set()
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, LiveScreen))
        assert not any(isinstance(s, SwitchingOnDialog) for s in pilot.app.screen_stack)
        await paused_after(pilot, robot.link, 1)


async def test_an_error_of_the_robot_is_shown(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    robot = Robot(workspace, DeviceError("The arms have no cable."))
    robot.answers.set()
    async with run(app=program(workspace, policy, robot)) as pilot:
        await until_shown(pilot, lambda: "The arms have no cable." in pilot.text())
        assert robot.did == ["begins", "is off"]
        await pilot.press("enter")
        await until_shown(pilot, lambda: robot.did[-1] == "over")


class WithoutArms(Robot):
    """A robot whose arms block, and which starts without them."""

    @contextmanager
    def __call__(self, stepped: bool, cancellation: Cancellation) -> Iterator[LiveWorld]:
        if "arms" in self._workspace.robot.devices:
            raise DeviceFailed("arms", "arms: its driver has not started within 27 s.")
        with super().__call__(stepped, cancellation) as world:
            yield world


@pytest.mark.parametrize("key", ["y", "n"])
async def test_staff_go_on_without_a_device_that_blocks_or_leave_the_robot_off(
    run: Run, workspace: Workspace, policy: Policy, key: str
) -> None:
    robot = WithoutArms(workspace)
    robot.answers.set()
    async with run(app=program(workspace, policy, robot), size=(120, 40)) as pilot:
        await until_shown(pilot, lambda: "Go on without the arms?" in pilot.text())
        text = " ".join(pilot.text().replace("│", " ").split())
        assert "arms: its driver has not started within 27 s." in text
        assert "The robot stands still, and is off." in text
        assert "This robot has no arms: Tangy makes no gestures." in text
        await pilot.press(key)
        if key == "y":
            await until_shown(pilot, lambda: isinstance(pilot.app.screen, LiveScreen))
            assert "is on" in robot.did
        else:
            await until_shown(pilot, lambda: isinstance(pilot.app.screen, HomeScreen))
            await until_shown(pilot, lambda: robot.did == ["over"])


async def test_a_robot_that_needs_the_device_that_blocks_stays_off(
    run: Run, workspace: Workspace, policy: Policy
) -> None:
    why = "stop_button: its driver has not started within 27 s."
    robot = Robot(workspace, DeviceFailed("stop_button", why))
    robot.answers.set()
    async with run(app=program(workspace, policy, robot)) as pilot:
        await until_shown(pilot, lambda: why in " ".join(pilot.text().split()))
        assert "Go on without" not in pilot.text()
