"""Options and functions that the commands for playing games share."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.text.outcomes import fault_left, injecting_words
from tangy_tui.text.policies import notice_words
from tangy_tui.text.questions import TOO_EARLY
from tangy_tui.verbs.common import as_given, print_json, print_line
from tangy_tui.verbs.hearing import Listening
from tangy_tui.verbs.opening import full_screen, say_notices

if TYPE_CHECKING:
    from tangy_hw.robot_client.live_world import LiveWorld
    from tangy_profiles.demonstration import Demonstration
    from tangy_profiles.past_game import PastGame
    from tangy_sim.worlds.injection import Injection
    from tangy_tui.app.game_controller import GameController
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.console.inputs import ReadAhead
    from tangy_tui.console.staff import StaffLines
    from tangy_tui.console.typed_lines import TypedLines
    from tangy_tui.learning.policy import Policy
    from tangy_tui.monitoring.supervision import Event, Supervision

PolicyName = Annotated[
    str,
    typer.Option("--policy", help="The policy to play by: a name or a digest; default the last."),
]
Teacher = Annotated[
    str | None,
    typer.Option("--teacher", help="Who answers when Tangy asks; 'scripted' knows the game."),
]
Plain = Annotated[
    bool,
    typer.Option("--plain", help="Use lines instead of a screen: type help for what staff can do."),
]
Expert = Annotated[
    str,
    typer.Option(
        "--expert", help="Who clears critical faults; 'scripted' mends them. Default: you."
    ),
]
SCRIPTED = "scripted"
"""Answers, or clears faults, by the activity's expected behaviours."""


class GameOptions:
    """The options that `tangy play` and `tangy live` share; each lists them in its own order."""

    headless: bool
    plain_lines: bool
    mic: str | None
    hands_free: bool
    spoken_answers: bool
    mode: str | None
    data: Path | None
    as_json: bool

    @property
    def listening(self) -> Listening:
        """The options for speech input."""
        return Listening(self.mic, self.hands_free, self.spoken_answers, self.mode)

    @property
    def report(self) -> str:
        """The command for the report of the games."""
        return f"tangy report{as_given(self.data)}"

    def opens_screen(self, needs_screen: str) -> tuple[bool, int]:
        """Return whether a screen opens, and the file descriptor of the microphone's sound.

        Args:
            needs_screen: says that a microphone needs a screen.

        Raises:
            TangyError: options exclude each other.
        """
        from tangy_tui.console.inputs import keys_from_terminal

        headless = self.headless or self.as_json
        listens = self.mic == "-" and not headless
        sound = keys_from_terminal(None) if listens else 0  # before checking for a screen
        if self.plain_lines and headless:
            raise TangyError("--plain is for staff at the lines: leave --headless and --json out.")
        screen = not (headless or self.plain_lines) and full_screen()
        if self.mic is not None and not screen:
            raise TangyError(needs_screen)
        return screen, sound


def tell_small_room(workspace: Workspace) -> None:
    """Print which room is used if the chosen one is too small."""
    from tangy_tui.text.rooms import fallback_words

    if (chosen := workspace.chosen_room) is not None and workspace.room is not chosen:
        say_notices([fallback_words(workspace.room, chosen)])


def who_answers(teacher: str | None, expert: str, data: Path | None) -> str:
    """Return who answers Tangy's questions.

    Raises:
        TangyError: there is no such expert.
    """
    from tangy_tui.app.teacher_profile import teacher_name
    from tangy_tui.app.workspace import data_folder

    if expert not in ("", SCRIPTED):
        raise TangyError(plain(f"--expert {expert}: there is only 'scripted'."))
    return teacher_name(teacher, data_folder(data))


def recall(workspace: Workspace, wanted: str, *, quiet: bool) -> Policy:
    """Return the policy to play by; print notices about it and about the last game.

    Args:
        workspace: the workspace of the policy.
        wanted: its name or digest, "" for the last one.
        quiet: whether to leave out the last game: a screen asks about it itself.

    Raises:
        TangyError: there is no such policy.
    """
    from tangy_tui.learning.policies import load_policy
    from tangy_tui.monitoring.games import uncleared

    learnt, notices = load_policy(workspace.store, workspace.activity, wanted)
    left = None if quiet else uncleared(workspace.store)
    told = notice_words(notices)
    if left is not None:
        told.append(fault_left(left.name))
    say_notices(told)
    return learnt


INJECT_HELP = "help"
"""The word that lists the faults instead of injecting one."""


def list_injections(as_json: bool) -> None:
    """Print the faults that can be injected, with their effects and when they are noticed."""
    from tangy_sim.worlds.injection import KINDS

    if as_json:
        print_json([{"fault": k.name, "what": k.words, "shows": k.shows} for k in KINDS.values()])
        return
    width = max(map(len, KINDS))
    for kind in KINDS.values():
        when = kind.shows if kind.shows == "at once" else f"while {kind.shows}"
        print(f"{kind.name:<{width}}  {kind.words} (shows {when})")
    print(injecting_words(next(iter(KINDS))))


def check_injections(injections: Sequence[Injection], workspace: Workspace) -> None:
    """Refuse a fault of a device that the robot does not have.

    Raises:
        TangyError: names the fault and the robot.
    """
    from tangy_profiles.fault_file import load_faults
    from tangy_tui.app.fault_commands import possible_kinds
    from tangy_tui.text.injections import not_of_this_robot

    if not injections:
        return
    possible = possible_kinds(rule.code for rule in load_faults(workspace.robot).rules)
    for one in injections:
        if one.kind.name not in possible:
            raise TangyError(plain(not_of_this_robot(one.kind.name, workspace.robot.title)))


def play_with_staff(
    workspace: Workspace,
    supervision: Supervision,
    games: int,
    teacher: str,
    *,
    speed: float | None = None,
    past: PastGame | None = None,
) -> bool:
    """Play simulated games with staff at standard input; return whether none stopped early.

    Args:
        workspace: the workspace of the games.
        supervision: runs the games.
        games: the number of games.
        teacher: who types.
        speed: a ratio to real time.
        past: an interrupted game to resume first.
    """
    from tangy_tui.console.typed_lines import typed_lines

    with typed_lines(print_line) as typed:
        _, lines = staff_lines(workspace, supervision, teacher, speed=speed, past=past, typed=typed)
        return lines.run(games)


def play_by_turns(
    workspace: Workspace,
    supervision: Supervision,
    games: int,
    teacher: str,
    *,
    expert: bool,
    past: PastGame | None = None,
) -> None:
    """Play simulated games in the console, reading lines only when Tangy waits for staff.

    Args:
        workspace: the workspace of the games.
        supervision: runs the games.
        games: the number of games.
        teacher: who answers; a scripted one reads no lines.
        expert: scripted staff clear the faults that halt the robot.
        past: an interrupted game to resume first.
    """
    scripted = teacher == SCRIPTED
    _, lines = staff_lines(workspace, supervision, teacher, past=past)
    lines.run_by_turns(games, scripted=scripted, expert=expert)


def staff_lines(
    workspace: Workspace,
    supervision: Supervision,
    teacher: str,
    *,
    robot: LiveWorld | None = None,
    speed: float | None = None,
    past: PastGame | None = None,
    typed: TypedLines | None = None,
    before: StaffLines | None = None,
    ahead: ReadAhead | None = None,
) -> tuple[GameController, StaffLines]:
    """Return the controller of games, and what connects it to staff at the lines.

    Args:
        workspace: the workspace of the games.
        supervision: runs the games.
        teacher: who types.
        robot: the world of a real robot.
        speed: a ratio to real time, for simulated games.
        past: an interrupted game to resume first.
        typed: the lines of a terminal.
        before: the games that a person has joined.
        ahead: the lines, if they are being read already.
    """
    from tangy_tui.app.game_controller import GameController
    from tangy_tui.app.interruption import earlier_part
    from tangy_tui.app.live_games import LiveGames
    from tangy_tui.console.inputs import is_typed, line_reader
    from tangy_tui.console.staff import StaffLines
    from tangy_tui.console.typed_yes import TypedYes
    from tangy_tui.interaction.feedback import void_last
    from tangy_tui.learning.library import read_library
    from tangy_tui.text.live_news import news_lines
    from tangy_tui.text.watching import stopped_by_guest

    def void(person: str) -> bool:
        return void_last(workspace.store, supervision.game.game, person, teacher)

    def shown() -> list[Demonstration]:
        entries = read_library(workspace.store, workspace.activity.name).entries.values()
        return [entry.demonstration for entry in entries]

    live = None if robot is None else LiveGames(workspace, supervision)

    def new(events: Sequence[Event]) -> list[str]:
        return [] if live is None else [*news_lines(live.take(events), workspace.name)]

    write = print_line if typed is None else typed.write
    yes = TypedYes(terminal=is_typed(None), setting=workspace.settings.question)
    if typed is not None:
        yes.drop_begun, yes.written = typed.drop, typed.ask_terminal
        typed.too_early = lambda: typed.write(TOO_EARLY)
    control = GameController(supervision, teacher, robot=robot, void=void, past=past)
    workspace.door.attach(control, lambda who: write(stopped_by_guest(who, control.by)))
    return control, StaffLines(
        control,
        workspace.name,
        lambda wanted: workspace.find_person(wanted).id,
        line_reader(None) if typed is None else typed.read,
        write,
        speed=speed,
        also=new,
        demonstrations=shown,
        yes=yes,
        before=before,
        ahead=ahead,
        earlier=earlier_part(workspace, past, joined=before is not None),
    )
