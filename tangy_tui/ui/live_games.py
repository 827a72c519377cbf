"""Live games in the application: switch the robot on, play, switch it off."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from textual.constants import ESCAPE_DELAY

from tangy_profiles import game_world
from tangy_profiles.errors import TangyError
from tangy_tui.text.live_games import (
    GAME_KEPT,
    KEEPS_IF_OFF,
    STOPPED_MEANWHILE,
    SWITCH_ON_DETAIL,
    TRY_AGAIN,
    parts_lines,
    switch_on_words,
)
from tangy_tui.ui.interruption import ask_about_interrupted

if TYPE_CHECKING:
    from tangy_hw.robot_client.live_world import LiveWorld
    from tangy_profiles.past_game import PastGame
    from tangy_tui.app.robot_opening import WorldOpening
    from tangy_tui.app.set_up import SetUp
    from tangy_tui.app.switching_on import SwitchingOn
    from tangy_tui.learning.policy import Policy
    from tangy_tui.ui.program import Program
    from tangy_tui.ui.screens.live import LiveScreen

TYPED_AHEAD_SECONDS = 1.5 * ESCAPE_DELAY
"""After this time in s, an Esc typed before the screen was open has been recognised as a key."""


async def play_from_home(program: Program, policy: Policy) -> None:
    """Set up and play: with the robot, if its file names drivers, otherwise on the bench."""
    from tangy_tui.app.robot_opening import opening_of

    workspace = program.workspace
    bench, room = not workspace.robot.drivers, workspace.chosen_room
    chosen = await ask_about_interrupted(program, game_world.BENCH if bench else game_world.LIVE)
    if chosen is None:
        return
    past = chosen.past
    seed = workspace.game_seed(None) if past is None else past.beginning.seed
    opening = opening_of(workspace, bench=bench, seed=seed)
    try:
        await play_live(
            program, opening, policy, games=1, seed=seed, teacher="", past=past, set_up=past is None
        )
    finally:
        if past is not None:
            workspace.leave_resumed_game(room)


async def play_live(
    program: Program,
    opening: WorldOpening,
    policy: Policy,
    *,
    games: int,
    seed: int,
    teacher: str,
    past: PastGame | None = None,
    set_up: bool = False,
    pace: float | None = None,
) -> None:
    """Switch the robot on, play on the live screen, and switch it off again.

    It stays off if the user cancels. A past game, which was interrupted, is resumed first. With
    `set_up`, staff set the game up first and decide when to switch the robot on. The `pace` is in s
    from call to call; None: the usual one, or that of the last game.
    """
    from tangy_tui.app.joining import resume_joined
    from tangy_tui.app.robot_opening import at_front
    from tangy_tui.app.set_up import SetUp

    workspace = program.workspace
    setup = SetUp.of(workspace, pace)
    as_before = past is None and setup.offer_last_plan()
    if past is not None:  # the set-up has seated people as they sat when the game began
        workspace.gather(past.beginning.people)
    played = await _play(
        program, opening, policy, games=games, seed=seed, teacher=teacher, past=past,
        setup=setup, set_up=set_up, as_before=as_before and not set_up,
    )  # fmt: skip
    while played is not None and played.control.joined:
        played.control.admit_no_more()
        past = resume_joined(workspace, played.world.played_in)
        policy, left = played.control.supervision.policy, played.games - played.tally.games
        before = played
        try:
            played = await _play(
                program, at_front(opening), policy, games=left, seed=seed, teacher=teacher,
                past=past, setup=setup, before=before,
            )  # fmt: skip
        finally:
            workspace.door.detach(before.control)


async def _play(
    program: Program,
    opening: WorldOpening,
    policy: Policy,
    *,
    games: int,
    seed: int,
    teacher: str,
    past: PastGame | None,
    setup: SetUp,
    set_up: bool = False,
    as_before: bool = False,
    before: LiveScreen | None = None,
) -> LiveScreen | None:
    """Play with the robot on; return the screen, whose game may only be interrupted.

    With `as_before`, it tells what the game takes from the last one.
    `before` is the screen of a game that a person has joined: it goes on as it was.
    """
    from tangy_tui.app.switching_on import SwitchingOn

    workspace = program.workspace
    robot, activity = SwitchingOn(opening), workspace.profile
    try:
        if set_up:
            world = await _set_up(program, setup, robot)
        else:
            world = await _switch_on(program, robot, before)
            while world is None and before is not None and await _again(program, robot, before):
                await asyncio.to_thread(robot.close)  # it may have come on all the same
                robot = SwitchingOn(opening)
                world = await _switch_on(program, robot, before)
        if world is None:
            return None
        from tangy_tui.app.joining import Admission, carry_over
        from tangy_tui.learning.policies import load_policy
        from tangy_tui.text.calls import REHEARSAL
        from tangy_tui.text.set_up import as_before_words
        from tangy_tui.ui.screens.live import LiveScreen

        if workspace.profile != activity:
            policy, _ = load_policy(workspace.store, workspace.activity)
        if past is None:
            setup.carry_out(world)
        supervision = workspace.supervision(
            policy, seed, asks=True, world=world, rehearsal=REHEARSAL
        )
        screen = LiveScreen(
            workspace, supervision, world, games=games, teacher=teacher or setup.on_duty, past=past
        )
        screen.control.admission = Admission(workspace, world)
        screen.closes, screen.took = robot.close, robot.took
        screen.takes = as_before_words(setup) if as_before else ""
        if before is not None:
            workspace.door.attach(screen.control)
            screen.control.follow(before.control)
            screen.picture.goes_on = before.control.goes_on
            carry_over(before.world, world)
        if program.hearing is not None:
            program.hearing.ears.begin()
        await program.push_screen_wait(screen)
        return screen
    finally:
        await asyncio.shield(asyncio.to_thread(robot.close))


async def _set_up(
    program: Program, setup: SetUp, robot: SwitchingOn[LiveWorld]
) -> LiveWorld | None:
    """Let staff set the game up; None if they leave."""
    from tangy_tui.ui.activity_choice import choose_activity
    from tangy_tui.ui.dialogs.confirm import ConfirmDialog
    from tangy_tui.ui.screens.set_up import SetUpScreen

    async def switch_on() -> LiveWorld | None:
        profile = program.workspace.robot
        if profile.drivers:
            question = switch_on_words(profile.title)
            dialog = ConfirmDialog(question, SWITCH_ON_DETAIL, yes="switch it on", no="back")
            if not await program.push_screen_wait(dialog):
                return None
        return await _switch_on(program, robot)

    async def choose() -> None:
        await choose_activity(program, setup.play)

    begins = await program.push_screen_wait(SetUpScreen(setup, switch_on, choose))
    return setup.world if begins else None


async def _again(program: Program, robot: SwitchingOn[LiveWorld], before: LiveScreen) -> bool:
    """Ask whether to switch a robot on once more, for a game that is kept otherwise.

    Staff who left it off are not asked.
    """
    from tangy_tui.ui.dialogs.confirm import ConfirmDialog
    from tangy_tui.ui.dialogs.message import MessageDialog

    if not robot.failure and not before.control.stopped:
        await program.push_screen_wait(MessageDialog(GAME_KEPT, title="Not yet"))
        return False
    why = " ".join([robot.failure or STOPPED_MEANWHILE, KEEPS_IF_OFF])
    dialog = ConfirmDialog(TRY_AGAIN, why, yes="switch it on", no="leave it off")
    return await program.push_screen_wait(dialog)


async def _switch_on(
    program: Program, robot: SwitchingOn[LiveWorld], before: LiveScreen | None = None
) -> LiveWorld | None:
    """Switch a robot on behind a dialog; None if that was cancelled, or failed.

    A robot that came on just as it was cancelled is switched off again. `before` is the screen of a
    game that a person has joined: a STOP holds for it, and why the robot is off is left to tell.
    """
    from tangy_hw.cancellation import Cancelled
    from tangy_hw.device_protocols import DeviceFailed
    from tangy_profiles.known_devices import can_be_left_out
    from tangy_tui.app.game_commands import StopRobot
    from tangy_tui.ui.dialogs.message import MessageDialog
    from tangy_tui.ui.dialogs.switching_on import SwitchingOnDialog

    profile = program.workspace.robot
    dialog = SwitchingOnDialog(
        profile.title,
        robot.cancel,
        lambda: parts_lines(robot.parts, robot.done, profile),
        joins=() if before is None else before.control.welcomes,
        seconds=0.0 if before is None else before.took,
    )
    robot.failure, failed = "", ""
    program.push_screen(dialog)
    await dialog.shown()
    await asyncio.sleep(TYPED_AHEAD_SECONDS)
    opening = asyncio.ensure_future(asyncio.to_thread(robot.open))
    opening.add_done_callback(_heard)
    try:
        world = await asyncio.shield(opening)
        if not dialog.called_off:
            return world
    except Cancelled:
        pass
    except TangyError as error:
        robot.failure = str(error)
        failed = error.device if isinstance(error, DeviceFailed) else ""
    except asyncio.CancelledError:  # the program is ending
        robot.cancel()
        raise
    finally:
        dialog.over()
        if before is not None and dialog.stopped:
            before.control.apply(StopRobot())
    if can_be_left_out(profile, failed):
        if await _leaves_out(program, failed, robot.failure):
            return await _switch_on(program, robot, before)
    elif robot.failure and before is None:
        await program.push_screen_wait(MessageDialog(robot.failure, title="Not yet"))
    return None


async def _leaves_out(program: Program, device: str, why: str) -> bool:
    """Ask whether to go on without a device that does not start, and leave it out then."""
    from tangy_profiles.known_devices import left_out
    from tangy_tui.text.missing_devices import go_on_without, without_words
    from tangy_tui.ui.dialogs.confirm import ConfirmDialog

    workspace = program.workspace
    question = go_on_without(workspace.robot, device)
    detail = without_words(workspace.robot, device, workspace.activity, why)
    dialog = ConfirmDialog(question, detail, yes="go on without it", no="leave it off")
    if not await program.push_screen_wait(dialog):
        return False
    workspace.robot = left_out(workspace.robot, device)
    return True


def _heard(opening: asyncio.Future[LiveWorld]) -> None:
    """Retrieve the exception of an opening that nobody may await any more."""
    if not opening.cancelled():
        opening.exception()
