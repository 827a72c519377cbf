"""`tangy play` and `tangy demo`: play simulated games, and show the demo."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.defaults import DEFAULT_ACTIVITY, USUAL_ROBOT
from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import SIMULATED
from tangy_tui.text.command_line import TEACH_YOURSELF
from tangy_tui.text.outcomes import did_not_come, faults_played, score_lines
from tangy_tui.verbs import common
from tangy_tui.verbs.hearing import (
    HandsFree,
    Listening,
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
    from tangy_tui.learning.online_learning import Lesson
    from tangy_tui.monitoring.supervision import Supervision


SPEED = 20.0  # ratio to real time, as on the screen


def play(
    games: common.Games = 1,
    users: common.Users = common.REGISTERED,
    headless: Annotated[bool, typer.Option("--headless", help="Run without a screen.")] = False,
    plain_lines: Plain = False,
    activity: common.ActivityName = "",
    room: common.RoomName = "",
    policy: PolicyName = "",
    teacher: Teacher = None,
    inject: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KIND[@STEP|~P]",
            help="Bring about a fault: as soon as it can show, at a step (@12), with a probability "
            "at every step (~0.02), or while another is recovered from (@recovery). Repeatable.",
        ),
    ] = None,
    expert: Expert = "",
    mic: Mic = None,
    hands_free: HandsFree = False,
    spoken_answers: SpokenAnswers = False,
    mode: Mode = None,
    voice: WithVoice = False,
    camera: Cameras = None,
    robot: RobotName = USUAL_ROBOT,
    speed: Annotated[
        float | None,
        typer.Option(
            min=1, max=1000, help="Times real speed; 20, or 1 with voice or real cameras."
        ),
    ] = None,
    resume: Resume = False,
    discard: Discard = False,
    seed: common.Seed = None,
    data: common.Data = None,
    as_json: common.Json = False,
    ascii_only: common.Ascii = False,
) -> None:
    """Play games in simulation by the policy learnt.

    If nobody has shown Tangy what to do, it asks a teacher and goes on with the answer. Without a
    teacher (--headless or --json) the game stops there. Tangy diagnoses faults and recovers from
    them; a critical fault halts it until staff clear it, and ends a game without staff.
    With --camera that camera is real: cover its lens, and Tangy asks you to uncover it.
    """
    from tangy_tui.console.inputs import keys_from_terminal
    from tangy_tui.learning.policies import need_policy

    if INJECT_HELP in (inject or ()):
        list_injections(as_json)
        return
    who = who_answers(teacher, expert, data)
    faults = tuple(inject or ())
    listening = Listening(mic, hands_free, spoken_answers, mode)
    listening.check()
    listens = mic == "-" and not (headless or as_json)
    sound = keys_from_terminal(None) if listens else 0  # before checking for a screen
    if plain_lines and (headless or as_json):
        raise TangyError("--plain is for staff at the lines: leave --headless and --json out.")
    screen = not (headless or as_json or plain_lines) and full_screen()
    if mic is not None and not screen:
        raise TangyError("--mic: Tangy listens to answers on the screen; here they are typed.")
    if camera and not screen:
        raise TangyError("--camera: cameras are watched on the screen; see tangy sensors --plain.")
    with open_workspace(data, activity, users, robot=robot, room=room) as workspace:
        need_policy(workspace.store, workspace.activity, policy)
        tell_small_room(workspace)
        past = past_game(
            workspace, SIMULATED, resume=resume, discard=discard, asks=screen,
            lines=plain_lines, report=f"tangy report{common.as_given(data)}",
        )  # fmt: skip
        if past is not None:
            seed = past.beginning.seed
        if screen:
            from tangy_hw.perception.camera_hub import sensors_of
            from tangy_tui.ui.run import run_playing

            deck, folder = workspace.activity.deck, workspace.store.folder
            sensors = sensors_of(workspace.robot, deck, folder, camera) if camera else None

            raise typer.Exit(
                run_playing(
                    workspace,
                    games=games,
                    speed=speed,
                    seed=seed,
                    policy=policy,
                    teacher=who,
                    injections=faults,
                    ascii_only=ascii_only,
                    voice=voice,
                    ears=listening.ears(
                        workspace,
                        workspace.phrasebook(),
                        who,
                        sound=sound,
                    ),
                    sensors=sensors,
                    past=past,
                    report=f"tangy report{common.as_given(data)}",
                )
            )
        learnt = recall(workspace, policy, quiet=as_json)
        by_lines = not (headless or as_json)
        scripted = who == SCRIPTED
        supervision = workspace.supervision(
            learnt, seed, asks=by_lines or scripted, injections=faults
        )
        if plain_lines:
            pace = speed or SPEED
            if not play_with_staff(workspace, supervision, games, who, speed=pace, past=past):
                raise typer.Exit(1)
            return
        if not by_lines:
            _play_headless(
                workspace,
                supervision,
                games,
                as_json,
                expert=bool(expert),
                injected=bool(faults),
                past=past,
            )
            return
        play_by_turns(workspace, supervision, games, who, expert=bool(expert), past=past)


def demo(
    seed: Annotated[int, typer.Option(help="Another seed, other games.")] = 1,
    data: common.Data = None,
    plain_lines: Annotated[
        bool, typer.Option("--plain", help="Use lines instead of a screen.")
    ] = False,
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


def _play_headless(
    workspace: Workspace,
    supervision: Supervision,
    games: int,
    as_json: bool,
    *,
    expert: bool,
    injected: bool,
    past: PastGame | None = None,
) -> None:
    from tangy_sim.worlds.faulty_world import FaultyWorld
    from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
    from tangy_tui.interaction.game_events import GameEnded, Taught
    from tangy_tui.interaction.tally import Tally
    from tangy_tui.monitoring.fault import fault_documents
    from tangy_tui.monitoring.scoring import GameScore, score_game, scores_document, summary
    from tangy_tui.text.documents import lesson_document
    from tangy_tui.text.situations import lesson_words
    from tangy_tui.ui import reports

    tally = Tally()
    lessons: list[Lesson] = []
    faults: list[dict[str, Any]] = []
    scores: list[GameScore] = []
    control = scripted_controller(supervision, past)
    workspace.door.attach(control)
    for _ in reports.progress(range(games), "Playing", quiet=as_json or games < 20):
        with workspace.store.transaction():  # one commit a game: .1 ms a step instead of 4
            tally.add(control.begin())
            stopped = None
            while not supervision.over:
                events = go_on_by_script(control, expert=expert)
                tally.add(events)
                stopped = next((e.stopped for e in events if isinstance(e, GameEnded)), None)
                lessons += [event.lesson for event in events if isinstance(event, Taught)]
        world = supervision.world
        if isinstance(world, FaultyWorld):
            tally.add_injections(world.came, world.pending_injections)
            came = world.injection_log.all
            scores.append(score_game(tally.games, came, supervision.faults, supervision.book))
        faults += fault_documents(supervision.faults, stopped)
    beliefs = supervision.persuasion.beliefs
    if as_json:
        told: dict[str, Any] = {}
        if lessons:
            told["answers"] = [lesson_document(workspace, one) for one in lessons]
        if injected:
            told["injected"] = tally.injected
            told["did_not_come_about"] = tally.absent
            told |= scores_document(scores)
        common.print_json({**tally.to_json(workspace.activity.situations, beliefs, faults), **told})
    else:
        for lesson in lessons:
            print(lesson_words(workspace.activity, lesson))
        reports.print_tally(workspace, tally, beliefs)
        if injected:
            for line in score_lines(summary(scores)):
                print(line)
        for one, times in tally.absent.items():
            print(did_not_come(one, times, games))
        if faults:
            critical = sum(fault.get("criticality") == "critical" for fault in faults)
            print(faults_played(len(faults), critical))
    if tally.stopped:
        raise typer.Exit(1)  # so that a script knows that games stopped early
