"""Runs the application on a terminal: what each command of the command line opens first."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tangy_profiles.game_world import PLAYED_WORLDS, SIMULATED
from tangy_profiles.reading import plain
from tangy_profiles.store import Store
from tangy_tui.app.game_to_play import GameToPlay
from tangy_tui.app.teacher_profile import change_theme, read_profile
from tangy_tui.app.user_settings import read_settings
from tangy_tui.app.workspace import Workspace
from tangy_tui.text.interruptions import to_be_resumed_words
from tangy_tui.text.live_games import played_lines, report_words
from tangy_tui.ui.app import run_app
from tangy_tui.ui.demo import tell_story
from tangy_tui.ui.drills import hold_drill
from tangy_tui.ui.interruption import ask_about_interrupted
from tangy_tui.ui.live_games import play_live
from tangy_tui.ui.program import Program, Start
from tangy_tui.ui.round_trip import read_replies
from tangy_tui.ui.terminal import terminal_kind
from tangy_tui.ui.writer import outlive_terminal

REPORT = "tangy report"
"""The command for the report of the last session, in the data folder of this user."""

if TYPE_CHECKING:
    from tangy_hw.perception.camera_hub import CameraHub
    from tangy_hw.robot_client.client import RobotLink
    from tangy_profiles.drill_sheet import Sheet
    from tangy_profiles.game_world import GameWorld
    from tangy_profiles.past_game import PastGame
    from tangy_tui.app.robot_opening import WorldOpening
    from tangy_tui.learning.policy import Policy
    from tangy_tui.learning.teaching_session import TeachingSession
    from tangy_tui.speech.input import SpeechInput


def run_program(workspace: Workspace, *, ascii_only: bool, report: str = REPORT) -> int:
    """Open the application on its home screen; return the exit status.

    `report` is the command for the report of the games that were played.
    """
    begun = datetime.now(UTC)
    status = _run(workspace, None, ascii_only, asks_name=True)
    _tell_played(workspace, PLAYED_WORLDS, begun, report, earlier=False)
    return status


def run_teaching(
    workspace: Workspace,
    teaching: TeachingSession,
    *,
    ears: SpeechInput | None,
    resume: bool,
    games: int,
    speed: float | None,
    ascii_only: bool,
    voice: bool = False,
    asks_name: bool = False,
) -> int:
    """Open the teaching screen; return the exit status.

    The scripted teacher gives `games` demonstrations at `speed` steps a second, then the
    application ends; a human teacher returns to the home screen.
    """

    async def start(program: Program) -> None:
        from tangy_tui.learning.scripted_teacher import SCRIPTED

        if asks_name:
            teaching.teach_as(workspace.teacher)
        from tangy_tui.ui.screens.teach import TeachScreen

        pace = speed if teaching.teacher == SCRIPTED else None
        for number in range(games if pace else 1):
            screen = TeachScreen(
                workspace, teaching, resume=resume, another=number > 0, scripted=pace,
                tour=program.take_tour(),
            )  # fmt: skip
            complete = await program.push_screen_wait(screen)
            if pace and not complete:
                break
        if pace:
            program.leave()

    return _run(workspace, start, ascii_only, ears, voice=voice, asks_name=asks_name)


def run_playing(
    workspace: Workspace,
    *,
    games: int,
    speed: float | None,
    seed: int | None,
    policy: str,
    teacher: str,
    injections: Sequence[str] = (),
    ascii_only: bool,
    voice: bool = False,
    ears: SpeechInput | None = None,
    sensors: CameraHub | None = None,
    past: PastGame | None = None,
    report: str = REPORT,
) -> int:
    """Open the playing screen; return the exit status.

    `speed` is a ratio to real time, by default 1 if Tangy speaks or if `sensors` are given,
    which then count as the robot's cameras; otherwise it is faster. Answers to Tangy's questions
    may be spoken if there are `ears`. `report` is the command for the games' report.
    """
    begun = datetime.now(UTC)
    status = _run(
        workspace,
        lambda program: program.play(games, speed, seed, policy, teacher, injections, past),
        ascii_only,
        ears,
        voice=voice,
        sensors=sensors,
        live=sensors is not None,
    )
    _tell_played(workspace, (SIMULATED,), begun, report)
    return status


def run_live(
    workspace: Workspace,
    opening: Callable[[int], WorldOpening],
    policy: Policy,
    *,
    games: int,
    seed: int,
    teacher: str,
    ascii_only: bool,
    world: GameWorld,
    report: str,
    ears: SpeechInput | None = None,
    past: PastGame | None = None,
    set_up: bool = True,
    pace: float | None = None,
) -> int:
    """Set up, play on the live screen with the robot on, and end; return the exit status.

    Args:
        workspace: the workspace of the games.
        opening: returns, for a seed, what switches the robot on.
        policy: the policy to play by.
        games: the number of games.
        seed: seeds new games.
        teacher: who answers Tangy's questions; "": who is on duty.
        ascii_only: draw with ASCII characters.
        world: the world of the games.
        report: the command for their report.
        ears: the recogniser for stops and answers.
        past: an interrupted game to resume first; None: ask about one if there is any.
        set_up: let staff set a new game up first.
        pace: s from one call to the next, unless staff choose another; None: the usual one, or that
            of the last game.
    """

    async def start(program: Program) -> None:
        program.leads_home = False
        chosen = (
            GameToPlay(past) if past is not None else await ask_about_interrupted(program, world)
        )
        if chosen is not None:
            of = seed if chosen.past is None else chosen.past.beginning.seed
            await play_live(
                program,
                opening(of),
                policy,
                games=games,
                seed=of,
                teacher=teacher,
                past=chosen.past,
                set_up=set_up and chosen.past is None,
                pace=pace,
            )
        program.leave()

    begun = datetime.now(UTC)
    status = _run(workspace, start, ascii_only, ears)
    _tell_played(workspace, (world,), begun, report)
    return status


def _tell_played(
    workspace: Workspace,
    worlds: Sequence[GameWorld],
    begun: datetime,
    report: str,
    *,
    earlier: bool = True,
) -> None:
    """Tell how the games ended, which game can be resumed, and the command for their report.

    Games that ended before the program `begun` are not told; games that were interrupted before
    it are, if `earlier`.
    """
    from tangy_tui.app.interruption import find_interrupted
    from tangy_tui.monitoring.games import read_games

    *told, command = played_lines(read_games(workspace.store), begun, report) or [""]
    for world in worlds:
        past = find_interrupted(workspace, world)
        if past is not None and (earlier or past.at >= begun):
            told.append(to_be_resumed_words(past, len(past.called(workspace.activity))))
            command = report_words(report)
    for line in filter(None, (*told, command)):
        print(plain(line))


def run_drill(
    workspace: Workspace,
    *,
    rounds: int,
    seed: int | None,
    who: str,
    ascii_only: bool,
    past: Sheet | None = None,
) -> int:
    """Open the drill screen; return the exit status.

    Resumes a `past` drill, or asks about an interrupted one.
    """
    return _run(workspace, lambda program: hold_drill(program, rounds, seed, who, past), ascii_only)


def run_sensors(workspace: Workspace, sensors: CameraHub, *, ascii_only: bool) -> int:
    """Open the screen of devices and cameras, and exit with it; return the exit status."""

    async def start(program: Program) -> None:
        await program.sensors()
        program.leave()

    return _run(workspace, start, ascii_only, sensors=sensors)


def run_watching(folder: Path, *, who: str, note: str, ascii_only: bool) -> int:
    """Open a second console for the games of a data folder; return the exit status."""
    from tangy_tui.app.watching import Guest
    from tangy_tui.ui.app import TangyApp
    from tangy_tui.ui.screens.watch import WatchScreen

    outlive_terminal()
    read_replies()
    with Store.open(folder, write=False) as store:
        guest = Guest(folder)
        app = TangyApp(
            lambda: WatchScreen(guest, store, who=who, note=note),
            pictures=folder,
            **_appearance(folder, ascii_only, keep=False),
        )
        return run_app(app)


def run_map_drive(
    workspace: Workspace, link: RobotLink, record: Path, *, ascii_only: bool
) -> tuple[bool, int]:
    """Let staff drive for a map; return whether to draw it, and the exit status."""
    from tangy_tui.ui.app import TangyApp
    from tangy_tui.ui.screens.map_drive import MapDriveScreen

    outlive_terminal()
    read_replies()
    screen = MapDriveScreen(link, record, workspace.robot.title)
    app = TangyApp(
        lambda: screen,
        pictures=workspace.store.folder,
        **_appearance(workspace.store.folder, ascii_only),
    )
    status = run_app(app)
    return screen.done, status


def run_demo(workspace: Workspace, *, seed: int, ascii_only: bool) -> int:
    """Play the whole demo; return the exit status."""

    async def start(program: Program) -> None:
        await tell_story(program, workspace, seed)
        program.leave()

    return _run(workspace, start, ascii_only)


def _run(
    workspace: Workspace,
    start: Start | None,
    ascii_only: bool,
    ears: SpeechInput | None = None,
    *,
    voice: bool = False,
    sensors: CameraHub | None = None,
    live: bool = False,
    asks_name: bool = False,
) -> int:
    outlive_terminal()
    read_replies()
    program = Program(
        workspace,
        start,
        ears=ears,
        voice=voice,
        sensors=sensors,
        live=live,
        question=workspace.settings.question,
        asks_name=asks_name,
        **_appearance(workspace.store.folder, ascii_only),
    )
    return run_app(program)


def _appearance(folder: Path, ascii_only: bool, *, keep: bool = True) -> dict[str, Any]:
    """Return what the terminal and a data folder decide about the look and the keys.

    A theme that is chosen is kept there, unless an onlooker chooses it (`keep`).
    """
    settings = read_settings(folder)
    return {
        "kind": terminal_kind(ascii=True if ascii_only else None),
        "keymap": settings.keymap,
        "link": settings.link,
        "theme": read_profile(folder).theme,
        **({"keep_theme": partial(change_theme, folder)} if keep else {}),
    }
