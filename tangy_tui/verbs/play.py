"""`tangy play` and `tangy demo`: play simulated games, and show the demo."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.defaults import DEFAULT_ACTIVITY, USUAL_ROBOT
from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import SIMULATED
from tangy_tui.text.command_line import TEACH_YOURSELF
from tangy_tui.text.hearing import ANSWERS_NEED_SCREEN
from tangy_tui.verbs import common
from tangy_tui.verbs.hearing import (
    HandsFree,
    Mic,
    Mode,
    SpokenAnswers,
    WithVoice,
)
from tangy_tui.verbs.opening import full_screen, open_workspace
from tangy_tui.verbs.playing import (
    INJECT_HELP,
    SCRIPTED,
    Expert,
    GameOptions,
    Plain,
    PolicyName,
    Teacher,
    list_injections,
    play_by_turns,
    play_with_staff,
    recall,
    tell_small_room,
    who_answers,
)
from tangy_tui.verbs.resuming import Discard, Resume, past_game
from tangy_tui.verbs.sensors import Cameras, RobotName

if TYPE_CHECKING:
    from tangy_profiles.past_game import PastGame
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.monitoring.supervision import Supervision


SPEED = 20.0  # ratio to real time, as on the screen


Injections = Annotated[
    list[str] | None,
    typer.Option(
        "--inject",
        metavar="KIND[@STEP|~P]",
        help="Bring about a fault: as soon as it can show, at a step (@12), with a probability "
        "at every step (~0.02), or while another is recovered from (@recovery). Repeatable.",
    ),
]
Speed = Annotated[
    float | None,
    typer.Option(min=1, max=1000, help="Times real speed; 20, or 1 with voice or real cameras."),
]


@dataclass(frozen=True)
class PlayOptions(GameOptions):
    """The options of `tangy play`, in the order of its help."""

    games: common.Games = 1
    users: common.Users = common.REGISTERED
    headless: Annotated[bool, typer.Option("--headless", help="Run without a screen.")] = False
    plain_lines: Plain = False
    activity: common.ActivityName = ""
    room: common.RoomName = ""
    policy: PolicyName = ""
    teacher: Teacher = None
    inject: Injections = None
    expert: Expert = ""
    mic: Mic = None
    hands_free: HandsFree = False
    spoken_answers: SpokenAnswers = False
    mode: Mode = None
    voice: WithVoice = False
    camera: Cameras = None
    robot: RobotName = USUAL_ROBOT
    speed: Speed = None
    resume: Resume = False
    discard: Discard = False
    seed: common.Seed = None
    data: common.Data = None
    as_json: common.Json = False
    ascii_only: common.Ascii = False


@common.takes(PlayOptions)
def play(given: PlayOptions) -> None:
    """Play games in simulation by the policy learnt.

    If nobody has shown Tangy what to do, it asks a teacher and goes on with the answer. Without a
    teacher (--headless or --json) the game stops there. Tangy diagnoses faults and recovers from
    them; a critical fault halts it until staff clear it, and ends a game without staff.
    With --camera that camera is real: cover its lens, and Tangy asks you to uncover it.
    """
    from tangy_tui.learning.policies import need_policy

    if INJECT_HELP in (given.inject or ()):
        list_injections(given.as_json)
        return
    who = who_answers(given.teacher, given.expert, given.data)
    given.listening.check()
    screen, sound = given.opens_screen(ANSWERS_NEED_SCREEN)
    if given.camera and not screen:
        raise TangyError("--camera: cameras are watched on the screen; see tangy sensors --plain.")
    with open_workspace(
        given.data, given.activity, given.users, robot=given.robot, room=given.room
    ) as workspace:
        need_policy(workspace.store, workspace.activity, given.policy)
        tell_small_room(workspace)
        past = past_game(
            workspace, SIMULATED, resume=given.resume, discard=given.discard, asks=screen,
            lines=given.plain_lines, report=given.report,
        )  # fmt: skip
        if past is not None:
            given = replace(given, seed=past.beginning.seed)
        if screen:
            raise typer.Exit(_play_on_screen(given, workspace, who, sound, past))
        _play_without_screen(given, workspace, who, past)


def _play_on_screen(
    given: PlayOptions, workspace: Workspace, who: str, sound: int, past: PastGame | None
) -> int:
    """Play on the screen; return the exit status.

    Args:
        given: the options.
        workspace: the workspace of the games.
        who: who answers Tangy's questions.
        sound: the file descriptor of the microphone `-`.
        past: an interrupted game to resume first.
    """
    from tangy_hw.perception.camera_hub import sensors_of
    from tangy_tui.ui.run import run_playing

    deck, folder = workspace.activity.deck, workspace.store.folder
    sensors = sensors_of(workspace.robot, deck, folder, given.camera) if given.camera else None
    return run_playing(
        workspace,
        games=given.games,
        speed=given.speed,
        seed=given.seed,
        policy=given.policy,
        teacher=who,
        injections=tuple(given.inject or ()),
        ascii_only=given.ascii_only,
        voice=given.voice,
        ears=given.listening.ears(workspace, workspace.phrasebook(), who, sound=sound),
        sensors=sensors,
        past=past,
        report=given.report,
    )


def _play_without_screen(
    given: PlayOptions, workspace: Workspace, who: str, past: PastGame | None
) -> None:
    """Play with staff at the lines, by turns with their input, or headless.

    Raises:
        typer.Exit: games stopped early, with status 1.
    """
    learnt = recall(workspace, given.policy, quiet=given.as_json)
    by_lines = not (given.headless or given.as_json)
    asks = by_lines or who == SCRIPTED
    faults = tuple(given.inject or ())
    supervision = workspace.supervision(learnt, given.seed, asks=asks, injections=faults)
    games, expert = given.games, bool(given.expert)
    if given.plain_lines:
        pace = given.speed or SPEED
        if not play_with_staff(workspace, supervision, games, who, speed=pace, past=past):
            raise typer.Exit(1)
    elif by_lines:
        play_by_turns(workspace, supervision, games, who, expert=expert, past=past)
    else:
        _play_headless(given, workspace, supervision, past)


def _play_headless(
    given: PlayOptions, workspace: Workspace, supervision: Supervision, past: PastGame | None
) -> None:
    """Play without staff, and print the results.

    Raises:
        typer.Exit: games stopped early, with status 1.
    """
    from tangy_tui.verbs.play_headless import HeadlessGames

    injected = bool(given.inject)
    played = HeadlessGames(workspace, supervision, past)
    played.play(given.games, expert=bool(given.expert), quiet=given.as_json)
    if given.as_json:
        common.print_json(played.document(injected=injected))
    else:
        played.print_results(given.games, injected=injected)
    if played.tally.stopped:
        raise typer.Exit(1)  # so that a script knows that games stopped early


def demo(
    seed: Annotated[int, typer.Option(help="Another seed, other games.")] = 1,
    data: common.Data = None,
    plain_lines: common.Lines = False,
    as_json: common.Json = False,
    ascii_only: common.Ascii = False,
) -> None:
    """See a story: teaching, learning, a game, a fault."""
    from tempfile import TemporaryDirectory

    with TemporaryDirectory(prefix="tangy-demo-") as scratch, open_workspace(
        data or Path(scratch), DEFAULT_ACTIVITY, 4
    ) as workspace:  # fmt: skip
        if full_screen() and not (plain_lines or as_json):
            from tangy_tui.ui.run import run_demo

            status = run_demo(workspace, seed=seed, ascii_only=ascii_only)
            print(TEACH_YOURSELF)
            raise typer.Exit(status)
        from tangy_tui.console.demo import tell

        tally = tell(workspace, seed, (lambda _: None) if as_json else print)
        if as_json:
            common.print_json(tally)
