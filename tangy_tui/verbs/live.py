"""`tangy live`: play games with a real robot, or on the bench."""

from __future__ import annotations

import os
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.defaults import USUAL_ROBOT
from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import BENCH, LIVE
from tangy_profiles.given_file import read_given_text
from tangy_profiles.reading import plain
from tangy_tui.text.calls import REHEARSAL
from tangy_tui.text.command_line import SWITCHING_ON
from tangy_tui.text.live_games import part_words, report_words
from tangy_tui.text.outcomes import faults_logged, score_lines
from tangy_tui.text.tablet import screen_words
from tangy_tui.verbs import common
from tangy_tui.verbs.bench_options import LinkDelay, LinkLoss, Load, check_load, link_of
from tangy_tui.verbs.hearing import HandsFree, Listening, Mic, Mode, SpokenAnswers
from tangy_tui.verbs.opening import full_screen, open_workspace
from tangy_tui.verbs.playing import (
    INJECT_HELP,
    SCRIPTED,
    Expert,
    Plain,
    PolicyName,
    Teacher,
    check_injections,
    list_injections,
    recall,
    tell_small_room,
    who_answers,
)
from tangy_tui.verbs.resuming import Discard, Resume, past_game
from tangy_tui.verbs.sensors import Cameras, RobotName

if TYPE_CHECKING:
    from tangy_hw.robot_client.live_world import LiveWorld
    from tangy_sim.worlds.injection import Injection
    from tangy_tui.app.live_games import LiveGames
    from tangy_tui.app.robot_opening import WorldOpening
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.console.set_up import SetUpLines
    from tangy_tui.monitoring.supervision import Event

PACE = 30.0  # as in tangy_hw.robot_client.live_world, which must not be imported here
LARGEST_LIST = 100_000  # bytes of a list of faults


def live(
    robot: RobotName = USUAL_ROBOT,
    bench: Annotated[
        bool,
        typer.Option("--bench", help="Simulate the robot's devices and the people."),
    ] = False,
    games: common.Games = 1,
    users: common.Users = common.REGISTERED,
    headless: Annotated[
        bool,
        typer.Option("--headless", help="Run without a screen; on the bench as fast as possible."),
    ] = False,
    plain_lines: Plain = False,
    activity: common.ActivityName = "",
    room: common.RoomName = "",
    policy: PolicyName = "",
    inject: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KIND[@STEP|~P]|FILE",
            help="Bring about a fault on the bench, as with `tangy play --inject`, or the faults "
            "in a file, one on each line. Repeatable.",
        ),
    ] = None,
    teacher: Teacher = None,
    by: Annotated[
        str, typer.Option("--by", help="Who is on duty; reports show it with what staff do.")
    ] = "",
    expert: Expert = "",
    pace: Annotated[
        float | None,
        typer.Option(
            min=1,
            max=300,
            show_default=False,
            help="Seconds from one call to the next. Default: as in your last game, or 30.",
        ),
    ] = None,
    map_: Annotated[
        str,
        typer.Option(
            "--map", metavar="FILE.yaml", help="The map of the room, as `tangy map` draws it."
        ),
    ] = "",
    lost: Annotated[
        bool,
        typer.Option(
            "--lost", help="Tangy does not stand at the front, so it turns to find its place."
        ),
    ] = False,
    camera: Cameras = None,
    requests: Annotated[
        str, typer.Option(help="Where requests come from, as for `tangy requests`.")
    ] = "",
    table: Annotated[
        str, typer.Option(help="The table's corners in the pictures, as for `tangy requests`.")
    ] = "",
    card: Annotated[
        list[str] | None,
        typer.Option(
            metavar="PERSON=NUMBER",
            help="A person's card, as in Rosa=17: Tangy judges no other card in front of them. "
            "Otherwise it learns the card when it first sees one there. Repeatable.",
        ),
    ] = None,
    load: Load = 0,
    link_delay: LinkDelay = 0.0,
    link_loss: LinkLoss = 0.0,
    mic: Mic = None,
    hands_free: HandsFree = False,
    spoken_answers: SpokenAnswers = False,
    mode: Mode = None,
    begin: Annotated[
        bool, typer.Option("--begin", help="Begin at once, without the set-up page.")
    ] = False,
    resume: Resume = False,
    discard: Discard = False,
    seed: common.Seed = None,
    data: common.Data = None,
    as_json: common.Json = False,
    ascii_only: common.Ascii = False,
) -> None:
    """Play games with a robot by the policy learnt.

    The robot's file names its drivers (see docs/robots.md). With --bench the same drivers talk to
    simulated devices. Tangy monitors the devices all the time and diagnoses faults; a critical
    fault stops the robot until staff clear it. With --mic Tangy listens: "stop the robot" stops
    it at once, and you can answer its questions by voice.
    """
    from tangy_hw.perception.requests.source_names import read_corners
    from tangy_tui.console.inputs import keys_from_terminal
    from tangy_tui.learning.policies import need_policy

    if INJECT_HELP in (inject or ()):
        list_injections(as_json)
        return
    who = who_answers(teacher, expert, data)
    listening = Listening(mic, hands_free, spoken_answers, mode)
    listening.check()
    if inject and not bench:
        raise TangyError("--inject: faults are brought about on the bench alone: add --bench.")
    if bench and (camera or requests or table or card):
        options = "--camera, --requests, --table, --card"
        raise TangyError(f"{options}: the bench brings its own; leave them out.")
    check_load(load, bench=bench)
    link = link_of(link_delay, link_loss, bench=bench)
    faults = _listed(inject or [])
    listens = mic == "-" and not (headless or as_json)
    sound = keys_from_terminal(None) if listens else 0  # before checking for a screen
    if plain_lines and (headless or as_json):
        raise TangyError("--plain is for staff at the lines: leave --headless and --json out.")
    screen = not (headless or as_json or plain_lines) and full_screen()
    if mic is not None and not screen:
        raise TangyError("--mic: Tangy listens in a live game on the screen; there is none here.")
    from tangy_tui.app.machine_load import machine_load
    from tangy_tui.app.on_duty import on_duty, take_duty

    with (
        machine_load(load),
        open_workspace(data, activity, users, robot=robot, room=room) as workspace,
        ExitStack() as stack,
    ):
        need_policy(workspace.store, workspace.activity, policy)
        if by:
            take_duty(workspace.store.folder, by)
        world = BENCH if bench else LIVE
        tell_small_room(workspace)
        report = f"tangy report{common.as_given(data)}"
        past = past_game(
            workspace, world, resume=resume, discard=discard, asks=screen,
            lines=plain_lines, report=report,
        )  # fmt: skip
        learnt = recall(workspace, policy, quiet=as_json or screen)
        number = workspace.game_seed(seed) if past is None else past.beginning.seed
        from tangy_profiles.known_devices import reads_cards
        from tangy_tui.app.dealing import read_dealt
        from tangy_tui.app.robot_opening import at_front, check_map, opening_of
        from tangy_tui.text.control import WAIT_EXPLANATIONS
        from tangy_tui.text.missing_devices import missing_words, staff_needed

        if map_:
            check_map(workspace, map_)
        check_injections(faults, workspace)
        own = {
            "cameras": camera or (), "requests": requests, "corners": read_corners(table),
            "cards": read_dealt(card or (), workspace.people), "courtesies": WAIT_EXPLANATIONS,
        }  # fmt: skip

        def opening(seed: int) -> WorldOpening:
            both: dict[str, Any] = {"seed": seed, "pace": pace or PACE, "map_": map_, "lost": lost}
            both |= {"injections": faults, "link": link}
            return opening_of(workspace, bench=bench, own=own, **both)

        if screen:
            from tangy_tui.ui.run import run_live

            raise typer.Exit(
                run_live(
                    workspace,
                    opening,
                    learnt,
                    games=games,
                    seed=number,
                    teacher="" if teacher is None else who,
                    ascii_only=ascii_only,
                    world=world,
                    report=report,
                    past=past,
                    set_up=not begin,
                    pace=pace,
                    ears=listening.ears(
                        workspace,
                        workspace.phrasebook(),
                        who,
                        sound=sound,
                        spoken=True,
                    ),
                )
            )
        begun = opening(number)
        sees = reads_cards(workspace.robot) or not workspace.activity.deck.columns
        if workspace.robot.drivers and not (bench or plain_lines or sees):
            raise TangyError(staff_needed(workspace.activity.object))
        lines = _set_up(workspace, pace) if plain_lines and not begin and past is None else None
        played_before = workspace.profile
        if lines is not None and not lines.run():
            return
        if workspace.profile != played_before:
            learnt = recall(workspace, "", quiet=as_json)
        if not as_json:
            print(SWITCHING_ON, file=sys.stderr)
        from tangy_tui.app.live_games import LiveGames
        from tangy_tui.app.switching_on import switched_on
        from tangy_tui.console.typed_lines import typed_lines
        from tangy_tui.verbs.live_lines import LiveLines

        console: LiveLines | None = None
        if plain_lines:
            typed = stack.enter_context(typed_lines(common.print_line))
            by_name = who if teacher is not None else on_duty(workspace.store.folder)
            console = LiveLines(workspace, games, by_name, typed)

        def note(words: str) -> None:
            if console is not None and console.typed:
                console.write(plain(words))  # above the line that is being typed
            else:
                print(plain(words), file=sys.stderr)

        def tell(part: str) -> None:
            if plain_lines:
                note(f"  {part_words(part, workspace.robot)} ...")

        def tell_screen(world: LiveWorld) -> None:
            if world.link.screen:
                note(screen_words(world.link.screen, world.link.code))

        def meanwhile() -> None:
            if console is not None:
                console.meanwhile()

        stepped = bench and not plain_lines and link is None  # a delay takes real time
        with switched_on(begun, stepped=stepped, tell=tell, meanwhile=meanwhile) as there:
            if not as_json and (plain_lines or not bench):
                tell_screen(there)
            told_missing = missing_words(workspace.robot, workspace.activity)
            for told in [] if as_json or lines is not None else told_missing:
                note(told)  # the set-up has told it in console mode
            asks = plain_lines or who == SCRIPTED
            if console is not None and console.early.leaves:
                return
            if lines is not None and console is not None:
                lines.setup.world = there
                stopped, console.early.stopped = console.early.stopped, False
                lines.use(console.read, console.write)
                if not lines.begins_anyway(stopped=stopped):
                    return
                lines.setup.carry_out(there)
            # Only people who are there can rehearse a call: a batch of games must not page anybody.
            rehearsal = REHEARSAL if plain_lines and not expert else ""
            supervision = workspace.supervision(
                learnt, number, asks=asks, world=there, rehearsal=rehearsal
            )
            if console is not None:
                to_their_end = console.play(supervision, there, past)
            else:
                played = LiveGames(workspace, supervision, past)
                to_their_end = _play(workspace, played, games, as_json, expert=bool(expert))
        while console is not None and console.joined:
            again = switched_on(at_front(begun), stepped=stepped, tell=tell, meanwhile=meanwhile)
            with console.keeping(f"tangy live --resume{common.as_given(data)}"), again as there:
                tell_screen(there)
                supervision = workspace.supervision(
                    console.policy, number, asks=asks, world=there, rehearsal=rehearsal
                )
                to_their_end = console.play(supervision, there)
        if console is not None:
            common.print_line(report_words(report))
        if not to_their_end:
            raise typer.Exit(1)  # so that a script knows that games stopped early


def _set_up(workspace: Workspace, pace: float | None) -> SetUpLines | None:
    """Return the set-up in the console, None if nobody types."""
    from tangy_tui.app.set_up import SetUp
    from tangy_tui.console.inputs import is_typed, line_reader
    from tangy_tui.console.set_up import SetUpLines

    if not is_typed(None):
        return None
    setup = SetUp.of(workspace, pace)
    setup.offer_last_plan()
    return SetUpLines(setup, line_reader(None), common.print_line)


def _listed(given: list[str]) -> tuple[Injection, ...]:
    """Parse the faults to inject, those in files line by line.

    Raises:
        TangyError: a file cannot be read, or a fault does not exist.
    """
    from tangy_sim.worlds.injection import read_injection

    found: list[Injection] = []
    for text in given:
        path = Path(text)
        if not os.path.exists(text) or os.path.isdir(text):  # noqa: PTH110, PTH112 - names too long
            found.append(read_injection(text))
            continue
        lines = read_given_text(path, LARGEST_LIST).split("\n")
        for number, line in enumerate(lines, start=1):
            if line.strip() and not line.startswith("#"):
                try:
                    found.append(read_injection(line.strip()))
                except TangyError as error:
                    raise TangyError(plain(f"{text}, line {number}: {error}")) from None
    return tuple(found)


def _play(
    workspace: Workspace, played: LiveGames, games: int, as_json: bool, *, expert: bool
) -> bool:
    """Play games, print their events, and return whether none stopped early."""
    from tangy_tui.app.live_games import News
    from tangy_tui.text.live_news import live_lines
    from tangy_tui.ui import reports

    def tell(events: list[Event], news: list[News]) -> None:
        for line in [] if as_json else live_lines(events, news, workspace.name):
            print(plain(line), flush=True)

    bar = reports.progress(range(games), "Playing", quiet=as_json or games < 2)
    played.play(bar, expert=expert, tell=tell)
    document = played.document()
    to_their_end = not played.tally.stopped
    if as_json:
        common.print_json(document)
        return to_their_end
    reports.print_tally(workspace, played.tally, played.beliefs)
    for name in ("reads", "identities"):
        if name in document:
            counts = ", ".join(f"{count} {word}" for word, count in document[name].items())
            print(f"{name}: {counts}")
    if "pose_error_m" in document:
        off = document["pose_error_m"]
        print(f"pose error: median {off['median']} m, p95 {off['p95']} m")
        print(f"real-time factor: {document['real_time_factor']}")
    if "score" in document:
        for line in score_lines(document["score"]):
            print(line)
    if document["faults"]:
        print(faults_logged(len(document["faults"])), file=sys.stderr)
    return to_their_end
